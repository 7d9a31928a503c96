use crate::fact::Key;
use crate::finding::{Finding, Rule, Severity::Warning};
use crate::scan::placed::Text;

pub(crate) static RULE: Rule = Rule {
    code: "W0406",
    severity: Warning,
    title: "PDOMapping is neither 0 nor 1",
    why: "PDOMapping gives if a PDO can map the object. odkit assumes 0 (not mappable).",
    source: "CiA 306-1, object sections",
    says: "{PDOMapping} `{given}` is neither 0 nor 1",
    help: "write `{PDOMapping=1}` if a PDO can map the object, and `{PDOMapping=0}` if not",
    ..Rule::NEW
};

/// The finding about a PDOMapping that says neither yes nor no.
pub(crate) fn finding(given: &Text<'_>) -> Finding {
    RULE.given(given).key(Key::PdoMapping)
}
