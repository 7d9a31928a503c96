use crate::finding::{Fixability, Rule, Severity::Warning};

pub(crate) static RULE: Rule = Rule {
    code: "W0422",
    severity: Warning,
    title: "hexadecimal number without `0x`",
    why: "`FF` and `1Fh` are how other formats write 0xFF and 0x1F. They are read so; many readers refuse them.",
    source: "CiA 306-1, numbers",
    fixability: Fixability::Safe,
    says: "`{given}` is read as hexadecimal",
    help: "write `{key={right}}`",
    ..Rule::NEW
};
