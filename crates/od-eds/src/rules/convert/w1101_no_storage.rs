use crate::finding::{Finding, Rule, Severity::Warning};
use crate::span::Span;
use od_model::{Address, DataType};

pub(crate) static RULE: Rule = Rule {
    code: "W1101",
    severity: Warning,
    title: "CANopenNode has no storage for the value",
    why: "OD.c has a variable for each value, and its length does not change. A DOMAIN or OCTET_STRING without a default value has no length, so the node aborts each request for it with 06090011h until the application provides the data.",
    source: "CANopenNode 4, 301/CO_ODinterface.h: OD_stream_t",
    example: "[2100] DataType=0x000F, without a DefaultValue",
    says: "OD.c has no storage for a {type} without a default value",
    help: "provide the data by `OD_extension_init`, or add a DefaultValue",
    ..Rule::NEW
};

/// The finding about a value without a length.
pub(crate) fn finding(address: Address, section: Span, data_type: DataType) -> Finding {
    RULE.at(section).about(address).fact("type", data_type)
}
