//! Reading and checking. Only this file asks if a text is an EDS or XML.

use alloc::vec::Vec;

use crate::allow::Allows;
use crate::check::check;
use crate::document::Document;
use crate::finding::{Finding, sort};
use crate::read::modules;
use crate::read::parsed::Parsed;
use crate::read::sorted;
use crate::rules::text::{i0111, w0112};
use crate::scan::encoding::Encoding;
use crate::scan::lines;
#[cfg(feature = "xdd")]
use crate::xdd;

/// Returns if a text is XML, so an XDD or an XDC, not an EDS.
pub fn is_xml(text: &str) -> bool {
    let text = text.trim_start_matches('\u{FEFF}');
    text.trim_start().starts_with('<')
}

/// Reads an EDS or a DCF; with feature `xdd`, an XDD or an XDC too.
///
/// Never fails, never panics: what it cannot read is a finding, and text in the `extra` of where
/// it was. It does not check: see [`check`](crate::check::check) and [`load`].
pub fn parse(text: &str) -> Parsed {
    ordered(read(text), text)
}

/// Reads and checks a text: [`parse`], then [`check`](crate::check::check), without what the
/// text [allows](crate::check::Allows).
pub fn load(text: &str) -> Parsed {
    checked(read(text), text)
}

impl Document {
    /// Reads the file as [`parse`](crate::parse()) does. Reports its encoding too.
    pub fn parse(&self) -> Parsed {
        ordered(self.read(), self.text())
    }

    /// Reads and checks the file as [`load`](crate::load()) does. Reports its encoding too.
    pub fn load(&self) -> Parsed {
        checked(self.read(), self.text())
    }

    fn read(&self) -> Parsed {
        let mut parsed = read(self.text());
        parsed.findings.extend(encoded(self));
        parsed
    }
}

/// Reads a text in its form. Findings are in no order yet.
fn read(text: &str) -> Parsed {
    #[cfg(feature = "xdd")]
    if is_xml(text) {
        return xdd::parse(text);
    }
    let mut parsed = sorted::eds(text);
    modules::check(&parsed.description.sections, &mut parsed.findings);
    parsed
}

fn checked(mut parsed: Parsed, text: &str) -> Parsed {
    parsed.findings.extend(check(&parsed.description));
    Allows::of(text).apply(&mut parsed.findings);
    ordered(parsed, text)
}

/// Puts the findings in file order.
fn ordered(mut parsed: Parsed, text: &str) -> Parsed {
    sort(&mut parsed.findings);
    if cfg!(feature = "xdd") && is_xml(text) {
        // A fix of an EDS would break an XML.
        for finding in &mut parsed.findings {
            finding.fix = None;
        }
    }
    parsed
}

/// Findings about the encoding.
fn encoded(document: &Document) -> Vec<Finding> {
    let (text, encoding) = (document.text(), document.encoding());
    let mut found = Vec::new();
    let first = text.find(|c: char| !c.is_ascii());
    // XML says how it is written, and every tool that reads XML knows these.
    if encoding != Encoding::Ascii && !is_xml(text) {
        let first = lines::span(text, first.unwrap_or(0));
        found.push(i0111::finding(first, encoding, document.has_mark()));
    }
    if let Some(at) = document.first_wrong() {
        found.push(w0112::finding(lines::span(text, at), encoding));
    }
    found
}
