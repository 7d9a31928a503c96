use alloc::vec::Vec;

use crate::description::Description;
use crate::finding::{Check, Finding, Rule};
use crate::rules::profile::shared::{POSITIONS, device};
use crate::subject::start_number;
use od_model::Address;

pub(crate) static W0963: Rule = Rule {
    title: "no TPDO maps the position value",
    why: "A master receives no position until it maps one.",
    source: "CiA 406, PDO mapping",
    says: "no TPDO maps the position value",
    help: "write `{DefaultValue=0x60040020}` in [1A00sub1] (6004h, 32 bits)",
    check: Check::Device(check),
    ..Rule::of("W0963")
};

fn check(description: &Description, findings: &mut Vec<Finding>) {
    let mut mappings = description.objects.range(0x1A00..=0x1BFF).peekable();
    let Some((first, object)) = mappings.peek().copied() else {
        return;
    };
    let carries = mappings.any(|(index, object)| {
        object.entries.range(1..=64).any(|(sub, _)| {
            let target = start_number(description, Address::new(*index, *sub));
            let target = target.map(|target| (target.value >> 16) as u16);
            target.is_some_and(|target| POSITIONS.contains(&target) || target == 0x600C)
        })
    });
    if !carries && device(description, 406).is_some() {
        findings.push(W0963.at(object.span).about(Address::new(*first, 0)));
    }
}
