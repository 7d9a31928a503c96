use alloc::vec::Vec;

use crate::finding::{Check, Finding, Fixability, Rule};
use crate::fix::Fix;
use crate::subject::Entry;
use od_model::Access;

pub(crate) static W0455: Rule = Rule {
    title: "DCF gives a constant another value",
    why: "The device refuses a download of the value, or a master that does not write constants works with a value that the device does not have.",
    source: "CiA 306-1, AccessType and ParameterValue",
    says: "the value of this `const` object differs from its {DefaultValue}",
    help: "remove {ParameterValue}{fix}, or write the {AccessType} that the device has",
    fixability: Fixability::Unsafe,
    check: Check::Entry(check),
    ..Rule::of("W0455")
};

fn check(entry: &Entry<'_>, findings: &mut Vec<Finding>) {
    if *entry.access == Access::Const
        && let Some(given) = &entry.parameter
        && let Some(default) = &entry.default
        && given.value != default.value
    {
        let finding = W0455.on(entry, given.span);
        let finding = finding.related(default.span, "its constant value");
        findings.push(finding.fix(Fix::unsafe_fix().remove_line(given.span)));
    }
}
