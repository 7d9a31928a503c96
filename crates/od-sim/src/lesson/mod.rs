//! Lessons: tasks on a bench, step by step. The bench itself detects that a step is done.
//!
//! A lesson is a Markdown text (`crates/od-cli/LESSONS.md` describes it for authors). The checkpoint of a step
//! lists the frames, values and device states that must be seen; how the learner
//! gets there does not matter.
//!
//! ```
//! use od_sim::lesson::{pass, Lesson, Progress};
//! use od_sim::script::Bare;
//! # let text = include_str!("../../../../playground/lessons/01-boot-up-and-heartbeat.md");
//! let lesson = Lesson::parse(text).expect("a lesson without mistakes");
//! let mut bench = lesson.set_up(&mut Bare(od_devices::DEVICES)).expect("its devices are built in");
//! let mut progress = Progress::new(lesson, &mut bench);
//! bench.bus.set_power(0, true);
//! progress.note_act();
//! pass(&mut bench.bus, &mut progress, 1_000_000);
//! assert_eq!(progress.poll(), Some(0), "the first step is done");
//! ```

mod checkpoint;
mod condition;
mod content;
mod front;
mod links;
mod parse;
mod progress;
mod proof;
mod quiz;
#[cfg(feature = "real")]
mod real;
#[cfg(test)]
mod tests;
mod translation;
mod watch;

pub use crate::grammar::problem::Problem;
pub use content::{Block, Lesson, Step};
pub use progress::{Progress, Requirement};
pub use proof::prove;
pub use quiz::{Judgement, Quiz, judge};
pub use translation::{is_translation, translate};
pub use watch::{Watched, pass};
