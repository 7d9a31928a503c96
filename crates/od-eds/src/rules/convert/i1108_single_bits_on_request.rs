use crate::finding::{Finding, Rule, Severity::Info};
use crate::span::Span;
use od_model::Address;

pub(crate) static RULE: Rule = Rule {
    code: "I1108",
    severity: Info,
    title: "CANopenNode maps single bits only on request",
    why: "CANopenNode maps whole bytes unless CO_CONFIG_PDO has CO_CONFIG_PDO_BITWISE_MAPPING; without it the PDO is not valid.",
    source: "CANopenNode 4, 301/CO_config.h: CO_CONFIG_PDO_BITWISE_MAPPING",
    example: "[1A00sub1] DefaultValue=0x20000001",
    says: "a mapping entry of {bits:bit|bits} needs CO_CONFIG_PDO_BITWISE_MAPPING",
    help: "add it to CO_CONFIG_PDO",
    ..Rule::NEW
};

/// The finding about a mapping entry that is not of whole bytes.
pub(crate) fn finding(address: Address, value: Span, bits: u8) -> Finding {
    let finding = RULE.at(value).about(address);
    finding.fact("bits", i128::from(bits))
}
