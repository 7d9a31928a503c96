//! What a checkpoint asks for.

use std::prelude::v1::*;

use od_model::Address;
use od_runtime::AbortCode;
use od_wire::nmt::Command;

use crate::leds::Led;
use crate::script::Pattern;

/// One line of a checkpoint: one of its alternatives has to hold.
#[derive(Clone, PartialEq, Debug)]
pub(super) struct Line {
    /// In the lesson.
    pub(super) line: u32,
    /// What it asks for has to come after what the line before asks for.
    pub(super) then: bool,
    pub(super) alternatives: Vec<Alternative>,
    /// What to say of it, instead of what the line itself says.
    pub(super) say: Option<String>,
}

impl Line {
    /// Does it wait for a frame, whichever alternative comes?
    pub(super) fn waits(&self) -> bool {
        let seen = |one: &Alternative| !one.not && matches!(one.what, What::Seen(_));
        self.alternatives.iter().all(seen)
    }
}

#[derive(Clone, PartialEq, Debug)]
pub(super) struct Alternative {
    pub(super) not: bool,
    pub(super) what: What,
}

#[derive(Clone, PartialEq, Debug)]
pub(super) enum What {
    /// Something came over the bus since the step began.
    Seen(Seen),
    /// Something is so now.
    Fact(Fact),
}

/// Who put a frame on the bus.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) enum Who {
    Learner,
    Device,
    Anybody,
}

/// Frames that have to be seen.
#[derive(Clone, PartialEq, Debug)]
pub(super) struct Seen {
    pub(super) who: Who,
    pub(super) what: Frames,
    /// Number or label of the device that sends it; `None`: any.
    pub(super) device: Option<String>,
    pub(super) times: u32,
    /// Microseconds from one to the next, at least and at most.
    pub(super) every: Option<(u64, u64)>,
    /// Microseconds after what the line before asks for, at most.
    pub(super) within: Option<u64>,
}

#[derive(Clone, PartialEq, Debug)]
pub(super) enum Frames {
    Pattern(Pattern),
    Nmt(Command, Option<u8>),
    BootUp,
    Emcy(Option<u16>),
    Abort(Option<AbortCode>),
    /// An SDO upload of the object was answered.
    Read(Address),
    /// An SDO download of the object was taken.
    Written(Address),
}

/// What is so at one moment.
#[derive(Clone, PartialEq, Debug)]
pub(super) struct Fact {
    pub(super) kind: Kind,
    /// Number or label of the device; `None`: the first.
    pub(super) device: Option<String>,
    /// For so many microseconds without a break.
    pub(super) lasting: u64,
}

#[derive(Clone, PartialEq, Debug)]
pub(super) enum Kind {
    /// The value now.
    Value(Address, Test),
    /// The value after the next start; `None`: the one it has now.
    Saved(Address, Option<Test>),
    /// `operational`, … or `off`.
    State(&'static str),
    Led {
        green: bool,
        led: Led,
    },
    NodeId(Test),
    /// In kbit/s.
    BitRate(Test),
    /// Revolutions since the step began, without their sign.
    Turned(Test),
    /// Revolutions a minute.
    Rpm(Test),
    Broken(String),
    /// No such frame comes.
    Quiet(Pattern),
    /// No frame is disturbed on the wire.
    Undisturbed,
    /// Resistors at the ends of the wire.
    Terminators(Test),
}

/// How a value is compared.
#[derive(Clone, PartialEq, Eq, Debug)]
pub(super) struct Test {
    pub(super) how: How,
    /// As the lesson writes it.
    pub(super) text: String,
}

#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) enum How {
    Equal,
    Unequal,
    Below,
    AtMost,
    Above,
    AtLeast,
    /// `low..high`, both included.
    Between,
}

impl How {
    pub(super) const ALL: [(&'static str, Self); 7] = [
        ("=", Self::Equal),
        ("!=", Self::Unequal),
        ("<", Self::Below),
        ("<=", Self::AtMost),
        (">", Self::Above),
        (">=", Self::AtLeast),
        ("in", Self::Between),
    ];
}
