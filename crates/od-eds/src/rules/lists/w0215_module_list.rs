use crate::fact::Fact;
use crate::finding::{Finding, Form, Rule, Severity::Warning};
use crate::span::Span;

pub(crate) static RULE: Rule = Rule {
    code: "W0215",
    severity: Warning,
    title: "list of a module does not match its sections",
    why: "A configuration tool creates only the objects that the list names. odkit reads every section.",
    source: "CiA 306-1, modular devices",
    says: "{object} is listed, but its section in module {module} is missing",
    help: "add the section, or remove the entry",
    also: &[UNLISTED],
    ..Rule::NEW
};

/// Sentence for a section that the list lacks.
const UNLISTED: Form = Form {
    says: "{object} is missing from [{list}]",
    help: "add `0x{object:04X}` to [{list}]",
};

/// The finding about an entry of a module's list without a section.
pub(crate) fn no_section(entry: Span, index: u16, module: u16) -> Finding {
    let finding = RULE.at(entry).fact("object", Fact::Index(index));
    finding.fact("module", module)
}

/// The finding about an object of a module that is not in the list of this name.
pub(crate) fn unlisted(header: Span, index: u16, list: &str) -> Finding {
    let finding = RULE.at(header).form(&UNLISTED);
    finding
        .fact("object", Fact::Index(index))
        .fact("list", list)
}
