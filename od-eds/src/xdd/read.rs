//! From XML to a description: elements become the sections that an EDS has for them.

use alloc::{format, vec};

use roxmltree::Document;

use crate::read::parsed::Parsed;
use crate::read::sorted;
use crate::rules;
use crate::xdd::source::{Places, Reader};
use crate::xdd::{info, objects};

/// Reads an XDD or an XDC. Findings are in no order yet.
///
/// Never fails, never panics. A text that is no well-formed XML gives an empty
/// description and the place where it breaks.
pub(crate) fn parse(text: &str) -> Parsed {
    let xml = match Document::parse(text) {
        Ok(xml) => xml,
        Err(error) => {
            let place = error.pos();
            let span = Places::new(text).at(place.row, place.col);
            let finding = rules::E0113
                .told(span, format!("the XML breaks here: {error}"))
                .with_help("mend the XML; nothing is read of a file that is none");
            return Parsed {
                diagnostics: vec![finding],
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
