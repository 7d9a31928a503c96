//! From XML to a description: elements become the sections that an EDS has for them.

use alloc::string::ToString;

use roxmltree::Document;

use crate::description::Description;
use crate::log::Log;
use crate::read::sorted;
use crate::rules::text::e0113_xml_not_well_formed;
use crate::xdd::source::{Places, Reader};
use crate::xdd::{info, objects};

/// Reads an XDD or an XDC.
///
/// Never fails, never panics. A text that is not well-formed XML gives an empty
/// description and the place where it breaks.
pub(crate) fn parse(text: &str, log: &mut Log) -> Description {
    let xml = match Document::parse(text) {
        Ok(xml) => xml,
        Err(error) => {
            let place = error.pos();
            let span = Places::new(text).at(place.row, place.col);
            log.push(e0113_xml_not_well_formed::finding(span, &error.to_string()));
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
