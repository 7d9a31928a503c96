use crate::fact::Key;
use crate::finding::{Finding, Rule, Severity::Warning};
use crate::scan::placed::Text;

pub(crate) static RULE: Rule = Rule {
    code: "W0342",
    severity: Warning,
    title: "ObjFlags has reserved bits",
    why: "A tool may give reserved bits a meaning. Bit 0 excludes the object from downloads by a configuration tool, bit 1 from uploads.",
    source: "CiA 306-1, ObjFlags",
    says: "{ObjFlags} is 0x{flags:X}, but only bits 0 and 1 are defined",
    help: "write a number from 0 to 3",
    ..Rule::NEW
};

/// The finding about ObjFlags with bits that have no meaning.
pub(crate) fn finding(given: &Text<'_>, flags: u32) -> Option<Finding> {
    let finding = RULE.at(given.span).key(Key::ObjFlags);
    (flags & !3 != 0).then(|| finding.fact("flags", flags))
}
