//! Finds the faults in a log of a bus, and their likely causes.
//!
//! [`diagnose`] reads the frames once and collects facts (which node sent which frame and when,
//! which request had which response), calls each rule, and joins the signs of one fault: a loose
//! cable, the EMCY message of the consumer and the requests without a response are one incident.

mod facts;
mod incident;
mod merge;
mod protocol;
mod rule;
mod rules;

use std::prelude::v1::*;

pub use facts::BusFacts;
pub use incident::{Cause, Incident, wrapped};
pub use protocol::other_protocol;

use crate::logs::Record;

/// Maximum number of incidents of one rule; the first are kept.
const MOST: usize = 1000;

/// The incidents of a log, in the order of their beginning. A healthy log has none.
///
/// If all records have one time, the log has no times, and only the order of its frames is known. Then the rules that
/// measure times are not used, and the incidents have no times. In a log of [another protocol](other_protocol) only the rules
/// about the line are used: error frames and the load.
pub fn diagnose<'k>(records: &'k [Record], known: BusFacts<'k>) -> Vec<Incident> {
    let facts = facts::Facts::of(records, known);
    let is_canopen = other_protocol(records).is_none();
    let used = rules::ALL.iter();
    let used = used.filter(|rule| is_canopen || rules::OF_LINE.contains(&rule.name));
    let used = used.filter(|rule| facts.has_times || !rule.needs_times);
    let found = used.flat_map(|rule| {
        let mut all = (rule.check)(&facts);
        all.sort_by_key(|incident| incident.begin);
        all.truncate(MOST);
        for incident in &mut all {
            incident.rule = rule.name;
            incident.has_times = facts.has_times;
        }
        all
    });
    merge::merge(found.collect())
}

/// Names of the rules that measure times.
pub fn rules_with_times() -> impl Iterator<Item = &'static str> {
    let all = rules::ALL.iter().filter(|rule| rule.needs_times);
    all.map(|rule| rule.name)
}

/// Names and titles of the rules.
pub fn rules() -> impl Iterator<Item = (&'static str, &'static str)> {
    rules::ALL.iter().map(|rule| (rule.name, rule.title))
}
