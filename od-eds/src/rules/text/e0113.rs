//! E0113: XML is not well-formed.

use crate::finding::Severity::Error;
use crate::finding::Rule;

pub(crate) static RULE: Rule = Rule {
    code: "E0113",
    severity: Error,
    title: "XML is not well-formed",
    why: "Nothing can be read of such a file.",
    source: "XML 1.0",
    before: "<CANopenObject index=\"1000\" name=Device type objectType=\"7\" dataType=\"0007\" accessType=\"ro\" PDOmapping=\"no\" defaultValue=\"0x0\"/>",
    after: "<CANopenObject index=\"1000\" name=\"Device type\" objectType=\"7\" dataType=\"0007\" accessType=\"ro\" PDOmapping=\"no\" defaultValue=\"0x0\"/>",
    ..Rule::NEW
};
