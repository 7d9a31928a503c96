use alloc::format;

use crate::finding::{Finding, Fixability, Rule, Severity::Warning};
use crate::fix::Fix;
use crate::span::Span;
use od_model::DataType;

pub(crate) static RULE: Rule = Rule {
    code: "W0426",
    severity: Warning,
    title: "DataType of a standard object is missing",
    why: "Many tools leave out a value without a DataType, or stop. odkit assumes the type that the standard specifies for the object.",
    source: "CiA 306-1, object sections; CiA 301, object dictionary",
    fixability: Fixability::Safe,
    says: "{DataType} is missing; the standard specifies {type} here",
    help: "add `{DataType={type}}`{fix}",
    ..Rule::NEW
};

/// The finding about a section without a DataType.
pub(crate) fn finding(header: Span, data_type: DataType) -> Finding {
    let right = format!("DataType=0x{:04X}", data_type.code());
    let fix = Fix::safe().below(header, right);
    RULE.at(header).fact("type", data_type).fix(fix)
}
