use crate::fact::Key;
use crate::finding::{Finding, Fixability, Rule, Severity::Warning};
use crate::fix::Fix;
use crate::scan::placed::Text;

pub(crate) static RULE: Rule = Rule {
    code: "W0406",
    severity: Warning,
    title: "PDOMapping is neither 0 nor 1",
    why: "0 is taken.",
    source: "CiA 306-1, object sections",
    fixability: Fixability::Unsafe,
    says: "{PDOMapping} is 0 or 1, not `{given}`",
    help: "write `{PDOMapping=0}`, which is taken now, or `{PDOMapping=1}`",
    ..Rule::NEW
};

/// The finding about a PDOMapping that says neither yes nor no.
pub(crate) fn finding(given: &Text<'_>) -> Finding {
    RULE.given(given)
        .key(Key::PdoMapping)
        .fix(Fix::unsafe_fix().replace(given.span, "0"))
}
