use crate::fact::Fact;
use crate::finding::{Finding, Rule, Severity::Warning};
use od_model::Address;

pub(crate) static RULE: Rule = Rule {
    code: "W1111",
    severity: Warning,
    title: "mapped object has no room in the message",
    why: "A PDO has 64 bits. odkit leaves out the object that does not fit, and those after it.",
    source: "CiA 301, PDO mapping",
    example: "[1A00sub3] maps 32 bits behind 64",
    says: "{mapped} has no room in the 64 bits of the PDO",
    help: "remove a mapping entry, or map a shorter object",
    ..Rule::NEW
};

/// The finding about an object past the 64 bits of a PDO.
pub(crate) fn finding(pdo: Address, mapped: Address) -> Finding {
    let finding = RULE.finding().about(pdo);
    finding.fact("mapped", Fact::Object(mapped))
}
