//! E0208: sub-index without its object.

use crate::Severity::Error;
use crate::check::rules::{Mending, Rule};

pub(crate) const RULE: Rule = Rule {
    code: "E0208",
    severity: Error,
    title: "sub-index without its object",
    why: "The section of the object itself says its code and name. The members are kept in an object without a name.",
    source: "CiA 306-1, object sections",
    mending: Mending::None,
    before: "",
    after: "",
};
