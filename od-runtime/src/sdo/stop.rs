//! Why a request has no response yet, or none but an abort.

use od_wire::AbortCode;

use crate::application::Halt;
use crate::deadline::Deadline;

/// A [`Halt`] without its moment, which the server has: this one fits into a register.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) enum Stop {
    Abort(AbortCode),
    /// Until the server's deadline.
    Wait,
}

impl From<AbortCode> for Stop {
    fn from(code: AbortCode) -> Self {
        Self::Abort(code)
    }
}

impl Stop {
    /// Of what a stream said; its moment becomes the deadline.
    pub(super) fn new(halt: Halt, deadline: &mut Deadline) -> Self {
        match halt {
            Halt::Abort(code) => Self::Abort(code),
            Halt::Until(at) => {
                *deadline = Deadline::at(at);
                Self::Wait
            }
        }
    }
}
