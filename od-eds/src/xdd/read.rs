//! From XML to a description: elements become the sections that an EDS has for them.

use alloc::string::ToString;
use alloc::vec;

use roxmltree::Document;

use crate::read::parsed::Parsed;
use crate::read::sorted;
use crate::rules::text::e0113;
use crate::xdd::source::{Places, Reader};
use crate::xdd::{info, objects};

/// Reads an XDD or an XDC. Findings are in no order yet.
///
/// Never fails, never panics. A text that is not well-formed XML gives an empty
/// description and the place where it breaks.
pub(crate) fn parse(text: &str) -> Parsed {
    let xml = match Document::parse(text) {
        Ok(xml) => xml,
        Err(error) => {
            let place = error.pos();
            let span = Places::new(text).at(place.row, place.col);
            let finding = e0113::finding(span, &error.to_string());
            return Parsed {
                findings: vec![finding],
                ..Parsed::default()
            };
        }
    };
    let mut reader = Reader::new(text);
    let root = xml.root();
    let mut sections = info::sections(root, &mut reader);
    sections.append(&mut objects::sections(root, &mut reader));
    sorted::objects(sections, reader.log)
}
