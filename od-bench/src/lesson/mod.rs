//! Lessons: what to do on a bench, step by step, and how the bench itself tells that it was done.
//!
//! A lesson is a Markdown text (`od-cli/LESSONS.md` describes it for those who write some). A
//! step's checkpoint says what has to be seen on the bus, in the dictionary and of the device;
//! which way a learner takes to it does not matter.
//!
//! ```
//! use od_bench::lesson::{pass, Lesson, Progress};
//! use od_bench::script::Bare;
//! # let text = include_str!("../../../playground/lessons/01-boot-up-and-heartbeat.md");
//! let lesson = Lesson::parse(text).expect("a lesson without mistakes");
//! let mut bench = lesson.set_up(&mut Bare(od_devices::DEVICES)).expect("its devices are built in");
//! let mut progress = Progress::new(lesson, &mut bench);
//! bench.bus.set_power(0, true);
//! pass(&mut bench.bus, &mut progress, 1_000_000);
//! assert_eq!(progress.poll(), Some(0), "the first step is done");
//! ```

mod checkpoint;
mod condition;
mod front;
mod links;
mod parse;
mod progress;
mod proof;
mod quiz;
#[cfg(test)]
mod tests;
mod watch;

use std::prelude::v1::*;

pub use crate::grammar::problem::Problem;
pub use progress::{Progress, Requirement};
pub use proof::prove;
pub use quiz::{Judgement, Quiz, judge};
pub use watch::{Watched, pass};

use crate::script::{Bench, Host, Script, Stop, run_on};
use condition::Line;

/// A lesson that was read.
#[derive(Clone, PartialEq, Debug, Default)]
pub struct Lesson {
    /// What it is called.
    pub title: String,
    /// What it is about, in a sentence; may be empty.
    pub summary: String,
    /// Language of its text, `en` if it says nothing.
    pub language: String,
    /// 1 for beginners, 2, 3.
    pub level: u8,
    /// How long it takes, about.
    pub minutes: u16,
    /// Objects that its text names though no device of it has them, as `2FFFh`.
    pub absent: Vec<od_model::Address>,
    /// What stands before the first step, as Markdown.
    pub intro: String,
    /// The script that makes the bench.
    pub set_up: Block,
    /// What there is to do, in order.
    pub steps: Vec<Step>,
    /// Where links lead, each with its line.
    links: Vec<(u32, String)>,
    /// Objects that its text names, each with its line.
    objects: Vec<(u32, od_model::Address)>,
}

/// Lines of a script, with their place in the lesson.
#[derive(Clone, PartialEq, Eq, Debug, Default)]
pub struct Block {
    /// Number of the first line in the lesson, counted from 1; 0 where there is no such block.
    pub line: u32,
    /// The lines.
    pub text: String,
}

/// One step of a lesson.
#[derive(Clone, PartialEq, Debug, Default)]
pub struct Step {
    /// Line of its heading.
    pub line: u32,
    /// What it is called.
    pub title: String,
    /// What there is to do and why, as Markdown.
    pub text: String,
    /// Each tells a bit more than the one before, as Markdown.
    pub hints: Vec<String>,
    /// What just happened, once it is done, as Markdown.
    pub happened: String,
    /// A question about bytes that are still to come.
    pub quiz: Option<Quiz>,
    /// The lines that do it.
    pub solution: Block,
    /// What has to hold, all of it.
    checkpoint: Vec<Line>,
}

impl Lesson {
    /// Reads a lesson.
    ///
    /// # Errors
    /// Everything that could not be read, in order of its lines.
    pub fn parse(text: &str) -> Result<Self, Vec<Problem>> {
        parse::parse(text)
    }

    /// Makes the bench: runs the set-up.
    ///
    /// # Errors
    /// Which line of the lesson cannot be carried out, and why.
    pub fn set_up(&self, host: &mut dyn Host) -> Result<Bench, Problem> {
        self.set_up_on(Bench::default(), host)
    }

    /// As [`set_up`](Self::set_up), with a bench whose time has begun already.
    ///
    /// # Errors
    /// As there.
    pub fn set_up_on(&self, mut bench: Bench, host: &mut dyn Host) -> Result<Bench, Problem> {
        // Lessons are about a real wire, unless they say otherwise.
        bench.bus.line.is_real = true;
        let script = self.set_up.script().map_err(|mut all| all.remove(0))?;
        run_on(&script, &mut bench, host).map_err(|stop| stopped(&stop))?;
        while bench.bus.poll().is_some() {}
        while bench.bus.line.poll().is_some() {}
        Ok(bench)
    }
}

impl Block {
    /// Its lines as a script that counts lines as the lesson does.
    ///
    /// # Errors
    /// What is wrong with them.
    pub fn script(&self) -> Result<Script, Vec<Problem>> {
        Script::parse_at(&self.text, self.line)
    }
}

/// Why a block stopped, as a problem of the lesson.
fn stopped(stop: &Stop) -> Problem {
    let why = std::format!("{stop}");
    // The first line of it says where, and that stands in the problem.
    let why: Vec<_> = why.lines().skip(1).map(str::trim).collect();
    Problem {
        line: stop.line,
        column: 1,
        message: std::format!("`{}` does not work: {}", stop.text, why.join(" ")),
        help: "play the block with `odkit run` to see what comes".into(),
    }
}
