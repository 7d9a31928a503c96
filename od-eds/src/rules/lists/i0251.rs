//! I0251: [DummyUsage] does not speak of every dummy.

use crate::finding::Severity::Info;
use crate::finding::{Fixability, Rule};

pub(crate) static RULE: Rule = Rule {
    code: "I0251",
    severity: Info,
    title: "[DummyUsage] does not speak of every dummy",
    why: "There are seven dummies, 0001h to 0007h; some readers want to see each of them. 0 is taken for what is missing.",
    source: "CiA 306-1, DummyUsage",
    fixability: Fixability::Safe,
    ..Rule::NEW
};
