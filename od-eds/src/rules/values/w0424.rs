use crate::finding::{Fixability, Rule, Severity::Warning};

pub(crate) static RULE: Rule = Rule {
    code: "W0424",
    severity: Warning,
    title: "word where CiA 306 has another",
    why: "Types and object codes are numbers, PDOMapping is 0 or 1, and AccessType has six words. What is meant is read; many readers refuse it.",
    source: "CiA 306-1, object sections",
    fixability: Fixability::Safe,
    says: "`{given}` is read as `{right}`",
    help: "write `{key={right}}`",
    ..Rule::NEW
};
