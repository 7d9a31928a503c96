//! E0301: ObjectType is no object code.

use crate::Severity::Error;
use crate::check::rules::{Mending, Rule};

pub(crate) const RULE: Rule = Rule {
    code: "E0301",
    severity: Error,
    title: "ObjectType is no object code",
    why: "The object code says what kind of object it is. It is guessed from what the object has.",
    source: "CiA 301, object codes",
    mending: Mending::None,
    before: "",
    after: "",
};
