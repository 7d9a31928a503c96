use alloc::vec::Vec;

use crate::finding::{Check, Finding, Rule, Severity::Warning};
use crate::subject::Object;
use crate::subject::Subject;

pub(crate) static RULE: Rule = Rule {
    code: "W0342",
    severity: Warning,
    title: "ObjFlags has reserved bits",
    why: "A tool may give reserved bits a meaning. Bit 0 excludes the object from downloads by a configuration tool, bit 1 from uploads.",
    source: "CiA 306-1, ObjFlags",
    says: "{ObjFlags} is 0x{flags:X}, but only bits 0 and 1 are defined",
    help: "write a number from 0 to 3",
    check: Check::Object(check),
    ..Rule::NEW
};

fn check(object: &Object<'_>, findings: &mut Vec<Finding>) {
    report(object, object.flags, findings);
    for entry in object.entries() {
        report(&entry, entry.flags, findings);
    }
}

fn report(subject: &impl Subject, flags: u32, findings: &mut Vec<Finding>) {
    if flags & !3 != 0 {
        findings.push(RULE.on(subject, subject.span()).fact("flags", flags));
    }
}
