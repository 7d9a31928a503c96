//! XDD and XDC text (CiA 311): what an EDS and a DCF say, in XML.
//!
//! The reader takes what belongs to an object from where CiA 311 keeps it: the
//! object's own attributes, or the parameter that it refers to, with the template
//! and the types that the parameter refers to. The result is what an EDS of the same
//! device gives, values and findings included; [`parse`](crate::parse()) and
//! [`Document`](crate::Document) read XML here.
//!
//! Elements are known by their local names, so the namespaces of CiA 311 1.0 and 1.1
//! are the same, and so are project files (`.xpd`) that hold one device.

mod info;
mod made;
mod objects;
mod parameters;
mod read;
mod source;
mod types;
mod write;

pub(crate) use read::parse;
pub use write::write;

#[cfg(test)]
mod tests;
