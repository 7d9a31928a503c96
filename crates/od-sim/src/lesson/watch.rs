//! Runs a script, or lets time pass, while a lesson watches.

use std::prelude::v1::*;

use od_runtime::{Frame, Instant};

use super::progress::Progress;
use crate::bus::Bus;
use crate::script::{Host, Origin};

/// A host that passes all frames to a lesson, too.
pub struct Watched<'a> {
    /// The host that makes the devices.
    pub host: &'a mut dyn Host,
    /// The progress that receives all frames.
    pub progress: &'a mut Progress,
}

impl Host for Watched<'_> {
    fn inner(&mut self) -> Option<&mut dyn Host> {
        Some(self.host)
    }

    /// A learner sees a response before the next step.
    fn waits_for_responses(&mut self) -> bool {
        true
    }

    fn act(&mut self) {
        self.host.act();
        self.progress.note_act();
    }

    fn frame(&mut self, at: Instant, origin: Origin, frame: &Frame) {
        self.host.frame(at, origin, frame);
        self.progress.frame(at, origin, frame);
    }

    fn look(&mut self, bus: &mut Bus) {
        self.host.look(bus);
        while let Some(one) = bus.line.poll() {
            self.progress.disturbed(one.at);
        }
        self.progress.look(bus);
    }
}

/// Lets this number of microseconds pass while a lesson watches.
pub fn pass(bus: &mut Bus, progress: &mut Progress, micros: u64) {
    let end = bus.now().plus_micros(micros);
    loop {
        let sent = bus.advance_until_sent(end);
        while let Some(one) = bus.line.poll() {
            progress.disturbed(one.at);
        }
        while let Some(sent) = bus.poll() {
            progress.frame(sent.at, Origin::of(sent.device), &sent.frame);
            progress.look(bus);
        }
        if !sent {
            progress.look(bus);
            return;
        }
    }
}
