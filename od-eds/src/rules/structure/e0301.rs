//! E0301: ObjectType is no object code.

use crate::finding::Severity::Error;
use crate::finding::Rule;

pub(crate) static RULE: Rule = Rule {
    code: "E0301",
    severity: Error,
    title: "ObjectType is no object code",
    why: "The object code says what kind of object it is. It is guessed from what the object has.",
    source: "CiA 301, object codes",
    ..Rule::NEW
};
