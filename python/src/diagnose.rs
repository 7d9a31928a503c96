//! The faults in the frames of a bench, and their likely causes.

use od_sim::diagnose::{BusFacts, Incident as Found, diagnose as incidents};
use pyo3::prelude::*;

use crate::state::State;

/// A fault in the frames of a bench: what happened, when, and its likely causes. `str(incident)` is its text for people.
#[pyclass(frozen, get_all, module = "odkit")]
pub(crate) struct Incident {
    /// Name of the rule that found it, such as `heartbeat-lost`.
    rule: &'static str,
    /// The incident in one sentence.
    text: String,
    /// The nodes that it is about; empty: the whole bus.
    nodes: Vec<u8>,
    /// Time of the first sign, in seconds.
    begin: f64,
    /// Time of the last sign, or of the recovery, in seconds.
    end: f64,
    /// Whether the bus was as before at the end.
    recovered: bool,
    /// The causes, the likeliest first: each with what to check.
    causes: Vec<(String, String)>,
    /// The lines of the log that show it.
    frames: Vec<String>,
    /// All of it as lines.
    lines: Vec<String>,
}

#[pymethods]
impl Incident {
    fn __str__(&self) -> String {
        self.lines.join("\n")
    }

    fn __repr__(&self) -> String {
        format!("<odkit.Incident {}: {}>", self.rule, self.text)
    }
}

impl Incident {
    fn of(found: Found, log: &[String]) -> Self {
        let shown = found.records.iter().filter_map(|place| log.get(*place));
        Self {
            rule: found.rule,
            nodes: found.nodes.clone(),
            begin: found.begin.as_micros() as f64 / 1e6,
            end: found.end.as_micros() as f64 / 1e6,
            recovered: found.recovered,
            frames: shown.cloned().collect(),
            lines: found.lines(log),
            text: found.text,
            causes: found
                .causes
                .into_iter()
                .map(|cause| (cause.text, cause.check))
                .collect(),
        }
    }
}

/// The incidents of a bench so far, in the order of their beginning.
pub(crate) fn of(state: &mut State) -> Vec<Incident> {
    let devices = state.bus.devices();
    let dictionary = |node: u8| {
        let mut all = devices.iter().filter(|device| device.is_configured());
        let device = all.find(|device| device.node_id().raw() == node)?;
        Some(device.dictionary())
    };
    let known = BusFacts {
        bit_rate: state.bus.bit_rate(),
        dictionary: Some(&dictionary),
    };
    let found = incidents(state.journal.records(), known);
    if found.is_empty() {
        return Vec::new();
    }
    let log = state.journal.lines(devices, 0);
    let all = found.into_iter();
    all.map(|found| Incident::of(found, &log)).collect()
}
