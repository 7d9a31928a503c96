//! The content of a lesson: its texts, its steps, and its bench.

use std::prelude::v1::*;

use od_model::Refused;
use od_runtime::NodeId;

use super::condition::Line;
use super::quiz::Quiz;
use crate::bus::UNTIL_QUIET;
use crate::device::VirtualDevice;
use crate::grammar::problem::Problem;
use crate::script::{Bench, Host, Script, Stop, run_on};

/// Names of the blocks that are not part of the text; a device has a block `eds NAME`.
pub(super) const BLOCKS: [&str; 5] = ["set-up", "checkpoint", "solution", "answer", "facts"];

/// The content of a lesson.
#[derive(Clone, PartialEq, Debug, Default)]
pub struct Lesson {
    /// Title.
    pub title: String,
    /// Summary in one sentence; may be empty.
    pub summary: String,
    /// Language of its text; `en` if it names none.
    pub language: String,
    /// Built-in devices that can take the place of the first device of the set-up.
    pub also: Vec<String>,
    /// Level: 1 for beginners, 2, 3.
    pub level: u8,
    /// Approximate duration in minutes.
    pub minutes: u16,
    /// Objects that its text may name though no device of it has them, such as `2FFFh`.
    pub absent: Vec<od_model::Address>,
    /// Text before the first step, as Markdown.
    pub intro: String,
    /// Devices of the lesson: the name in the set-up, and the EDS text.
    pub eds: Vec<(String, String)>,
    /// The script that sets up the bench.
    pub set_up: Block,
    /// Steps, in order.
    pub steps: Vec<Step>,
    /// Targets of links, each with its line number.
    pub(super) links: Vec<(u32, String)>,
    /// Objects in its text, each with its line number.
    pub(super) objects: Vec<(u32, od_model::Address)>,
}

/// Lines of a script, with their position in the lesson.
#[derive(Clone, PartialEq, Eq, Debug, Default)]
pub struct Block {
    /// Number of the first line in the lesson, counted from 1; 0 if the block is missing.
    pub line: u32,
    /// The lines.
    pub text: String,
}

/// One step of a lesson.
#[derive(Clone, PartialEq, Debug, Default)]
pub struct Step {
    /// Line number of its heading.
    pub line: u32,
    /// Title.
    pub title: String,
    /// Task and reason, as Markdown.
    pub text: String,
    /// Hints, each more detailed than the previous one, as Markdown.
    pub hints: Vec<String>,
    /// Explanation for the end of the step, as Markdown.
    pub happened: String,
    /// A question about the bytes of a later frame.
    pub quiz: Option<Quiz>,
    /// The lines that solve it.
    pub solution: Block,
    /// Scripts that show the facts in its texts, each on a copy of the bench as it is when the step is done.
    pub facts: Vec<Block>,
    /// Conditions; all must hold.
    pub(super) checkpoint: Vec<Line>,
}

impl Lesson {
    /// Makes the bench: runs the set-up.
    ///
    /// # Errors
    /// The first line that cannot be carried out, with the reason.
    pub fn set_up(&self, host: &mut dyn Host) -> Result<Bench, Problem> {
        self.set_up_on(Bench::default(), host)
    }

    /// Like [`set_up`](Self::set_up), on a bench whose time has begun already.
    ///
    /// # Errors
    /// Like [`set_up`](Self::set_up).
    pub(crate) fn set_up_on(
        &self,
        mut bench: Bench,
        host: &mut dyn Host,
    ) -> Result<Bench, Problem> {
        // Lessons use a real line unless they choose otherwise.
        bench.bus.line.set_real(true);
        let script = self.set_up.script().map_err(|mut all| all.remove(0))?;
        let mut own = OwnDevices { lesson: self, host };
        run_on(&script, &mut bench, &mut own).map_err(|stop| stopped(&stop))?;
        let until = bench.bus.now().plus_micros(UNTIL_QUIET);
        bench.bus.advance_until_quiet(until);
        while bench.bus.poll().is_some() {}
        while bench.bus.line.poll().is_some() {}
        Ok(bench)
    }
}

impl Lesson {
    /// The lesson with another built-in device in the place of the first one of its set-up.
    pub(crate) fn with_device(&self, name: &str) -> Self {
        let mut lesson = self.clone();
        let mut is_first = true;
        let lines = self.set_up.text.lines().map(|line| {
            let rest = line.strip_prefix("device ").filter(|_| is_first);
            let Some(rest) = rest else {
                return String::from(line);
            };
            is_first = false;
            let (_, rest) = rest.split_once(' ').unwrap_or((rest, ""));
            std::format!("device {name} {rest}")
        });
        lesson.set_up.text = lines.collect::<Vec<_>>().join("\n");
        lesson
    }
}

/// A host that makes the devices of a lesson's EDS texts; another host makes the others.
struct OwnDevices<'a> {
    lesson: &'a Lesson,
    host: &'a mut dyn Host,
}

impl Host for OwnDevices<'_> {
    fn inner(&mut self) -> Option<&mut dyn Host> {
        Some(self.host)
    }

    fn device(
        &mut self,
        name: Option<&str>,
        node_id: Option<NodeId>,
    ) -> Result<VirtualDevice, Refused> {
        let own = |(known, _): &&(String, String)| name == Some(known.as_str());
        match self.lesson.eds.iter().find(own) {
            Some((name, text)) => of_eds(name, text, node_id),
            None => self.host.device(name, node_id),
        }
    }
}

#[cfg(feature = "eds")]
fn of_eds(name: &str, text: &str, node_id: Option<NodeId>) -> Result<VirtualDevice, Refused> {
    let options = crate::device::loaded::EdsOptions {
        node_id,
        lenient: false,
    };
    VirtualDevice::from_eds(text, options).map_err(|findings| {
        let count = findings
            .iter()
            .filter(|finding| finding.is_unsound())
            .count();
        let help = "save it as a file and check it with `odkit check`";
        std::format!("the EDS of `{name}` has errors ({count}); {help}").into()
    })
}

#[cfg(not(feature = "eds"))]
fn of_eds(name: &str, _: &str, _: Option<NodeId>) -> Result<VirtualDevice, Refused> {
    Err(std::format!("`{name}` needs EDS texts, which are not supported").into())
}

impl Block {
    /// Its lines as a script with the line numbers of the lesson.
    ///
    /// # Errors
    /// The problems of its lines.
    pub fn script(&self) -> Result<Script, Vec<Problem>> {
        Script::parse_at(&self.text, self.line)
    }
}

/// The reason why a block stopped, as a problem of the lesson.
pub(super) fn stopped(stop: &Stop) -> Problem {
    let why = std::format!("{stop}");
    // The first line names the place, which the problem contains already.
    let why: Vec<_> = why.lines().skip(1).map(str::trim).collect();
    let message = std::format!("`{}` fails: {}", stop.text, why.join(" "));
    let help = "run the block with `odkit run` to see its frames";
    Problem::new(stop.line, message, help)
}
