//! Lessons without a person: set up, solved, or tried with somebody's script.

use std::format;
use std::prelude::v1::*;

use od_runtime::{Frame, Instant, NodeId};

use super::{Lesson, Line, Progress};
use crate::sim::VirtualDevice;
use crate::sim::script::{Bench, Host, Origin, Script, run_on};

/// Why a lesson did not go to its end.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct Stuck {
    /// Number of the step, from 0; `None` for the set-up.
    pub step: Option<usize>,
    /// What happened.
    pub why: String,
    /// The lines of the step, with what is missing.
    pub lines: Vec<Line>,
}

/// A host that hands every frame to the lesson, too.
struct Watching<'w> {
    host: &'w mut dyn Host,
    frames: Vec<(Instant, bool, Frame)>,
}

impl Host for Watching<'_> {
    fn device(
        &mut self,
        name: Option<&str>,
        node: Option<NodeId>,
    ) -> Result<VirtualDevice, String> {
        self.host.device(name, node)
    }

    fn frame(&mut self, at: Instant, origin: Origin, frame: &Frame) {
        self.frames
            .push((at, matches!(origin, Origin::Device(_)), *frame));
        self.host.frame(at, origin, frame);
    }
}

/// Sets up the bench of a lesson: on a real wire, by its `start` script.
///
/// # Errors
/// Which line of the script could not be carried out.
pub fn begin(lesson: &Lesson, host: &mut dyn Host) -> Result<Bench, Stuck> {
    let mut bench = Bench::default();
    bench.bus.line.is_real = true;
    play(&lesson.start, host, &mut bench).map_err(|why| Stuck {
        step: None,
        why,
        lines: Vec::new(),
    })?;
    while bench.bus.line.poll().is_some() {}
    Ok(bench)
}

/// Does every step by its own solution, and proves on the way that no step is done before
/// its solution began.
///
/// # Errors
/// The first step that is stuck, or done too early.
pub fn solve(lesson: &Lesson, host: &mut dyn Host) -> Result<(), Stuck> {
    let mut bench = begin(lesson, host)?;
    let mut progress = Progress::new(lesson, &bench.bus);
    for (number, step) in lesson.steps.iter().enumerate() {
        let stuck = |why: String, lines| Stuck {
            step: Some(number),
            why,
            lines,
        };
        if progress.look(&mut bench.bus) {
            return Err(stuck(
                "it is done before anybody did anything".into(),
                Vec::new(),
            ));
        }
        if step.solution.trim().is_empty() {
            return Err(stuck("it has no solution".into(), Vec::new()));
        }
        let mut watching = Watching {
            host: &mut *host,
            frames: Vec::new(),
        };
        play(&step.solution, &mut watching, &mut bench).map_err(|why| stuck(why, Vec::new()))?;
        for (at, from_device, frame) in watching.frames {
            progress.frame(at, from_device, &frame);
        }
        while let Some(one) = bench.bus.line.poll() {
            progress.disturbed(one.at);
        }
        if !progress.look(&mut bench.bus) {
            let lines = progress.lines(&mut bench.bus);
            return Err(stuck("its solution does not do it".into(), lines));
        }
    }
    Ok(())
}

fn play(text: &str, host: &mut dyn Host, bench: &mut Bench) -> Result<(), String> {
    let script = Script::parse(text).map_err(|problems| {
        let all: Vec<_> = problems
            .iter()
            .map(|problem| format!("{problem}"))
            .collect();
        all.join("\n")
    })?;
    match run_on(&script, host, bench) {
        Ok(_) => Ok(()),
        Err(stop) => Err(format!("{stop}")),
    }
}
