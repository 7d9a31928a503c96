//! Result of a run.

use std::fmt;
use std::prelude::v1::*;

use od_runtime::Instant;

use crate::grammar::shown;

/// A run that reached its end.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct Summary {
    /// Number of expectations that held.
    pub held: usize,
    /// Frames that the devices sent.
    pub frames: u64,
    /// Virtual time at the end.
    pub end: Instant,
}

/// Reason why a run stopped before its end.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct Stop {
    /// The line, counted from 1.
    pub line: u32,
    /// Text of the line.
    pub text: String,
    /// Virtual time.
    pub at: Instant,
    /// Reason.
    pub reason: Reason,
}

/// Reason that stopped a run.
#[derive(Clone, PartialEq, Eq, Debug)]
pub enum Reason {
    /// An expectation did not hold.
    Failed {
        /// Expected frame or value.
        expected: String,
        /// Actual frame or value.
        got: String,
    },
    /// The line cannot be carried out: the device or the fault does not exist, or its time has passed.
    Impossible(String),
}

impl fmt::Display for Stop {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let text = shown::line(&self.text);
        writeln!(f, "line {} at {:?} s: {text}", self.line, self.at)?;
        self.reason.fmt(f)
    }
}

impl core::error::Error for Stop {}

/// The reason in the form that is printed below the line.
impl fmt::Display for Reason {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Failed { expected, got } => {
                let (expected, got) = (shown::brief(expected), shown::brief(got));
                write!(f, "  expected  {expected}\n  but       {got}")
            }
            Self::Impossible(why) => write!(f, "  {}", shown::brief(why)),
        }
    }
}

impl core::error::Error for Reason {}
