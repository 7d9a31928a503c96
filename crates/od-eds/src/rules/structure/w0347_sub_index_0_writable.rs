use alloc::vec::Vec;

use crate::finding::{Check, Finding, Fixability, Rule};
use crate::fix::Fix;
use crate::rules::profile::shared::in_profile;
use crate::rules::structure::shared::counts_in_use;
use crate::subject::Object;

pub(crate) static W0347: Rule = Rule {
    title: "sub-index 0 of a standard object is writable",
    why: "A master that changes the number of sub-objects makes other masters read sub-objects that do not exist. Only 1003h and PDO mappings have a writable sub-index 0.",
    source: "CiA 301, object structure",
    fixability: Fixability::Unsafe,
    says: "sub-index 0 counts the sub-objects, but its {AccessType} is `{given}`",
    help: "write `{AccessType=const}`{fix}",
    check: Check::Object(check),
    ..Rule::of("W0347")
};

fn check(object: &Object<'_>, findings: &mut Vec<Finding>) {
    let standard = matches!(object.index, 0x1000..0x1F00) || in_profile(object).is_some();
    let fixed = standard && !counts_in_use(object.index);
    if !fixed || !object.code.has_members() {
        return;
    }
    let first = object.entries().next();
    if let Some(count) = first.filter(|entry| entry.address.sub == 0 && entry.access.writable()) {
        let access = count.access;
        let finding = W0347.on(&count, access.span).fact("given", *access);
        findings.push(finding.fix(Fix::unsafe_fix().replace(access.span, "const")));
    }
}
