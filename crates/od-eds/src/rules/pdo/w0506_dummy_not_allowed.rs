use alloc::format;
use alloc::vec::Vec;

use crate::fact::Fact;
use crate::finding::{Check, Finding, Fixability, Rule};
use crate::fix::Fix;
use crate::rules::pdo::shared::mapped;
use crate::scan::number::number;
use crate::subject::Object;

pub(crate) static W0506: Rule = Rule {
    title: "[DummyUsage] does not allow the dummy entry",
    why: "[DummyUsage] lists which of the types 0001h to 0007h an RPDO can map as dummy entries. A device aborts the mapping of another.",
    source: "CiA 306-1, DummyUsage",
    fixability: Fixability::Unsafe,
    says: "[DummyUsage] does not allow dummy entry {dummy}",
    help: "write `{line}` in [DummyUsage]{fix}",
    check: Check::Object(check),
    ..Rule::of("W0506")
};

fn check(object: &Object<'_>, findings: &mut Vec<Finding>) {
    for mapped in mapped(object) {
        let rightly = mapped.is_dummy() && mapped.rpdo && mapped.wrong_length().is_none();
        let key = format!("Dummy{:04X}", mapped.target.index);
        let usage = object.description.section("DummyUsage");
        let given = usage.and_then(|usage| usage.get(&key));
        if !rightly || given.and_then(|given| number(given)) == Some(1) {
            continue;
        }
        let line = format!("{key}=1");
        let fix = match (given, usage) {
            (Some(given), _) => Fix::unsafe_fix().replace(given.span, "1"),
            (None, Some(usage)) => Fix::unsafe_fix().below(usage.name.span, line.as_str()),
            (None, None) => Fix::unsafe_fix(),
        };
        let finding = mapped
            .finding(&W0506)
            .fact("dummy", Fact::Index(mapped.target.index));
        findings.push(finding.fact("line", line).fix(fix));
    }
}
