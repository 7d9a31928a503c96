use crate::finding::{Fixability, Rule, Severity::Info};
use crate::rules::values::shared::WRITE;

pub(crate) static RULE: Rule = Rule {
    code: "I0410",
    severity: Info,
    title: "negative number in two's complement",
    why: "In a signed type, a hexadecimal number can be the bit pattern: FFh is -1 in an INTEGER8. odkit reads it so; some tools do not.",
    source: "CiA 306-1, numbers",
    fixability: Fixability::Safe,
    says: "odkit reads `{given}` as a negative number",
    help: WRITE,
    ..Rule::NEW
};
