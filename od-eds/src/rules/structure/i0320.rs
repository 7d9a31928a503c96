use crate::finding::{Finding, Fixability, Rule, Severity::Info};
use crate::fix::Fix;
use crate::scan::placed::Text;

pub(crate) static RULE: Rule = Rule {
    code: "I0320",
    severity: Info,
    title: "field is empty",
    why: "A number, a type or an access says nothing when it is empty. It is read as if the line were not there; many readers stop at it.",
    source: "CiA 306-1, object sections",
    fixability: Fixability::Safe,
    says: "`{name}` is empty",
    help: "give `{name}` a value, or leave the line out",
    ..Rule::NEW
};

/// The finding about a key without the value that it needs.
pub(crate) fn finding(key: &Text<'_>) -> Finding {
    let finding = RULE.at(key.span).fact("name", &*key.value);
    finding.fix(Fix::safe().remove_line(key.span))
}
