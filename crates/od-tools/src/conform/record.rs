//! Result of a case.

use od_wire::{Frame, Instant};

/// A frame of a case.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct Traced {
    /// Time by the link's clock.
    pub at: Instant,
    /// Whether the test sent it.
    pub ours: bool,
    /// The frame.
    pub frame: Frame,
}

/// The verdict on a case.
#[derive(Clone, PartialEq, Eq, Debug)]
pub enum Verdict {
    /// The node meets the requirement.
    Pass,
    /// The node violates the requirement.
    Fail {
        /// The expected behaviour.
        expected: String,
        /// The actual behaviour.
        got: String,
    },
    /// The case was not tested: the reason, and the option to add.
    Skipped(String),
    /// The node does not have the tested object or service.
    NotApplicable(String),
}

impl Verdict {
    /// Returns whether the node meets the requirement.
    pub fn is_pass(&self) -> bool {
        *self == Self::Pass
    }

    /// Returns whether the node violates the requirement.
    pub fn is_fail(&self) -> bool {
        matches!(self, Self::Fail { .. })
    }

    /// One word: `pass`, `fail`, `skipped`, `n/a`.
    pub fn word(&self) -> &'static str {
        match self {
            Self::Pass => "pass",
            Self::Fail { .. } => "fail",
            Self::Skipped(_) => "skipped",
            Self::NotApplicable(_) => "n/a",
        }
    }

    /// The reason of the verdict, one clause.
    pub fn reason(&self) -> String {
        match self {
            Self::Pass => String::new(),
            Self::Fail { expected, got } => format!("expected {expected}; {got}"),
            Self::Skipped(why) | Self::NotApplicable(why) => why.clone(),
        }
    }
}

/// A case that was run.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct Record {
    /// The case's id.
    pub id: String,
    /// Its group.
    pub group: String,
    /// Standard and clause.
    pub clause: String,
    /// The requirement.
    pub title: String,
    /// The result.
    pub verdict: Verdict,
    /// Values that were changed and restored, and values that could not be restored.
    pub notes: Vec<String>,
    /// Every frame, in order.
    pub frames: Vec<Traced>,
    /// Number of the frames until the first failure was found; with the others, the case ends and puts values back.
    pub found: usize,
    /// Duration, in microseconds of the link's clock.
    pub micros: u64,
}

/// Response times of the node, in microseconds.
#[derive(Clone, PartialEq, Eq, Debug, Default)]
pub struct Times {
    /// From an SDO request to its response.
    pub answers: Vec<u64>,
    /// From a reset to the boot-up message.
    pub boots: Vec<u64>,
}

/// Percentile by the nearest-rank method.
pub fn percentile(values: &[u64], percent: usize) -> Option<u64> {
    let mut sorted = values.to_vec();
    sorted.sort_unstable();
    let last = sorted.len().checked_sub(1)?;
    sorted.get((last * percent).div_ceil(100)).copied()
}
