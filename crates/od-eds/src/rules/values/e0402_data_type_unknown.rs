use crate::fact::Key;
use crate::finding::{Finding, Rule, Severity::Error};
use crate::scan::placed::Text;
use od_model::DataType;

pub(crate) static RULE: Rule = Rule {
    code: "E0402",
    severity: Error,
    title: "DataType is not a data type",
    why: "DataType is the index of a data type of CiA 301. odkit leaves the value out of the dictionary.",
    source: "CiA 301, data types",
    says: "{DataType} `{given}` is not a data type",
    help: "write `{DataType={right}}` ({right}), or another type",
    ..Rule::NEW
};

/// The finding about a DataType that no type has.
pub(crate) fn finding(given: &Text<'_>) -> Finding {
    let finding = RULE.given(given).key(Key::DataType);
    finding.fact("right", DataType::Unsigned32)
}
