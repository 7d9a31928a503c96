use crate::fact::Key;
use crate::finding::{Finding, Rule, Severity::Error};
use crate::scan::placed::Text;

pub(crate) static RULE: Rule = Rule {
    code: "E0402",
    severity: Error,
    title: "DataType is no data type",
    why: "DataType is the index of one of CiA 301's types. The value is left out of the dictionary.",
    source: "CiA 301, data types",
    says: "`{given}` is no data type",
    help: "write the code of a type, for example `0x0007` for UNSIGNED32",
    ..Rule::NEW
};

/// The finding about a DataType that no type has.
pub(crate) fn finding(given: &Text<'_>) -> Finding {
    RULE.given(given).key(Key::DataType)
}
