//! The frames of a bus so far.

use std::collections::VecDeque;

use od_sim::VirtualDevice;
use od_sim::logs::{Record, What};
use od_sim::words::Decoder;
use od_wire::{Frame, Instant};

/// Maximum number of frames; the oldest ones are dropped.
const KEPT: usize = 2_000_000;

/// The last frames of a bus.
#[derive(Clone, Default)]
pub(crate) struct Journal {
    records: VecDeque<Record>,
    /// Number of dropped records.
    dropped: usize,
}

impl Journal {
    /// Adds a frame, or an error frame.
    pub(crate) fn add(&mut self, at: Instant, sent: bool, what: What) {
        if self.records.len() == KEPT {
            self.records.pop_front();
            self.dropped += 1;
        }
        self.records.push_back(Record { at, sent, what });
    }

    /// Number of all frames so far.
    pub(crate) fn end(&self) -> usize {
        self.dropped + self.records.len()
    }

    pub(crate) fn since(&self, number: usize) -> impl Iterator<Item = &Record> {
        let from = number.saturating_sub(self.dropped).min(self.records.len());
        self.records.range(from..)
    }

    /// The number of the first record not before a moment.
    pub(crate) fn at(&self, moment: Instant) -> usize {
        self.dropped + self.records.partition_point(|one| one.at < moment)
    }

    /// The records that are kept.
    pub(crate) fn records(&mut self) -> &[Record] {
        self.records.make_contiguous()
    }

    /// Lines to display, from a number on: time, frame, and its meaning in words.
    pub(crate) fn lines(&self, devices: &[VirtualDevice], number: usize) -> Vec<String> {
        let mut decoder = Decoder::default();
        let records = self.since(number);
        records
            .map(|record| {
                let direction = if record.sent { "->" } else { "<-" };
                let at = record.at;
                match record.what {
                    What::Frame(frame) => {
                        let words = decoder.explain(devices, &frame);
                        format!("{at:?} {direction} {:<21}  {words}", frame.to_string())
                    }
                    What::Error(error) => format!("{at:?} {direction} {}", error.text()),
                }
            })
            .collect()
    }

    /// Forgets all records.
    pub(crate) fn clear(&mut self) {
        *self = Self::default();
    }
}

pub(crate) fn frame(record: &Record) -> Option<Frame> {
    match record.what {
        What::Frame(frame) => Some(frame),
        What::Error(_) => None,
    }
}
