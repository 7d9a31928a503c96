//! XDD and XDC text (CiA 311): the content of an EDS or a DCF in XML.
//!
//! The reader collects the content of an object from the places of CiA 311: the object's own
//! attributes, or the parameter that it refers to, with the template and the types of the
//! parameter. The result equals that of an EDS of the same device, with values and findings.
//! [`parse`](crate::parse()) and [`Document`](crate::Document) use this module for XML.
//!
//! Elements are recognised by their local names, so the namespaces of CiA 311 1.0 and 1.1 count as
//! the same, and so do project files (`.xpd`) with one device.

pub(crate) mod fixes;
mod info;
mod limits;
mod objects;
mod parameters;
mod schema;
mod source;
mod types;
mod write;

use alloc::string::ToString;

use roxmltree::Document;

use crate::description::Description;
use crate::log::Log;
use crate::read::{configured, sorted};
use crate::rules::text::{e0113_xml_not_well_formed, e0119_too_large};
use crate::scan::section::TextSection;
use crate::xdd::source::{Places, Reader};

pub use schema::{Attribute, Value, attributes};
pub use write::write;

/// Reads an XDD or an XDC; `file` is its name on the disk, if it has one, and `see` receives its content as sections of an EDS.
///
/// Never fails and never panics. A text that is not well-formed XML gives an empty description and
/// a finding at the error.
pub(crate) fn parse(
    text: &str,
    file: Option<&str>,
    see: &mut dyn FnMut(&[TextSection<'_>]),
    log: &mut Log,
) -> Description {
    if let Some(large) = limits::exceeded(text) {
        let line = text[..large.at].matches('\n').count() as u32 + 1;
        let at = Places::new(text).at(line, 1);
        log.push(e0119_too_large(at, large.part, large.most, large.of));
        return Description::default();
    }
    let xml = match Document::parse(text) {
        Ok(xml) => xml,
        Err(error) => {
            let place = error.pos();
            let span = Places::new(text).at(place.row, place.col);
            log.push(e0113_xml_not_well_formed(span, &error.to_string()));
            return Description::default();
        }
    };
    let mut reader = Reader::new(text);
    let root = xml.root();
    let mut sections = info::sections(root, &mut reader);
    sections.append(&mut objects::sections(root, &mut reader));
    schema::check(root, &mut reader);
    log.append(reader.log);
    see(&sections);
    configured::check(&sections, file, &configured::XDD, log);
    sorted::objects(sections, log)
}

#[cfg(test)]
mod tests;
