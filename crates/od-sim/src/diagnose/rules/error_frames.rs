//! Error frames and their periods: no acknowledge, a node with another bit rate, a line without
//! terminators.

use std::format;
use std::prelude::v1::*;

use crate::diagnose::facts::{Facts, Seen, median_interval};
use crate::diagnose::incident::{Cause, Incident};
use crate::diagnose::rule::Rule;
use crate::logs::BusError;

pub(super) const RULE: Rule = Rule {
    name: "error-frames",
    title: "Error frames",
    needs_times: false,
    check,
};

/// Error frames this far apart belong to one incident, in microseconds.
const APART: u64 = 5_000_000;

fn check(facts: &Facts<'_>) -> Vec<Incident> {
    let clusters = facts
        .errors
        .chunk_by(|a, b| b.at.micros_since(a.at) <= APART);
    clusters.map(|errors| incident(facts, errors)).collect()
}

fn incident(facts: &Facts<'_>, errors: &[Seen]) -> Incident {
    let (begin, end) = match errors {
        [first, .., last] => (first.at, last.at),
        [only] => (only.at, only.at),
        [] => (facts.begin, facts.begin),
    };
    let first = facts.frames.partition_point(|seen| seen.at < begin);
    let last = facts.frames.partition_point(|seen| seen.at <= end);
    let good = last.saturating_sub(first);
    let kinds = || errors.iter().filter_map(|seen| facts.error(seen.place));
    let count = kinds().filter(|kind| kind.is_frame()).count();
    let lone = kinds()
        .filter(|kind| *kind == BusError::NoAcknowledge)
        .count();
    let worst = kinds().filter(|kind| !kind.is_frame()).max();
    // Sequences of error frames without another frame between them.
    let runs = errors.chunk_by(|a, b| {
        facts.frames.partition_point(|seen| seen.place < a.place)
            == facts.frames.partition_point(|seen| seen.place < b.place)
    });
    let longest = runs.map(<[Seen]>::len).max().unwrap_or(0);
    let calm = if facts.has_times { 200_000 } else { 0 };
    let is_over = facts
        .frames
        .last()
        .is_some_and(|seen| seen.at > end.plus_micros(calm));
    let text = match (count, good) {
        (0, _) => worst.map_or("errors", BusError::text).to_owned(),
        (1, _) => "1 error frame".to_owned(),
        (_, 1) => format!("{count} error frames and 1 frame between them"),
        _ => format!("{count} error frames and {good} frames between them"),
    };
    let silence = Cause::new(
        "no-acknowledge",
        "no other node acknowledges: one node sends its frame again and again",
        "whether another node has power, is connected, and has the same bit rate; CAN_H and CAN_L may be swapped",
    );
    let rate = Cause::new(
        "bit-rate",
        "a node with another bit rate destroys frames",
        "the bit rate of the node that was switched on or connected last (switches, LSS, EDS)",
    );
    let adapter = Cause::new(
        "adapter-bit-rate",
        "the adapter has another bit rate than the bus: it receives errors only",
        "the bit rate of the adapter; `odkit` and `candump` do not disturb the bus if the adapter is listen-only",
    );
    let terminator = Cause::new(
        "terminator",
        "reflections: a terminator is missing, or a stub is too long",
        "the resistance between CAN_H and CAN_L without power: 60 ohms with both terminators, 120 with one",
    );
    let noise = Cause::new(
        "noise",
        "disturbances from outside, or a bad contact",
        "shield, ground and connectors, and whether the errors come with a drive or a valve that switches",
    );
    let is_many = worst.is_some_and(|worst| worst >= BusError::Passive);
    let is_noise = errors.len() < 5 && good > 20 * errors.len() && !is_many;
    let hears_nothing = good == 0 && !had_frames_before(facts, errors);
    let causes = if lone * 2 > count {
        [silence, rate, terminator]
    } else if hears_nothing && facts.has_times && !is_repeated(errors) {
        [adapter, silence, terminator]
    } else if is_noise {
        [noise, terminator, rate]
    } else if hears_nothing && !facts.has_times {
        [silence, adapter, rate]
    } else if hears_nothing {
        [silence, rate, terminator]
    } else if longest >= 8 {
        // All frames fail, with their repetitions, until the node with the wrong bit rate is
        // bus-off.
        [rate, terminator, silence]
    } else {
        [terminator, noise, rate]
    };
    let mut incident = Incident::new(text, begin, end)
        .recovered(is_over)
        .shows(errors.iter().take(Incident::SHOWN).map(|seen| seen.place));
    incident.causes.extend(causes);
    incident
}

/// Returns whether error frames have the distances of one frame that is sent again and again; frames of a whole bus differ.
fn is_repeated(errors: &[Seen]) -> bool {
    let period = median_interval(errors);
    let near = errors
        .windows(2)
        .filter(|pair| pair[1].at.micros_since(pair[0].at).abs_diff(period) * 4 <= period);
    near.count() * 10 >= errors.len().saturating_sub(1) * 7
}

fn had_frames_before(facts: &Facts<'_>, errors: &[Seen]) -> bool {
    let begin = errors.first().map_or(facts.begin, |seen| seen.at);
    let before = facts.frames.partition_point(|seen| seen.at < begin);
    // A node may have sent a frame before it was the only one on the line.
    before > 2
}
