//! An incident: a fault, from its first sign to its last.

use std::prelude::v1::*;

use od_wire::Instant;

/// A likely cause of an incident.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct Cause {
    /// Its name for programs, such as `same-node-id`.
    pub id: &'static str,
    /// The cause, in one sentence.
    pub text: String,
    /// First things to check.
    pub check: String,
}

impl Cause {
    pub(super) fn new(id: &'static str, text: impl Into<String>, check: impl Into<String>) -> Self {
        Self {
            id,
            text: text.into(),
            check: check.into(),
        }
    }
}

/// A fault in a log.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct Incident {
    /// Name of the rule that found it.
    pub rule: &'static str,
    /// The incident in one sentence.
    pub text: String,
    /// The nodes that it is about; empty: the whole bus.
    pub nodes: Vec<u8>,
    /// Whether the log has times; without them begin and end say nothing.
    pub has_times: bool,
    /// Time of the first sign.
    pub begin: Instant,
    /// Time of the last sign, or of the recovery.
    pub end: Instant,
    /// Whether the bus was as before when the log ended.
    pub recovered: bool,
    /// Likely causes, in the order of likelihood.
    pub causes: Vec<Cause>,
    /// Places in the log of the records that show it, at most [`Incident::SHOWN`].
    pub records: Vec<usize>,
}

impl Incident {
    /// Greatest number of records in an incident.
    pub const SHOWN: usize = 8;

    /// Begin, end and whether the bus recovered: `1.500000 to 2.300000, not recovered`, in seconds. Without times only the
    /// last part.
    pub fn span(&self) -> String {
        let state = if self.recovered {
            "recovered"
        } else {
            "not recovered"
        };
        if self.has_times {
            format!("{:?} to {:?}, {state}", self.begin, self.end)
        } else {
            state.into()
        }
    }

    /// The incident as lines of text: what happened, when, each cause with its check, and the records that show it.
    /// `words` is the text of each record of the log.
    pub fn lines(&self, words: &[String]) -> Vec<String> {
        let mut lines = vec![self.text.clone(), self.span()];
        for (place, cause) in (1..).zip(&self.causes) {
            lines.push(format!("cause {place}: {}", cause.text));
            lines.push(format!("         check {}", cause.check));
        }
        let shown = self.records.iter().filter_map(|place| words.get(*place));
        lines.extend(shown.cloned());
        lines
    }

    pub(super) fn new(text: impl Into<String>, begin: Instant, end: Instant) -> Self {
        Self {
            rule: "",
            text: text.into(),
            nodes: Vec::new(),
            has_times: true,
            begin,
            end,
            recovered: false,
            causes: Vec::new(),
            records: Vec::new(),
        }
    }

    pub(super) fn node(mut self, node: u8) -> Self {
        self.nodes.push(node);
        self
    }

    pub(super) fn recovered(mut self, recovered: bool) -> Self {
        self.recovered = recovered;
        self
    }

    pub(super) fn cause(mut self, cause: Cause) -> Self {
        self.causes.push(cause);
        self
    }

    pub(super) fn shows(mut self, records: impl IntoIterator<Item = usize>) -> Self {
        self.records.extend(records);
        self.records.sort_unstable();
        self.records.dedup();
        self.records.truncate(Self::SHOWN);
        self
    }
}
