//! Two producers of SYNC.

use std::prelude::v1::*;

use crate::diagnose::facts::{Facts, interleaved};
use crate::diagnose::incident::{Cause, Incident};
use crate::diagnose::rule::Rule;

pub(super) const RULE: Rule = Rule {
    name: "two-sync-producers",
    title: "Two producers of SYNC",
    needs_times: true,
    check,
};

fn check(facts: &Facts<'_>) -> Vec<Incident> {
    // With a counter, each producer counts its own messages.
    let counts: Vec<u8> = facts
        .syncs
        .iter()
        .filter_map(|seen| match facts.frame(seen.place)?.data() {
            [count] => Some(*count),
            _ => None,
        })
        .collect();
    let breaks = counts
        .windows(2)
        .filter(|pair| pair[1] != pair[0].wrapping_add(1) && pair[1] != 1)
        .count();
    let is_mixed = counts.len() >= 8 && breaks * 3 > counts.len();
    let both = if is_mixed {
        &facts.syncs
    } else {
        interleaved(&facts.syncs)
    };
    let [first, .., last] = both else {
        return Vec::new();
    };
    Vec::from([
        Incident::new("two series of SYNC messages take turns", first.at, last.at)
            .recovered(facts.syncs.last().is_some_and(|end| end.place > last.place))
            .shows(both.iter().take(6).map(|seen| seen.place))
            .cause(Cause::new(
                "two-sync-producers",
                "two nodes produce SYNC",
                "bit 30 of 1005h in each node: it may be set in one only",
            )),
    ])
}
