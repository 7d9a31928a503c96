//! Lessons and scripts on a rig.

use std::prelude::v1::*;

use od_model::Refused;
use od_wire::Instant;

use super::{LessonRun, LineEvent, Rig};
use crate::bench::Bench;
use crate::bus::Bus;
use crate::grammar::problem::Problem;
use crate::lesson::{Lesson, Progress, Watched};
use crate::rig::clockwork::Clockwork;
use crate::script::{Host, Origin, Recorder, Script, run_on};

impl Rig {
    /// Starts a lesson: its set-up replaces everything on the bus, and time continues.
    ///
    /// # Errors
    /// The problems of the text or of its set-up.
    pub fn start_lesson(
        &mut self,
        text: &str,
        host: &mut dyn Host,
    ) -> Result<Lesson, Vec<Problem>> {
        let lesson = Lesson::parse(text)?;
        let mut bus = Bus::new();
        bus.advance(self.bus.now());
        #[cfg(feature = "real")]
        let set_up = if self.has_link() {
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
        self.outcomes.extend(self.client.give_up());
        self.lesson = Some(LessonRun { progress, names });
        Ok(lesson)
    }

    /// Ends the lesson; the devices stay on the bus.
    pub fn end_lesson(&mut self) {
        self.lesson = None;
    }

    /// The lesson in progress, and its bus.
    pub fn lesson(&mut self) -> Option<(&mut Progress, &mut Bus)> {
        self.check_lesson();
        let run = self.lesson.as_mut()?;
        Some((&mut run.progress, &mut self.bus))
    }

    /// Runs lines of a script, such as the solution of a step; time passes as the lines say.
    /// They apply to the first device until `use` names another one.
    ///
    /// # Errors
    /// The line that cannot be read or that fails; the effects of earlier lines stay.
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
            seen.push(LineEvent::Frame { at, device, frame });
        };
        let mut recorder = Recorder { host, record };
        let (result, bus) = match &mut self.lesson {
            Some(run) => {
                run.names.bus = bus;
                let mut watched = Watched {
                    host: &mut recorder,
                    progress: &mut run.progress,
                };
                let result = run_on(&script, &mut run.names, &mut watched);
                (result, std::mem::take(&mut run.names.bus))
            }
            None => {
                let mut bench = Bench::new(bus);
                let result = run_on(&script, &mut bench, &mut recorder);
                (result, bench.bus)
            }
        };
        self.bus = bus;
        self.collect_frames();
        result.map(|_| ()).map_err(|stop| stop.to_string().into())
    }

    /// Tells the lesson that the learner acts. A step of a lesson is done only after an act in it.
    pub fn note_act(&mut self) {
        if let Some(run) = &mut self.lesson {
            run.progress.note_act();
        }
    }

    /// Passes a transmitted frame to the lesson. A frame from a link counts as that of a device.
    pub(super) fn show_lesson(&mut self, seen: &LineEvent) {
        let (at, origin, frame) = match *seen {
            LineEvent::Frame { at, device, frame } => {
                (at, device.map_or(Origin::Script, Origin::Device), frame)
            }
            LineEvent::Heard { at, device, frame } => {
                (at, Origin::Device(device.unwrap_or(usize::MAX)), frame)
            }
            LineEvent::Disturbed(..) => return,
        };
        if let Some(run) = &mut self.lesson {
            run.progress.frame(at, origin, &frame);
            run.progress.look(&mut self.bus);
        }
    }

    /// Passes a disturbed frame to the lesson.
    pub(super) fn show_lesson_disturbance(&mut self, at: Instant) {
        if let Some(run) = &mut self.lesson {
            run.progress.disturbed(at);
        }
    }

    /// Lets the lesson check its conditions again.
    pub(super) fn check_lesson(&mut self) {
        if let Some(run) = &mut self.lesson {
            run.progress.look(&mut self.bus);
        }
    }

    /// Returns whether a lesson is in progress.
    pub(super) fn has_lesson(&self) -> bool {
        self.lesson.is_some()
    }

    /// Number of reached checkpoints.
    pub(super) fn reached(&self) -> usize {
        let run = self.lesson.as_ref();
        run.map_or(0, |run| run.progress.reached().len())
    }
}
