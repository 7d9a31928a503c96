//! Converts fixes for an EDS to fixes for an XDD, if they concern the value of one attribute.

use alloc::format;
use alloc::string::String;

use crate::fix::{Action, Edit, Fix};
use crate::scan::number::number;
use crate::xdd::objects::{ACCESS_TYPES, ACCESSES, MAPPINGS};
use crate::xdd::schema;

/// Returns the fix in the form of CiA 311; `None` if one of its edits changes more than the value
/// or the name of an attribute.
pub(crate) fn in_xml(mut fix: Fix, text: &str) -> Option<Fix> {
    for edit in &mut fix.edits {
        if !is_name(edit, text) {
            edit.text = value(edit, text)?;
        }
    }
    Some(fix)
}

/// Returns whether an edit writes the name of an attribute in place of another name.
fn is_name(edit: &Edit, text: &str) -> bool {
    let before = text.get(..edit.span.start as usize).unwrap_or_default();
    let behind = text.get(edit.span.end as usize..).unwrap_or_default();
    edit.action == Action::Replace
        && before.ends_with(char::is_whitespace)
        && behind.trim_start().starts_with('=')
        && schema::is_attribute(&edit.text)
}

/// The new value of the attribute whose whole value an edit replaces.
fn value(edit: &Edit, text: &str) -> Option<String> {
    let before = text.get(..edit.span.start as usize)?;
    let behind = text.get(edit.span.end as usize..)?;
    let quote = before
        .chars()
        .next_back()
        .filter(|c| matches!(c, '"' | '\''))?;
    if edit.action != Action::Replace || !behind.starts_with(quote) {
        return None;
    }
    let name = before[..before.len() - 1]
        .trim_end()
        .strip_suffix('=')?
        .trim_end();
    let start = name
        .rfind(|c: char| !c.is_ascii_alphanumeric())
        .map_or(0, |at| at + 1);
    let given = edit.text.as_str();
    let hexadecimal = |digits: usize| {
        let number = number(given).and_then(|number| u16::try_from(number).ok())?;
        Some(format!("{number:0digits$X}"))
    };
    let decimal = || number(given).map(|number| format!("{number}"));
    match &name[start..] {
        "dataType" => hexadecimal(4),
        "index" => hexadecimal(4),
        "subIndex" | "objFlags" => hexadecimal(2),
        "objectType" | "subNumber" | "nodeID" | "granularity" | "nrOfRxPDO" | "nrOfTxPDO" => {
            decimal()
        }
        "mandatoryObjects" | "optionalObjects" | "manufacturerObjects" => decimal(),
        "accessType" | "access" | "PDOmapping" => {
            let words = match &name[start..] {
                "accessType" => ACCESS_TYPES,
                "access" => ACCESSES,
                _ => MAPPINGS,
            };
            words.contains(&given).then(|| given.into())
        }
        "defaultValue" | "actualValue" | "lowLimit" | "highLimit" | "value" => {
            let is_plain = !given.contains(['<', '>', '&', '"', '\'']);
            is_plain.then(|| given.into())
        }
        "actualBaudRate" => {
            let rate = number(given.strip_suffix(" Kbps").unwrap_or(given))?;
            Some(format!("{rate} Kbps"))
        }
        name => schema::has_word(name, given).then(|| given.into()),
    }
}

#[cfg(test)]
mod tests {
    use alloc::format;

    use crate::Document;
    use crate::fix::{Applicability, fix};

    #[test]
    fn a_fix_of_an_attribute_has_the_form_of_the_schema() {
        let object = |attributes: &str| {
            format!(
                "<ISO15745ProfileContainer xmlns=\"http://www.canopen.org/xml/1.1\">\n\
                 <CANopenObjectList manufacturerObjects=\"1\">\n\
                 <CANopenObject index=\"2000\" name=\"a\" {attributes}/>\n\
                 </CANopenObjectList></ISO15745ProfileContainer>\n"
            )
        };
        for (bad, good) in [
            (
                "objectType=\"7\" dataType=\"0007\" accessType=\"readWrite\" defaultValue=\"1\"",
                "objectType=\"7\" dataType=\"0007\" accessType=\"rw\" defaultValue=\"1\"",
            ),
            (
                "objectType=\"7\" dataType=\"0007\" accessType=\"RW\" PDOmapping=\"tpdo\"",
                "objectType=\"7\" dataType=\"0007\" accessType=\"rw\" PDOmapping=\"TPDO\"",
            ),
            (
                "objectType=\"7\" dataType=\"0007\" accessType=\"rw\" defaultValue=\"$NODE+0x10\"",
                "objectType=\"7\" dataType=\"0007\" accessType=\"rw\" defaultValue=\"$NODEID+0x10\"",
            ),
        ] {
            let find = |document: &Document| document.load().findings;
            let done = fix(&Document::new(object(bad)), Applicability::Unsafe, find);
            assert_eq!(done.document.text(), object(good));
        }
        let counted = object("objectType=\"7\" dataType=\"0007\" accessType=\"rw\"");
        let wrong = counted.replace("manufacturerObjects=\"1\"", "manufacturerObjects=\"4\"");
        let find = |document: &Document| document.load().findings;
        let done = fix(&Document::new(wrong), Applicability::Safe, find);
        assert_eq!(done.document.text(), counted);
    }
}
