use crate::fact::Key;
use crate::finding::{Finding, Fixability, Rule, Severity::Warning};
use crate::fix::Fix;
use crate::scan::placed::Text;

pub(crate) static RULE: Rule = Rule {
    code: "W0407",
    severity: Warning,
    title: "ObjFlags is not a number",
    why: "ObjFlags tells a tool how to handle the object. odkit assumes 0.",
    source: "CiA 306-1, ObjFlags",
    fixability: Fixability::Unsafe,
    says: "`{given}` is not a valid {ObjFlags}",
    help: "write `{ObjFlags=0}`{fix}, or remove the line",
    ..Rule::NEW
};

/// The finding about ObjFlags that are not a number.
pub(crate) fn finding(given: &Text<'_>) -> Finding {
    RULE.given(given)
        .key(Key::ObjFlags)
        .fix(Fix::unsafe_fix().replace(given.span, "0"))
}
