//! Joins incidents that are signs of the same fault.

use std::prelude::v1::*;

use super::incident::Incident;

/// Signs of a fault are at most this long before or after it, in microseconds.
const NEAR: u64 = 1_500_000;

/// Returns whether `other` is a sign of the fault in `main`: at the same time, and of the same node
/// or of the whole bus.
fn explains(main: &Incident, other: &Incident) -> bool {
    let is_near =
        other.begin <= main.end.plus_micros(NEAR) && main.begin <= other.end.plus_micros(NEAR);
    let is_same = main.nodes.is_empty() || main.nodes.iter().any(|node| other.nodes.contains(node));
    is_near && is_same
}

/// Returns one incident for each fault, in the order of their beginning. In `all`, an incident that
/// explains others is before them.
pub(super) fn merge(all: Vec<Incident>) -> Vec<Incident> {
    let mut kept: Vec<Incident> = Vec::new();
    for incident in all {
        match kept.iter_mut().find(|main| explains(main, &incident)) {
            Some(main) => join(main, incident),
            None => kept.push(incident),
        }
    }
    kept.sort_by_key(|incident| incident.begin);
    kept
}

fn join(main: &mut Incident, other: Incident) {
    main.begin = main.begin.min(other.begin);
    main.end = main.end.max(other.end);
    main.recovered &= other.recovered;
    if !main.nodes.is_empty() {
        for node in other.nodes {
            if !main.nodes.contains(&node) {
                main.nodes.push(node);
            }
        }
    }
    for cause in other.causes {
        if main.causes.iter().all(|known| known.id != cause.id) {
            main.causes.push(cause);
        }
    }
    let records = core::mem::take(&mut main.records);
    *main = core::mem::replace(
        main,
        Incident::new("", od_wire::Instant::ZERO, od_wire::Instant::ZERO),
    )
    .shows(records.into_iter().chain(other.records));
}
