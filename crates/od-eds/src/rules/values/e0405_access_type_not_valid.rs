use crate::fact::Key;
use crate::finding::{Finding, Rule, Severity::Error};
use crate::scan::placed::Text;

pub(crate) static RULE: Rule = Rule {
    code: "E0405",
    severity: Error,
    title: "AccessType is not valid",
    why: "AccessType gives what a master can read and write. odkit assumes `ro`.",
    source: "CiA 306-1, object sections",
    says: "`{given}` is not a valid {AccessType}",
    help: "write `ro`, `wo`, `rw`, `rwr`, `rww` or `const` (odkit assumes `ro`)",
    ..Rule::NEW
};

/// The finding about an unknown AccessType.
pub(crate) fn finding(given: &Text<'_>) -> Finding {
    RULE.given(given).key(Key::AccessType)
}
