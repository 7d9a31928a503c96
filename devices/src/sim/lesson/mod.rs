//! Lessons: a text in Markdown, a bench to begin with, and checkpoints that look at what
//! went over the bus, at the dictionary and at the devices, not at what was clicked.
//!
//! `lessons/README.md` describes the text for those who write lessons. The same lesson runs
//! in the page and, with the solutions that it carries, on a command line.
//!
//! ```
//! use od_devices::sim::lesson::{Lesson, solve};
//! use od_devices::sim::script::Bare;
//!
//! let text = "---\ntitle: First light\n---\n```start\ndevice gxmm node 1 off\n```\n\
//!             ## Give it power\n```check\nseen 701#00\n```\n```solution\npower on\n```\n";
//! let lesson = Lesson::parse(text).expect("a lesson without mistakes");
//! assert!(solve(&lesson, &mut Bare).is_ok());
//! ```

mod check;
mod markdown;
mod progress;
mod solve;

use std::prelude::v1::*;

pub use check::Check;
pub use progress::{Line, Progress};
pub use solve::{Stuck, begin, solve};

pub use super::script::Problem;

/// A lesson that was read.
#[derive(Clone, PartialEq, Debug, Default)]
pub struct Lesson {
    /// What it is called.
    pub title: String,
    /// What it is about, in a sentence.
    pub summary: String,
    /// How long it takes, in minutes; 0 if it does not say.
    pub minutes: u32,
    /// What is said before the first step, in Markdown.
    pub intro: String,
    /// The script that sets up the bench.
    pub start: String,
    /// What is to be done, one after the other.
    pub steps: Vec<Step>,
}

/// One step of a lesson.
#[derive(Clone, PartialEq, Debug, Default)]
pub struct Step {
    /// What it is called.
    pub title: String,
    /// The task, in Markdown.
    pub text: String,
    /// What helps, from a nudge to the answer.
    pub hints: Vec<String>,
    /// What is told when it is done.
    pub happened: String,
    /// What has to hold, all of it.
    pub checks: Vec<Check>,
    /// A script that does it; empty where the author keeps it to himself.
    pub solution: String,
}

impl Lesson {
    /// Reads a lesson.
    ///
    /// # Errors
    /// Everything that could not be read, in order.
    pub fn parse(text: &str) -> Result<Self, Vec<Problem>> {
        markdown::parse(text)
    }
}
