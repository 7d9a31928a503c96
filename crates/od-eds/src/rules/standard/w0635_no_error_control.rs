use alloc::vec::Vec;

use crate::description::Description;
use crate::fact::Fact;
use crate::finding::{Check, Finding, Rule};

pub(crate) static W0635: Rule = Rule {
    title: "device has no error control",
    why: "Without a heartbeat or node guarding, no master notices that the node has failed.",
    source: "CiA 301, error control",
    says: "1017h (heartbeat) and 100Ch (node guarding) are both missing",
    help: "add {missing}; every device needs one of the two",
    check: Check::Device(check),
    ..Rule::of("W0635")
};

fn check(description: &Description, findings: &mut Vec<Finding>) {
    let has = |index| description.objects.contains_key(&index);
    if has(0x1000) && !has(0x1017) && !has(0x100C) {
        let missing = Fact::Section(0x1017, None);
        findings.push(W0635.finding().fact("missing", missing));
    }
}
