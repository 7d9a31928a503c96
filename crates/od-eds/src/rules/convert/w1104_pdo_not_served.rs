use crate::fact::Fact;
use crate::finding::{Finding, Form, Rule, Severity::Warning};
use crate::span::Span;
use od_model::Address;

pub(crate) static RULE: Rule = Rule {
    code: "W1104",
    severity: Warning,
    title: "CANopenNode cannot serve the PDO",
    why: "CANopenNode takes the PDOs one after the other, from 1400h, 1600h, 1800h and 1A00h on, and each has at most 8 mapping entries. After a gap it serves another PDO than the master configures; a PDO with more entries is not valid.",
    source: "CANopenNode 4, CANopen.c: CO_CANopenInitPDO; 301/CO_PDO.h: CO_PDO_MAX_MAPPED_ENTRIES",
    example: "[1400], [1402], without [1401]",
    says: "CANopenNode needs {missing}, since it takes PDOs one after the other",
    help: "add {section}; it may be a PDO that is not valid (bit 31 of its COB-ID)",
    also: &[MANY],
    ..Rule::NEW
};

const MANY: Form = Form {
    says: "{count:mapping entry|mapping entries} of a PDO; CANopenNode has 8",
    help: "map at most 8 objects",
};

/// The finding about an object that the PDOs before or after it need.
pub(crate) fn gap(missing: u16) -> Finding {
    let finding = RULE.finding().about(Address::new(missing, 0));
    let finding = finding.fact("missing", Fact::Index(missing));
    finding.fact("section", Fact::Section(missing, None))
}

/// The finding about a PDO that maps too many objects.
pub(crate) fn many(address: Address, value: Span, count: i128) -> Finding {
    let finding = RULE.at(value).about(address).form(&MANY);
    finding.fact("count", count)
}
