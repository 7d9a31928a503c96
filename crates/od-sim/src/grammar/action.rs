//! The content of a line as data.

use std::prelude::v1::*;

use od_runtime::{Instant, NodeId};
use od_wire::AbortCode;

use super::deed::Deed;
use super::fact::Fact;
use super::frames::Frames;
use super::named_frame::Write;
use super::pattern::Pattern;

/// Time of a line.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum When {
    /// After the line before it is done.
    Next,
    /// At this moment.
    At(Instant),
    /// This number of microseconds after the line before it.
    After(u64),
}

/// Action of a line.
#[derive(Clone, PartialEq, Debug)]
pub enum Action {
    /// An action that a live bench supports, too.
    Deed(Deed),
    /// Puts a device on the bus.
    Device(NewDevice),
    /// A whole SDO upload.
    Read {
        /// Address or name.
        object: String,
        /// Expected result.
        outcome: Outcome,
    },
    /// A whole SDO download.
    Write {
        /// Object and value.
        write: Write,
        /// Expected result.
        outcome: Outcome,
    },
    /// Ignores such frames; `None`: no frames are ignored any more.
    Ignore(Option<Pattern>),
    /// Empties the queue of frames.
    Skip,
    /// A condition that must hold.
    Expect(Expect),
    /// One of several lines, with numbers that are drawn.
    Random(Draw),
}

impl Action {
    /// Returns whether the line sends, or changes a device or the bus line. The line that `Random` draws acts, too.
    pub(crate) fn acts(&self) -> bool {
        match self {
            Self::Deed(deed) => !matches!(deed, Deed::Wait | Deed::Use(_)),
            Self::Device(_) | Self::Read { .. } | Self::Write { .. } => true,
            Self::Ignore(_) | Self::Skip | Self::Expect(_) | Self::Random(_) => false,
        }
    }
}

/// The content of a `random` line.
#[derive(Clone, PartialEq, Debug)]
pub struct Draw {
    /// Number of draws among the lines.
    pub(crate) times: u32,
    pub(crate) choices: Vec<Choice>,
}

/// A line that can be drawn.
#[derive(Clone, PartialEq, Debug)]
pub(crate) struct Choice {
    /// The line as written, with its ranges.
    pub(crate) text: String,
    /// The line with the upper end of each range.
    pub(crate) most: (When, Action),
}

/// A device that a line puts on the bus.
#[derive(Clone, PartialEq, Debug, Default)]
pub struct NewDevice {
    /// Name of a built-in device or of a file; `None`: the default device of scripts.
    pub(crate) name: Option<String>,
    /// Node ID of each channel.
    pub(crate) nodes: Vec<NodeId>,
    pub(crate) label: Option<String>,
    /// The device whose shaft it uses.
    pub(crate) beside: Option<String>,
    /// A serial number other than the first.
    pub(crate) serial: Option<u32>,
    /// Space for each string and DOMAIN of a device that a file describes, in bytes.
    pub(crate) domain_size: Option<u32>,
    /// It starts without power.
    pub(crate) off: bool,
}

/// Expected result of an SDO transfer.
#[derive(Clone, PartialEq, Debug)]
pub enum Outcome {
    /// It succeeds.
    Done,
    /// It succeeds with this value.
    Value(String),
    /// It is aborted with this code.
    Aborts(AbortCode),
}

/// Condition of an `expect` line.
#[derive(Clone, PartialEq, Debug)]
pub enum Expect {
    /// A frame comes.
    Frame {
        /// The frames that match.
        frames: Frames,
        /// Their number.
        times: u32,
        /// Their time.
        timing: Timing,
    },
    /// No frame comes for this time in microseconds.
    Silence(u64),
    /// A condition about a device or the bus line holds now, or begins to hold in a time.
    Fact {
        /// The condition.
        fact: Fact,
        /// The longest wait for it, in microseconds.
        within: u64,
    },
}

/// Time of an expected frame.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Timing {
    /// It has already come.
    Now,
    /// Within this time in microseconds.
    Within(u64),
    /// After exactly this time in microseconds.
    After(u64),
    /// Each exactly this time in microseconds after the previous one.
    Every(u64),
}
