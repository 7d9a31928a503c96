//! Fastscan: finds the LSS address of a slave bit by bit (CiA 305, chapter 6.7).

use od_wire::lss::Request;

use super::task::{Answer, Identity};
use crate::error::Error;

/// Value of `bit` in the first request of a scan.
const BEGIN: u8 = 0x80;

/// Step of a scan.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
enum Step {
    /// Asks whether there is a slave.
    Begin,
    /// Asks whether this bit is 0 and the higher bits are those found.
    Bit(u8),
    /// Asks whether the number is the one found. Then slaves continue with the next number.
    Confirm,
}

/// A scan for one slave.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) struct Fastscan {
    found: [u32; 4],
    /// Index of the number, 0 to 3.
    part: u8,
    step: Step,
}

impl Fastscan {
    pub(super) const fn new() -> Self {
        Self {
            found: [0; 4],
            part: 0,
            step: Step::Begin,
        }
    }

    /// The frame of this step.
    pub(super) fn request(&self) -> Request {
        let number = self.found[usize::from(self.part & 3)];
        let (bit, next) = match self.step {
            Step::Begin => (BEGIN, 0),
            Step::Bit(bit) => (bit, self.part),
            Step::Confirm => (0, (self.part + 1) & 3),
        };
        Request::Fastscan {
            number,
            bit,
            part: self.part,
            next,
        }
    }

    /// Ends a step: `true` if a slave responded. Returns the result of the scan at
    /// its end.
    pub(super) fn step(&mut self, answered: bool) -> Option<Result<Answer, Error>> {
        self.step = match self.step {
            Step::Begin if !answered => return Some(Ok(Answer::Found(None))),
            Step::Begin => Step::Bit(31),
            Step::Bit(bit) => {
                if !answered {
                    self.found[usize::from(self.part & 3)] |= 1 << (bit & 31);
                }
                bit.checked_sub(1).map_or(Step::Confirm, Step::Bit)
            }
            Step::Confirm if !answered => return Some(Err(Error::ScanFailed)),
            Step::Confirm if self.part == 3 => {
                return Some(Ok(Answer::Found(Some(Identity::new(self.found)))));
            }
            Step::Confirm => {
                self.part += 1;
                Step::Bit(31)
            }
        };
        None
    }
}
