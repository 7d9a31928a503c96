//! Checks: passes each object and value to the rules.

use alloc::collections::BTreeSet;
use alloc::vec::Vec;

use crate::description::Description;
use crate::finding::{Check, Finding, sort};
use crate::log::Log;
use crate::read::modules::modules;
use crate::subject::objects;

pub use crate::allow::{Allows, parse_allow};
pub use crate::codes::{all, rule};
pub use crate::finding::{Fixability, Rule};
pub use crate::rules::RULES;
#[cfg(feature = "explain")]
pub use crate::rules::{Pair, pair};

/// Runs all checks and returns the findings in file order.
///
/// Findings about the text itself come from [`parse`](crate::parse()).
pub fn check(description: &Description) -> Vec<Finding> {
    let mut log = Log::default();
    run(description, &mut log);
    let mut findings = log.finish();
    sort(&mut findings);
    findings
}

/// Runs the checks of all rules, in one pass over the objects.
pub(crate) fn run(description: &Description, log: &mut Log) {
    let (mut of_entries, mut of_objects, mut of_device) = (Vec::new(), Vec::new(), Vec::new());
    for rule in RULES {
        match rule.check {
            Check::Entry(check) => of_entries.push(check),
            Check::Object(check) => of_objects.push(check),
            Check::Device(check) => of_device.push(check),
            Check::Elsewhere => {}
        }
    }
    let mut found = Vec::new();
    let mut report = |found: &mut Vec<Finding>| {
        once(description, found);
        log.extend(found.drain(..));
    };
    for object in objects(description) {
        for entry in object.entries() {
            let checks = of_entries.iter();
            checks.for_each(|check| check(&entry, &mut found));
        }
        let checks = of_objects.iter();
        checks.for_each(|check| check(&object, &mut found));
        report(&mut found);
    }
    // The objects that a device has while a module is plugged in.
    for module in modules(description) {
        let own = Description {
            objects: module.fixed,
            ..Description::default()
        };
        for entry in objects(&own).flat_map(|object| object.entries()) {
            of_entries
                .iter()
                .for_each(|check| check(&entry, &mut found));
        }
        report(&mut found);
    }
    for check in of_device {
        check(description, &mut found);
        report(&mut found);
    }
}

/// Keeps only the first of equal findings about sub-objects that one section describes (CompactSubObj).
fn once(description: &Description, findings: &mut Vec<Finding>) {
    let mut known = BTreeSet::new();
    findings.retain(|finding| {
        let (Some(address), Some(span)) = (finding.object, finding.span()) else {
            return true;
        };
        let own = description.entry(address).map(|entry| entry.span);
        let object = description.objects.get(&address.index);
        let copied = own.is_some() && own == object.map(|object| object.span) && address.sub > 0;
        !copied || known.insert((finding.rule.code, span, address.index))
    });
}
