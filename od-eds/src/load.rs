//! Reading and checking in one call.

use crate::read::Parsed;
use crate::read::sorted::parse;

/// Reads and checks an EDS or a DCF: [`parse`], then [`check`](crate::check::check),
/// without what the text [allows](crate::check::Allows).
pub fn load(text: &str) -> Parsed {
    checked(parse(text), text)
}

/// What was read, with the findings of all checks.
pub(crate) fn checked(mut parsed: Parsed, text: &str) -> Parsed {
    parsed
        .diagnostics
        .extend(crate::check::check(&parsed.description));
    crate::finding::sort(&mut parsed.diagnostics);
    crate::check::Allows::of(text).apply(&mut parsed.diagnostics);
    #[cfg(feature = "xdd")]
    if crate::xdd::is_xml(text) {
        // What mends an EDS would break an XML.
        for finding in &mut parsed.diagnostics {
            finding.fix = None;
        }
    }
    parsed
}
