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

pub(crate) mod fixes;
mod info;
mod objects;
mod parameters;
mod source;
mod types;
mod write;

use alloc::format;
use alloc::string::ToString;

use roxmltree::Document;

use crate::description::Description;
use crate::log::Log;
use crate::read::sorted;
use crate::rules::text::e0113_xml_not_well_formed;
use crate::xdd::source::{Places, Reader};

pub use write::write;

/// Maximum number of attributes of an element. Those of CiA 311 have 12; the XML parser compares each attribute with
/// all others.
const ATTRIBUTES: usize = 1_000;

/// The place of an element with too many attributes, each of which has a `="` or a `='`.
fn crowded(text: &str) -> Option<usize> {
    let (mut start, mut count) = (0, 0);
    let bytes = text.as_bytes();
    for (at, pair) in bytes.windows(2).enumerate() {
        match pair {
            [b'<', _] => (start, count) = (at, 0),
            [b'=', b'"' | b'\''] => count += 1,
            _ => {}
        }
        if count > ATTRIBUTES {
            return Some(start);
        }
    }
    None
}

/// Reads an XDD or an XDC.
///
/// Never fails, never panics. A text that is not well-formed XML gives an empty
/// description and the place where it breaks.
pub(crate) fn parse(text: &str, log: &mut Log) -> Description {
    if let Some(at) = crowded(text) {
        let places = Places::new(text);
        let line = text[..at].matches('\n').count() as u32 + 1;
        let error = format!("an element has more than {ATTRIBUTES} attributes");
        log.push(e0113_xml_not_well_formed(places.at(line, 1), &error));
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
    log.append(reader.log);
    sorted::objects(sections, log)
}

#[cfg(test)]
mod tests;
