use crate::finding::{Finding, Form, Rule, Severity::Warning};
use crate::scan::placed::Text;
use crate::span::Span;

pub(crate) static RULE: Rule = Rule {
    code: "W0217",
    severity: Warning,
    title: "key or section of a DCF in an EDS",
    why: "An EDS describes a type of device, a DCF one configured device. A tool ignores the value in an EDS, or configures every device of the type with it. odkit uses the value.",
    source: "CiA 306-1, DCF",
    says: "`{name}` belongs to a DCF, and this file is an EDS",
    help: "remove the key, or save the file as a DCF (`FileName` and file name ending in `.dcf`)",
    also: &[SECTION],
    ..Rule::NEW
};

/// Sentence for a section.
const SECTION: Form = Form {
    says: "[{name}] belongs to a DCF, and this file is an EDS",
    help: "remove the section, or save the file as a DCF (`FileName` and file name ending in `.dcf`)",
};

/// The finding about a key.
pub(crate) fn key(key: &Text<'_>) -> Finding {
    RULE.at(key.span).fact("name", &*key.value)
}

/// The finding about a section.
pub(crate) fn section(header: Span, name: &str) -> Finding {
    RULE.at(header).form(&SECTION).fact("name", name)
}
