//! The meaning of a line, as data.

use std::prelude::v1::*;

use od_runtime::{Instant, NodeId};
use od_wire::AbortCode;

use super::deed::Deed;
use super::fact::Fact;
use super::frames::Frames;
use super::pattern::Pattern;
use super::typed::Write;

/// Time when a line acts.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum When {
    /// Time when the line before it is done.
    Next,
    /// At a moment.
    At(Instant),
    /// This number of microseconds after the line before it.
    After(u64),
}

/// Action of a line.
#[derive(Clone, PartialEq, Debug)]
pub enum Action {
    /// Action that a live bench supports too.
    Deed(Deed),
    /// Puts a device on the bus.
    Device(Added),
    /// A whole SDO upload.
    Read {
        /// Address or name.
        object: String,
        /// Expected end.
        outcome: Outcome,
    },
    /// A whole SDO download.
    Write {
        /// Object and value.
        write: Write,
        /// Expected end.
        outcome: Outcome,
    },
    /// Such frames do not matter; `None`: all frames matter again.
    Ignore(Option<Pattern>),
    /// Empties the queue of frames.
    Skip,
    /// Something has to hold.
    Expect(Expect),
}

/// A device that a line puts on the bus.
#[derive(Clone, PartialEq, Debug, Default)]
pub struct Added {
    /// Of a built-in device or a file; `None`: the one of scripts that name none.
    pub(crate) name: Option<String>,
    /// Of each channel.
    pub(crate) nodes: Vec<NodeId>,
    pub(crate) label: Option<String>,
    /// The device on whose shaft it sits.
    pub(crate) beside: Option<String>,
    /// Another serial number than the first.
    pub(crate) serial: Option<u32>,
    /// Bytes for each string and DOMAIN of a file's device.
    pub(crate) domain_size: Option<u32>,
    /// Without power.
    pub(crate) off: bool,
}

/// Expected end of an SDO transfer.
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
        /// The frames that are right.
        frames: Frames,
        /// How often.
        times: u32,
        /// When.
        timing: Timing,
    },
    /// No frame comes for this time in microseconds.
    Silence(u64),
    /// A condition about a device or the bus line holds.
    Fact(Fact),
}

/// Time when an expected frame has to come.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Timing {
    /// It is there already.
    Now,
    /// Within this time in microseconds.
    Within(u64),
    /// After exactly this time in microseconds.
    After(u64),
    /// Each exactly this time in microseconds after the one before.
    Every(u64),
}
