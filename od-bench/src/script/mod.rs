//! The language of `odkit run` and of the conformance tests: frames, the world outside the
//! bus, and what is expected, one line after the other, in virtual time.
//!
//! `od-cli/SCRIPTS.md` describes it for those who write scripts.
//!
//! ```
//! use od_bench::script::{run, Bare, Script};
//! # let text = "";
//! let script = Script::parse(text).expect("a script without mistakes");
//! assert!(run(&script, &mut Bare(od_devices::DEVICES)).is_ok());
//! ```

mod client;
mod console;
pub(crate) mod expect;
mod line;
pub(crate) mod parse;
pub(crate) mod parse_expect;
mod pattern;
mod run;
mod statement;
pub mod typed;
pub(crate) mod words;

use std::prelude::v1::*;
use std::{fmt, format};

use od_runtime::{DeviceKind, Frame, Instant, NodeId};

pub use console::Console;
pub use line::{Known, frame_of};
pub use pattern::Pattern;
pub use run::{run, run_on};

use crate::bus::Bus;
use crate::device::VirtualDevice;
use statement::{Action, Statement};

/// A script that was read.
#[derive(Clone, PartialEq, Debug, Default)]
pub struct Script {
    statements: Vec<Statement>,
}

/// Reads a script line by line, each as a script of its own.
#[derive(Clone, Debug, Default)]
pub struct Reader {
    /// Where the time stamps of a log begin.
    origin: Option<u64>,
    /// Lines so far.
    line: u32,
}

/// A line that says nothing the language knows.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct Problem {
    /// Counted from 1.
    pub line: u32,
    /// In characters, counted from 1.
    pub column: usize,
    /// What is wrong.
    pub message: String,
    /// What is allowed.
    pub help: String,
}

impl core::error::Error for Problem {}

impl fmt::Display for Problem {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(
            f,
            "{}:{}: {}; {}",
            self.line, self.column, self.message, self.help
        )
    }
}

impl Script {
    /// Reads a script.
    ///
    /// # Errors
    /// Everything that could not be read, in order.
    pub fn parse(text: &str) -> Result<Self, Vec<Problem>> {
        parse::parse(text, 1)
    }

    /// Reads a script that stands inside another text: its first line has this number there.
    ///
    /// # Errors
    /// As [`parse`](Self::parse).
    pub fn parse_at(text: &str, first_line: u32) -> Result<Self, Vec<Problem>> {
        parse::parse(text, first_line)
    }

    /// The numbers of the lines that say something.
    pub fn lines(&self) -> impl Iterator<Item = u32> + '_ {
        self.statements.iter().map(|statement| statement.line)
    }

    /// How many `expect` lines it has, SDO lines with an outcome included.
    pub fn expectations(&self) -> usize {
        let expects = |statement: &&Statement| {
            matches!(
                statement.action,
                Action::Expect(_) | Action::Read { .. } | Action::Write { .. }
            )
        };
        self.statements.iter().filter(expects).count()
    }
}

/// Who put a frame on the bus.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Origin {
    /// The script.
    Script,
    /// A device, counted from 0 in the order of the `device` lines.
    Device(usize),
}

/// What a script needs of the program that runs it.
pub trait Host {
    /// Makes the device of a `device` line: the name of a built-in one, or of an EDS file.
    /// With no name: the one that scripts without a `device` line run on.
    ///
    /// # Errors
    /// Why there is no such device, and what to do.
    fn device(
        &mut self,
        name: Option<&str>,
        node_id: Option<NodeId>,
    ) -> Result<VirtualDevice, String>;

    /// A frame is on the bus.
    fn frame(&mut self, at: Instant, origin: Origin, frame: &Frame) {
        let _ = (at, origin, frame);
    }

    /// A frame was on the bus, or a line is done: the bench as it is now.
    fn look(&mut self, bus: &mut Bus) {
        let _ = bus;
    }
}

/// A bus, with the names that scripts gave its devices.
#[derive(Default)]
pub struct Bench {
    /// The bus.
    pub bus: Bus,
    labels: Vec<Option<String>>,
    current: usize,
}

impl Bench {
    /// A bus whose devices have no names but their numbers, counted from 1.
    pub fn new(bus: Bus) -> Self {
        let labels = bus.devices().iter().map(|_| None).collect();
        Self {
            bus,
            labels,
            current: 0,
        }
    }

    /// The device that a script calls so.
    pub fn device(&self, name: &str) -> Option<usize> {
        run::named(&self.labels, name)
    }
}

/// A host with these devices and nothing else.
#[derive(Clone, Copy, Debug)]
pub struct Bare(
    /// The devices that have names; the first is the one of scripts that name none.
    pub &'static [DeviceKind],
);

impl Host for Bare {
    fn device(
        &mut self,
        name: Option<&str>,
        node_id: Option<NodeId>,
    ) -> Result<VirtualDevice, String> {
        let kind = match name {
            Some(name) => self
                .0
                .iter()
                .find(|kind| kind.name.eq_ignore_ascii_case(name)),
            None => self.0.first(),
        };
        let name = name.unwrap_or_default();
        match kind {
            Some(kind) => Ok(VirtualDevice::new(kind, node_id.unwrap_or(NodeId::ONE))),
            None => {
                let names: Vec<_> = self.0.iter().map(|kind| kind.name).collect();
                Err(format!(
                    "no device is called `{name}`; there are {}",
                    names.join(", ")
                ))
            }
        }
    }
}

/// A run that came to its end.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct Summary {
    /// Expectations that held.
    pub held: usize,
    /// Frames that the devices sent.
    pub frames: u64,
    /// Virtual time at the end.
    pub end: Instant,
}

/// Why a run stopped before its end.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct Stop {
    /// The line, counted from 1.
    pub line: u32,
    /// What it says.
    pub text: String,
    /// Virtual time.
    pub at: Instant,
    /// Why.
    pub reason: Reason,
}

/// What stopped a run.
#[derive(Clone, PartialEq, Eq, Debug)]
pub enum Reason {
    /// An expectation did not hold.
    Failed {
        /// What was expected.
        expected: String,
        /// What came instead.
        got: String,
    },
    /// The line cannot be carried out: no such device, no such fault, a moment that has passed.
    Impossible(String),
}

impl fmt::Display for Stop {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let text = words::line(&self.text);
        writeln!(f, "line {} at {:?} s: {text}", self.line, self.at)?;
        match &self.reason {
            Reason::Failed { expected, got } => {
                let (expected, got) = (words::brief(expected), words::brief(got));
                write!(f, "  expected  {expected}\n  but       {got}")
            }
            Reason::Impossible(why) => write!(f, "  {}", words::brief(why)),
        }
    }
}

impl core::error::Error for Stop {}
