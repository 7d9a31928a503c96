//! A TPDO that is slower than its event timer, because its inhibit time is longer.

use std::format;
use std::prelude::v1::*;

use od_model::Address;

use crate::diagnose::facts::{Facts, median_interval, millis};
use crate::diagnose::incident::{Cause, Incident};
use crate::diagnose::rule::Rule;

pub(super) const RULE: Rule = Rule {
    name: "inhibit-time",
    title: "A TPDO is held back by its inhibit time",
    needs_times: true,
    check,
};

fn check(facts: &Facts<'_>) -> Vec<Incident> {
    let mut found = Vec::new();
    for id in facts.nodes.keys() {
        for number in 0..512u16 {
            let value = |sub| facts.value(*id, Address::new(0x1800 + number, sub), facts.end);
            let cob_id = value(1).or_else(|| predefined(*id, number));
            let (Some(cob_id), Some(inhibit), Some(timer)) = (cob_id, value(3), value(5)) else {
                if number > 8 { break } else { continue }
            };
            let (inhibit, timer) = (u64::from(inhibit) * 100, u64::from(timer) * 1000);
            let Some(seen) = facts.pdos.get(&((cob_id & 0x7FF) as u16)) else {
                continue;
            };
            let period = median_interval(seen);
            let is_held = timer > 0 && inhibit > timer && period.abs_diff(inhibit) * 10 <= inhibit;
            let [first, .., last] = seen[..] else {
                continue;
            };
            if is_held {
                found.push(
                    Incident::new(
                        format!(
                            "TPDO{} of node {id} comes every {}, its event timer is {}",
                            number + 1,
                            millis(period),
                            millis(timer)
                        ),
                        first.at,
                        last.at,
                    )
                    .node(*id)
                    .shows(seen.iter().take(4).map(|seen| seen.place))
                    .cause(Cause::new(
                        "inhibit-time",
                        format!(
                            "its inhibit time, {}, is longer than its event timer",
                            millis(inhibit)
                        ),
                        format!("{:04X}h:03 and :05 of node {id}", 0x1800 + number),
                    )),
                );
            }
        }
    }
    found
}

/// The COB-ID of the pre-defined connection set.
fn predefined(id: u8, number: u16) -> Option<u32> {
    (number < 4).then(|| 0x180 + 0x100 * u32::from(number) + u32::from(id))
}
