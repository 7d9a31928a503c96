//! Lessons and scripts on a rig.

use std::prelude::v1::*;

use od_model::Refused;
use od_wire::Instant;

use super::{Rig, Seen, Taken};
use crate::bench::Bench;
use crate::bus::Bus;
use crate::grammar::problem::Problem;
use crate::lesson::{Lesson, Progress, Watched};
use crate::rig::clockwork::Clockwork;
use crate::script::{Host, Origin, Recorder, Script, run_on};

impl Rig {
    /// Starts a lesson: its set-up takes the place of all that is on the bus, and time goes on.
    ///
    /// # Errors
    /// The problems of the text, or of its set-up.
    pub fn start_lesson(
        &mut self,
        text: &str,
        host: &mut dyn Host,
    ) -> Result<Lesson, Vec<Problem>> {
        let lesson = Lesson::parse(text)?;
        let mut bus = Bus::new();
        bus.advance(self.bus.now());
        #[cfg(feature = "real")]
        let set_up = if self.has_port() {
            lesson.describe(bus, host)
        } else {
            lesson.set_up_on(Bench::new(bus), host)
        };
        #[cfg(not(feature = "real"))]
        let set_up = lesson.set_up_on(Bench::new(bus), host);
        let mut names = set_up.map_err(|problem| vec![problem])?;
        let progress = Progress::new(lesson.clone(), &mut names);
        self.bus = std::mem::take(&mut names.bus);
        self.clockwork = Clockwork::default();
        self.seen.clear();
        self.outcomes.extend(self.asker.give_up());
        self.taken = Some(Taken { progress, names });
        Ok(lesson)
    }

    /// Ends the lesson; what is on the bus stays.
    pub fn end_lesson(&mut self) {
        self.taken = None;
    }

    /// The lesson in progress as it is now, and its bus.
    pub fn lesson(&mut self) -> Option<(&mut Progress, &mut Bus)> {
        self.look();
        let taken = self.taken.as_mut()?;
        Some((&mut taken.progress, &mut self.bus))
    }

    /// Runs lines of a script, such as the solution of a step; time passes where they say so.
    /// They are about the first device until `use` names another one.
    ///
    /// # Errors
    /// The line that cannot be read or fails; what the lines before it did stays.
    pub fn run_script(&mut self, text: &str, host: &mut dyn Host) -> Result<(), Refused> {
        let script = Script::parse(text).map_err(|all| match all.first() {
            Some(problem) => problem.to_string(),
            None => String::new(),
        })?;
        let bus = std::mem::take(&mut self.bus);
        let seen = &mut self.seen;
        let record = |at, origin, frame| {
            let device = match origin {
                Origin::Script => None,
                Origin::Device(device) => Some(device),
            };
            seen.push(Seen::Frame { at, device, frame });
        };
        let mut recorder = Recorder { host, record };
        let (result, bus) = match &mut self.taken {
            Some(taken) => {
                taken.names.bus = bus;
                let mut watched = Watched {
                    host: &mut recorder,
                    progress: &mut taken.progress,
                };
                let result = run_on(&script, &mut taken.names, &mut watched);
                (result, std::mem::take(&mut taken.names.bus))
            }
            None => {
                let mut bench = Bench::new(bus);
                let result = run_on(&script, &mut bench, &mut recorder);
                (result, bench.bus)
            }
        };
        self.bus = bus;
        self.settle();
        result.map(|_| ()).map_err(|stop| stop.to_string().into())
    }

    /// A frame came through, from outside or from a device. What came over a link is a device's.
    pub(super) fn watched(&mut self, seen: &Seen) {
        let (at, origin, frame) = match *seen {
            Seen::Frame { at, device, frame } => {
                (at, device.map_or(Origin::Script, Origin::Device), frame)
            }
            Seen::Heard { at, device, frame } => {
                (at, Origin::Device(device.unwrap_or(usize::MAX)), frame)
            }
            Seen::Disturbed(..) => return,
        };
        if let Some(taken) = &mut self.taken {
            taken.progress.frame(at, origin, &frame);
            taken.progress.look(&mut self.bus);
        }
    }

    /// A frame was disturbed on the bus line.
    pub(super) fn lost(&mut self, at: Instant) {
        if let Some(taken) = &mut self.taken {
            taken.progress.disturbed(at);
        }
    }

    /// Something may have changed.
    pub(super) fn look(&mut self) {
        if let Some(taken) = &mut self.taken {
            taken.progress.look(&mut self.bus);
        }
    }

    /// Is a lesson taken?
    pub(super) fn has_pupil(&self) -> bool {
        self.taken.is_some()
    }

    /// Number of checkpoints that were reached.
    pub(super) fn reached(&self) -> usize {
        let taken = self.taken.as_ref();
        taken.map_or(0, |taken| taken.progress.reached().len())
    }
}
