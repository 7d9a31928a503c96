use alloc::vec::Vec;

use crate::description::Description;
use crate::finding::{Check, Finding, Form, Rule};
use crate::subject::{Object, start_number};
use od_model::Address;

pub(crate) static E0541: Rule = Rule {
    buildable: true,
    title: "multiplexed PDO names an object that it cannot carry",
    why: "The device cannot send the value, or no value goes into the object.",
    source: "CiA 301, MPDO protocol, objects 1FA0h to 1FFFh",
    says: "{target} does not exist",
    help: "write an object of this device, or 0 for an entry that is not used",
    also: &[LONG, PRODUCER],
    check: Check::Object(check),
    ..Rule::of("E0541")
};

/// Sentence for an object with too many bytes.
const LONG: Form = Form {
    says: "{target} has {bytes:byte|bytes}; a multiplexed PDO carries at most 4",
    help: "use an ordinary PDO for this object",
};

/// Sentence for a producer that cannot exist.
const PRODUCER: Form = Form {
    says: "node ID {id} of the producer (bits 0 to 7) is not valid",
    help: "write 1 to 127",
};

fn check(object: &Object<'_>, findings: &mut Vec<Finding>) {
    let index = object.index;
    for entry in object.entries().filter(|entry| entry.address.sub != 0) {
        let number = start_number(object.description, entry.address);
        let Some(number) = number.filter(|number| number.value != 0) else {
            continue;
        };
        // The number of sub-objects from this one on, and the first one.
        let (block, first) = match index {
            0x1A00..=0x1BFF if is_destination(object) && entry.address.sub == 1 => {
                (1, number.value >> 8)
            }
            0x1FA0..=0x1FCF => (number.value >> 24 & 0xFF, number.value),
            0x1FD0..=0x1FFF => {
                let id = number.value & 0xFF;
                if !(1..=127).contains(&id) {
                    let finding = E0541.on(&entry, number.span).form(&PRODUCER);
                    findings.push(finding.fact("id", i128::from(id)));
                }
                (number.value >> 56, number.value >> 32)
            }
            _ => continue,
        };
        let first = Address::new((first >> 8) as u16, first as u8);
        let last = u64::from(first.sub).saturating_add(block.max(1)).min(0x100);
        let mut wrong = (first.sub..=(last - 1) as u8).filter_map(|sub| {
            let target = Address::new(first.index, sub);
            match size(object.description, target) {
                Some(0..=4) => None,
                Some(bytes) => Some(
                    E0541
                        .on(&entry, number.span)
                        .form(&LONG)
                        .fact("bytes", bytes)
                        .fact("target", target),
                ),
                None => Some(E0541.on(&entry, number.span).fact("target", target)),
            }
        });
        findings.extend(wrong.next());
    }
}

/// Returns whether this is the mapping of a PDO in destination address mode. In source address mode the list of
/// 1FA0h has the objects.
fn is_destination(object: &Object<'_>) -> bool {
    let count = start_number(object.description, Address::new(object.index, 0));
    count.is_some_and(|count| count.value == 255)
}

/// The bytes of a value; `None` if it does not exist. A value of unknown length counts as fitting: another rule
/// reports it.
fn size(description: &Description, target: Address) -> Option<usize> {
    let entry = description.entry(target)?;
    let data_type = entry.data_type.map(|given| given.value);
    Some(
        data_type
            .and_then(|data_type| data_type.size())
            .unwrap_or(0),
    )
}
