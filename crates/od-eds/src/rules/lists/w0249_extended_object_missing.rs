use crate::fact::Fact;
use crate::finding::{Finding, Rule, Severity::Warning};
use crate::span::Span;

pub(crate) static RULE: Rule = Rule {
    code: "W0249",
    severity: Warning,
    title: "module extends an object that does not exist",
    why: "A configuration tool has no object to add the sub-objects of the module to.",
    source: "CiA 306-1, modular devices",
    says: "module {module} extends {object}, which is missing in the device and in the module",
    help: "add {missing}, or remove the section",
    ..Rule::NEW
};

/// The finding about the section of an extension.
pub(crate) fn finding(header: Span, index: u16, module: u16) -> Finding {
    let finding = RULE.at(header).fact("object", Fact::Index(index));
    let missing = Fact::Section(index, None);
    finding.fact("module", module).fact("missing", missing)
}
