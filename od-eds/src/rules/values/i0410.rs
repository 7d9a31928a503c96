use crate::finding::{Fixability, Rule, Severity::Info};

pub(crate) static RULE: Rule = Rule {
    code: "I0410",
    severity: Info,
    title: "two's complement for a negative number",
    why: "In a signed type a hexadecimal number may be the bit pattern: FFh is -1 in an INTEGER8. It is read so; not every reader does.",
    source: "CiA 306-1, numbers",
    fixability: Fixability::Safe,
    says: "`{given}` is read as a negative number",
    help: "write `{key={right}}`",
    ..Rule::NEW
};
