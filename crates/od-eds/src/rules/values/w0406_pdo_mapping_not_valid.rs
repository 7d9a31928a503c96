use crate::fact::Key;
use crate::finding::{Finding, Form, Rule, Severity};
use crate::scan::placed::Text;
#[cfg(feature = "xdd")]
use crate::span::Spanned;
#[cfg(feature = "xdd")]
use alloc::string::String;

pub(crate) static RULE: Rule = Rule {
    code: "W0406",
    severity: Severity::Warning,
    buildable: true,
    also: &[XDD],
    title: "PDOMapping is neither 0 nor 1",
    why: "PDOMapping gives if a PDO can map the object. odkit assumes 0 (not mappable).",
    source: "CiA 306-1, object sections",
    says: "{PDOMapping} `{given}` is neither 0 nor 1",
    help: "write `{PDOMapping=1}` if a PDO can map the object, and `{PDOMapping=0}` if not",
    ..Rule::NEW
};

/// Sentence for an XDD.
const XDD: Form = Form {
    says: "PDOmapping `{given}` is not valid",
    help: "write `no`, `default`, `optional`, `TPDO` or `RPDO`",
};

/// The same in an XDD, whose schema has other words.
#[cfg(feature = "xdd")]
pub(crate) fn in_xdd(given: &Spanned<String>) -> Finding {
    RULE.given(given)
        .key(Key::PdoMapping)
        .form(&XDD)
        .severity_of(Severity::Error)
}

/// The finding about a PDOMapping that says neither yes nor no.
pub(crate) fn finding(given: &Text<'_>) -> Finding {
    RULE.given(given).key(Key::PdoMapping)
}
