//! A bench and its journal. The journal records every input, so that the bench
//! can be repeated up to any time: for a step back, from a link, after a reload.

mod apply;
mod choice;
mod field;
mod input;
mod limits;
mod parts;
mod setup;
#[cfg(test)]
mod tests;

use std::prelude::v1::*;

use od_runtime::DeviceKind;
use od_wire::{Instant, NodeId};

use crate::rig::Rig;

pub use self::apply::{Applied, InputProblem};
pub use self::field::{Error, Fields, Sink, Value};
pub use self::input::{Entry, Input, frame};
pub use self::limits::check;
pub use self::parts::{Dip, Rate, Source};

/// Inputs in one portion of a repeated run; what the bench shows in between is thrown away.
const PORTION: usize = 5000;

/// A device added by the journal.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct AddedDevice {
    /// Its text or built-in device.
    pub source: Source,
    /// Its node ID.
    pub node_id: NodeId,
    /// Name of the built-in device, or title of a device of a file; `name.2` for a further channel.
    pub name: String,
}

/// A bench and its journal.
///
/// ```
/// use od_sim::journal::{Input, Journal, Source};
/// use od_wire::Instant;
///
/// let mut journal = Journal::new(od_devices::DEVICES);
/// let source = Source::Builtin { name: "gxmm".into() };
/// journal.act(Input::Add { source, node_id: 1, place: None });
/// journal.advance(1_000_000, usize::MAX);
/// journal.act(Input::Power { node: 0, on: false });
///
/// // Half a second before, the power was still on.
/// journal.rewind(Instant::from_micros(500_000));
/// assert!(journal.rig.bus.devices()[0].is_powered());
/// journal.advance(500_000, usize::MAX);
/// assert!(!journal.rig.bus.devices()[0].is_powered());
/// ```
pub struct Journal {
    /// The bench. Changes made without the journal are not repeated.
    pub rig: Rig,
    /// The built-in devices.
    roster: &'static [DeviceKind],
    devices: Vec<AddedDevice>,
    #[cfg(feature = "lessons")]
    lesson: Option<crate::lesson::Lesson>,
    entries: Vec<Entry>,
    /// Number of entries that have taken effect; later ones are still to come.
    done: usize,
    /// Number of entries that [`news`](Self::news) returned.
    told: usize,
    /// Reasons why inputs of a repeated run could not be carried out.
    refused: Vec<String>,
    /// Nothing is recorded: the events of a real bus cannot be repeated.
    is_live: bool,
}

impl Journal {
    /// An empty bench with these built-in devices.
    pub fn new(roster: &'static [DeviceKind]) -> Self {
        Self {
            rig: Rig::default(),
            roster,
            devices: Vec::new(),
            #[cfg(feature = "lessons")]
            lesson: None,
            entries: Vec::new(),
            done: 0,
            told: 0,
            refused: Vec::new(),
            is_live: false,
        }
    }

    /// The devices on the bus.
    pub fn devices(&self) -> &[AddedDevice] {
        &self.devices
    }

    /// The lesson in progress.
    #[cfg(feature = "lessons")]
    pub fn lesson(&self) -> Option<&crate::lesson::Lesson> {
        self.lesson.as_ref()
    }

    /// All entries, including those that are still to come.
    pub fn entries(&self) -> &[Entry] {
        &self.entries
    }

    /// Entries that are still to come.
    pub fn to_come(&self) -> usize {
        self.entries.len() - self.done
    }

    /// Returns the entries that are new since the last call, and the number of entries before them;
    /// `None` if nothing is new.
    pub fn news(&mut self) -> Option<(usize, &[Entry])> {
        let from = std::mem::replace(&mut self.told, self.entries.len());
        (from != self.told).then(|| (from, &self.entries[from.min(self.told)..]))
    }

    /// Takes the reasons why inputs of a repeated run could not be carried out.
    pub fn refused(&mut self) -> Vec<String> {
        std::mem::take(&mut self.refused)
    }

    /// Carries out an input now. Entries of an earlier run that are still to come are dropped.
    pub fn act(&mut self, input: Input) -> Applied {
        if let Input::Lesson { .. } = input {
            return self.begin_lesson(input);
        }
        self.entries.truncate(self.done);
        self.told = self.told.min(self.done);
        // Time passes in a script.
        let at = self.rig.bus.now();
        let added = self.apply(&input);
        if added.node.is_some() || !matches!(input, Input::Add { .. }) {
            self.record(at, input);
        }
        self.send_requests();
        added
    }

    /// Puts the bench on a real bus: a link is its outside, and nothing is recorded any more.
    #[cfg(feature = "real")]
    pub fn go_live(&mut self) {
        self.is_live = true;
        self.rig.open_link();
    }

    /// Adds the description of a node of the real bus, like `Input::Add`.
    #[cfg(feature = "real")]
    pub fn describe(&mut self, input: &Input) -> Applied {
        self.rig.describes = true;
        let added = self.apply(input);
        self.rig.describes = false;
        added
    }

    fn record(&mut self, at: Instant, input: Input) {
        if self.is_live {
            return;
        }
        self.entries.push(Entry { at, input });
        self.done += 1;
    }

    /// A lesson starts at time zero and replaces the bench; a wrong one changes nothing.
    fn begin_lesson(&mut self, input: Input) -> Applied {
        if self.is_live {
            return self.apply(&input);
        }
        let mut fresh = Self::new(self.roster);
        fresh.rig.bus.line.set_real(true);
        let added = fresh.apply(&input);
        if added.node.is_some() {
            fresh.rig.take_client(&mut self.rig);
            fresh.record(Instant::ZERO, input);
            *self = fresh;
        }
        added
    }

    /// Sends the frame of the SDO client as an input.
    pub fn send_requests(&mut self) -> bool {
        let mut any = false;
        while let Some(frame) = self.rig.request() {
            self.entries.truncate(self.done);
            self.told = self.told.min(self.done);
            let at = self.rig.bus.now();
            self.rig.note_act();
            self.rig.send(&frame);
            self.record(at, Input::send(&frame));
            any = true;
        }
        any
    }

    /// Lets `micros` pass with the inputs of the journal, or stops earlier after `frames` frames.
    /// Returns the elapsed time.
    pub fn advance(&mut self, micros: u64, frames: usize) -> u64 {
        let start = self.rig.bus.now();
        let end = start.plus_micros(micros);
        let full = self.rig.pending().saturating_add(frames);
        loop {
            let next = self.entries.get(self.done).map(|entry| entry.at);
            let until = next.filter(|at| *at <= end).unwrap_or(end);
            if until > self.rig.bus.now() {
                self.rig.pass(until, full);
            }
            if self.send_requests() {
                continue;
            }
            let now = self.rig.bus.now();
            if next.is_none_or(|at| now < at) || self.rig.pending() >= full {
                return now.micros_since(start);
            }
            let input = &mut self.entries[self.done].input;
            let input = std::mem::replace(input, Input::Leave {});
            let added = self.apply(&input);
            self.refused.extend(added.problem.why(added.node.is_some()));
            self.entries[self.done].input = input;
            self.done += 1;
        }
    }

    /// Goes back to the bench at `to`; later entries stay in the journal and come again.
    pub fn rewind(&mut self, to: Instant) {
        self.begin();
        self.catch_up(to);
    }

    /// Makes an empty bench and repeats a run as time passes. A `quiet` one does not
    /// show the events of its first moment.
    pub fn restore(&mut self, entries: Vec<Entry>, quiet: bool) {
        self.entries = entries;
        self.told = 0;
        self.begin();
        if quiet {
            self.catch_up(Instant::ZERO);
        }
    }

    fn begin(&mut self) {
        self.rig.clear();
        self.rig.bus.line.set_real(true);
        self.devices.clear();
        #[cfg(feature = "lessons")]
        {
            self.lesson = None;
        }
        self.done = 0;
    }

    /// Continues to `to` and throws away what the bench shows.
    fn catch_up(&mut self, to: Instant) {
        while self.rig.bus.now() < to || self.entries.get(self.done).is_some_and(|one| one.at == to)
        {
            let before = self.done;
            let left = to.micros_since(self.rig.bus.now());
            let passed = self.advance(left, PORTION);
            self.rig.drain();
            if passed == 0 && self.done == before {
                return;
            }
        }
    }
}
