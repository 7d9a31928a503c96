//! E0113: XML is not well-formed.

use crate::diagnostic::Severity::Error;
use crate::rules::{Mending, Rule};

pub(crate) const RULE: Rule = Rule {
    code: "E0113",
    severity: Error,
    title: "XML is not well-formed",
    why: "Nothing can be read of such a file.",
    source: "XML 1.0",
    mending: Mending::None,
    before: "<CANopenObject index=\"1000\" name=Device type objectType=\"7\" dataType=\"0007\" accessType=\"ro\" PDOmapping=\"no\" defaultValue=\"0x0\"/>",
    after: "<CANopenObject index=\"1000\" name=\"Device type\" objectType=\"7\" dataType=\"0007\" accessType=\"ro\" PDOmapping=\"no\" defaultValue=\"0x0\"/>",
};
