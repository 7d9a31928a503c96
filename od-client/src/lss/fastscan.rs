//! Fastscan: the LSS address of a slave, bit by bit (CiA 305, chapter 6.7).

use od_wire::lss::Request;

use super::task::{Answer, Identity, LssError};

/// `bit` of the request that begins a scan.
const BEGIN: u8 = 0x80;

/// Step of a scan.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
enum Step {
    /// Is there a slave at all?
    Begin,
    /// Is this bit 0, and those above it as they were found?
    Bit(u8),
    /// Is the number as it was found? Then slaves go on to the next one.
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

    /// The time of this step is over: did a slave answer? Returns what the scan brought, once
    /// it is at its end.
    pub(super) fn step(&mut self, answered: bool) -> Option<Result<Answer, LssError>> {
        self.step = match self.step {
            Step::Begin if !answered => return Some(Ok(Answer::Found(None))),
            Step::Begin => Step::Bit(31),
            Step::Bit(bit) => {
                if !answered {
                    self.found[usize::from(self.part & 3)] |= 1 << (bit & 31);
                }
                bit.checked_sub(1).map_or(Step::Confirm, Step::Bit)
            }
            Step::Confirm if !answered => return Some(Err(LssError::ScanFailed)),
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
