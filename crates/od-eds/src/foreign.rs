//! Files of other kinds, whose names look like those of CANopen device files.

use crate::scan::forms;
use crate::scan::names::{Place, intended, place};

/// Names of other files, and how they start.
const STARTS: [(&str, &str); 7] = [
    ("MDF     ", "an MDF log (MF4)"),
    ("LOGG", "a BLF log"),
    ("%PDF-", "a PDF document"),
    ("PK\u{3}\u{4}", "a ZIP archive; unpack it"),
    ("<!doctype html", "a page of HTML"),
    ("<html", "a page of HTML"),
    (
        "version https://git-lfs",
        "a pointer of Git LFS, whose file was not fetched",
    ),
];

/// Names of other files, and texts that they must all contain.
const KINDS: [(&[&str], &str); 13] = [
    (
        &["[File]", "[Device]", "VendCode"],
        "an EDS of EtherNet/IP or DeviceNet (ODVA)",
    ),
    (&["<EtherCATInfo"], "an ESI file of EtherCAT"),
    (&["ethernet-powerlink.org"], "an XDD of Ethernet POWERLINK"),
    (&["<ISO15745Profile", "GSDML"], "a GSDML file of PROFINET"),
    (&["#Profibus_DP"], "a GSD file of PROFIBUS"),
    (&["<IODevice"], "an IODD file of IO-Link"),
    (&["VERSION", "BS_:", "BU_:"], "a DBC file of CAN messages"),
    (&["<PLCopen"], "a PLCopen project"),
    (&["<AUTOSAR"], "an ARXML file of AUTOSAR"),
    (&["<NetworkDefinition"], "a KCD file of CAN messages"),
    (&["FIBEX"], "a FIBEX file"),
    (&["LIN_description_file"], "an LDF file of LIN"),
    (&["ASAP2_VERSION"], "an A2L file (ASAP2)"),
];
/// Number of bytes in which a file must show its kind.
const HEAD: usize = 0x1_0000;

/// Returns what a text is if it is a device file of another fieldbus or another kind of file: `an ESI file of EtherCAT`.
///
/// ```
/// let text = "<?xml version=\"1.0\"?>\n<EtherCATInfo Version=\"1.2\"></EtherCATInfo>\n";
/// assert_eq!(od_eds::foreign(text), Some("an ESI file of EtherCAT"));
/// assert_eq!(od_eds::foreign("[FileInfo]\nFileName=my.eds\n"), None);
/// ```
pub fn foreign(text: &str) -> Option<&'static str> {
    let mut end = text.len().min(HEAD);
    while !text.is_char_boundary(end) {
        end -= 1;
    }
    let head = &text[..end];
    // A CANopen file may contain such a word in a comment or a name.
    if head.contains("[DeviceInfo]") || head.contains("www.canopen.org/xml") {
        return None;
    }
    let start = head.trim_start();
    let is_start = |(own, _): &&(&str, &str)| {
        let start = start.get(..own.len());
        start.is_some_and(|start| start.eq_ignore_ascii_case(own))
    };
    if let Some((_, name)) = STARTS.iter().find(is_start) {
        return Some(name);
    }
    let is_one = |(texts, _): &&(&[&str], _)| texts.iter().all(|text| head.contains(text));
    KINDS.iter().find(is_one).map(|(_, name)| *name)
}

/// Returns whether a text has lines, but neither a section of CiA 306 nor an element of XML: notes, a
/// script, a log. A file of comments only may become an EDS.
///
/// ```
/// assert!(od_eds::lacks_sections("# Notes\n\nSee [the page](page.md).\n"));
/// assert!(!od_eds::lacks_sections("; to do\n[1000\nParameterName=Device type\n"));
/// ```
pub fn lacks_sections(text: &str) -> bool {
    let text = text.trim_start_matches('\u{FEFF}').trim_start();
    let mut lines = text.lines().map(str::trim);
    let is_text = |line: &str| !line.is_empty() && !line.starts_with(';');
    !text.starts_with('<') && lines.clone().any(is_text) && !lines.any(is_section)
}

/// Returns whether a line begins a section that CiA 306 knows, also without its last bracket.
fn is_section(line: &str) -> bool {
    let Some(name) = line.strip_prefix('[') else {
        return false;
    };
    let name = name.split(']').next().unwrap_or(name).trim();
    forms::section(name).is_some()
        || forms::is_of_objects(name)
        || place(name) != Place::Other
        || intended(name, true).is_some()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_file_is_named_by_its_start_or_its_words() {
        for (text, name) in [
            ("MDF     4.10    ", "an MDF log (MF4)"),
            ("\n<!DOCTYPE HTML>\n<html>", "a page of HTML"),
            ("PK\u{3}\u{4}\u{14}", "a ZIP archive; unpack it"),
            (
                "$ EZ-EDS\n[File]\n[Device]\nVendCode = 46;\n",
                "an EDS of EtherNet/IP or DeviceNet (ODVA)",
            ),
            (
                "<?xml version=\"1.0\"?>\n<IODevice xmlns=\"http://www.io-link.com/IODD/2010/10\">",
                "an IODD file of IO-Link",
            ),
            ("/* a */ ASAP2_VERSION 1 61\n", "an A2L file (ASAP2)"),
        ] {
            assert_eq!(foreign(text), Some(name));
        }
        let ours = "; see <html> and %PDF-1.4 of the maker\n[FileInfo]\nFileName=a.eds\n";
        assert_eq!(foreign(ours), None);
    }

    #[test]
    fn a_misspelled_section_is_a_section() {
        for text in [
            "",
            "; nothing yet\n",
            "\u{FEFF}[fileinfo]",
            "[0x1000]\nParameterName=Device type\n",
            "[M1Fixed6000]\n",
            "<odd/>",
        ] {
            assert!(!lacks_sections(text), "{text}");
        }
        assert!(lacks_sections("[colours]\nred=1\n"));
    }
}
