//! W0243: module has no section.

use crate::finding::Rule;
use crate::finding::Severity::Warning;

pub(crate) static RULE: Rule = Rule {
    code: "W0243",
    severity: Warning,
    title: "module has no section",
    why: "[SupportedModules] counts the modules of a modular device; [MxModuleInfo] describes module x.",
    source: "CiA 306-1, SupportedModules",
    ..Rule::NEW
};
