use crate::fact::Key;
use crate::finding::{Finding, Fixability, Rule, Severity::Warning};
use crate::fix::Fix;
use crate::scan::placed::Text;

pub(crate) static RULE: Rule = Rule {
    code: "W0407",
    severity: Warning,
    title: "ObjFlags is no number",
    why: "0 is taken.",
    source: "CiA 306-1, ObjFlags",
    fixability: Fixability::Unsafe,
    says: "`{given}` are no {ObjFlags}",
    help: "write `{ObjFlags=0}`, or leave the line out",
    ..Rule::NEW
};

/// The finding about ObjFlags that are no number.
pub(crate) fn finding(given: &Text<'_>) -> Finding {
    RULE.given(given)
        .key(Key::ObjFlags)
        .fix(Fix::unsafe_fix().replace(given.span, "0"))
}
