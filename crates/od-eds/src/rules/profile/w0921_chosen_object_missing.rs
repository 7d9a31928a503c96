use alloc::vec::Vec;

use crate::fact::Fact;
use crate::finding::{Check, Finding, Rule, Severity};
use crate::rules::profile::shared::device;
use crate::subject::{Entry, start_value};

pub(crate) static W0921: Rule = Rule {
    title: "value of an I/O module chooses an object that is missing",
    why: "The module acts by a value that a master cannot set. A trigger of an interrupt compares with a limit or a delta; an error mode of 1 sets the output to an error value.",
    source: "CiA 401, objects 6206h, 6250h, 6306h, 6326h, 6421h and 6443h",
    says: "{object} is {given}, which uses object {objects} ({what}), but it is missing",
    help: "add {missing}, or write a value without it",
    check: Check::Entry(check),
    ..Rule::of("W0921")
};

/// Triggers of an interrupt by their bit in 6421h: the objects of which one is enough, and their name.
const TRIGGERS: [(&[u16], &str); 5] = [
    (&[0x6424, 0x6429], "upper limit"),
    (&[0x6425, 0x642A], "lower limit"),
    (&[0x6426, 0x642B], "delta"),
    (&[0x6427, 0x642C], "negative delta"),
    (&[0x6428, 0x642D], "positive delta"),
];

/// Error values of single outputs.
const BITS: [u16; 8] = [
    0x6260, 0x6261, 0x6262, 0x6263, 0x6264, 0x6265, 0x6266, 0x6267,
];

/// The objects that hold the error values of an object of error modes.
fn error_values(index: u16) -> &'static [u16] {
    let bit = usize::from(index & 7);
    match index {
        0x6206 => &[0x6207],
        0x6250..=0x6257 => &BITS[bit..=bit],
        0x6306 => &[0x6307],
        0x6326 => &[0x6327],
        0x6443 => &[0x6444, 0x6445],
        _ => &[],
    }
}

fn check(entry: &Entry<'_>, findings: &mut Vec<Finding>) {
    let description = entry.description;
    let values = error_values(entry.address.index);
    let is_trigger = entry.address.index == 0x6421;
    if entry.address.sub == 0 || values.is_empty() && !is_trigger {
        return;
    }
    let Some(value) = start_value(entry.entry) else {
        return;
    };
    let Some(number) = value
        .integer(0)
        .filter(|_| device(description, 401).is_some())
    else {
        return;
    };
    let mut uses = |any_of: &[u16], what: &'static str| {
        let exists = |index: &u16| description.objects.contains_key(index);
        let Some(first) = any_of.first().filter(|_| !any_of.iter().any(exists)) else {
            return;
        };
        let objects = any_of.iter().map(|index| Fact::Index(*index)).collect();
        let finding = W0921.on(entry, value.span).fact("object", entry.shown());
        let finding = finding.fact("given", number).fact("what", what);
        let finding = finding.fact("objects", Fact::OneOf(objects));
        let finding = finding.fact("missing", Fact::Section(*first, None));
        // The profile gives each trigger as the default, and the limits are optional.
        findings.push(if is_trigger {
            finding.severity_of(Severity::Info)
        } else {
            finding
        });
    };
    if is_trigger {
        for (bit, (any_of, what)) in TRIGGERS.into_iter().enumerate() {
            if number >> bit & 1 != 0 {
                uses(any_of, what);
            }
        }
    } else if number != 0 {
        uses(values, "error value");
    }
}
