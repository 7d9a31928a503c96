//! W0243: module has no section.

use crate::finding::Severity::Warning;
use crate::finding::Rule;

pub(crate) static RULE: Rule = Rule {
    code: "W0243",
    severity: Warning,
    title: "module has no section",
    why: "[SupportedModules] counts the modules of a modular device; [MxModuleInfo] describes module x.",
    source: "CiA 306-1, SupportedModules",
    before: "\
        [SupportedModules]\n\
        NrOfEntries=2\n\
        1=1\n\
        2=2",
    after: "\
        [SupportedModules]\n\
        NrOfEntries=1\n\
        1=1",
    ..Rule::NEW
};
