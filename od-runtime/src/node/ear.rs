//! Filter of the CAN-IDs that a node listens for: most frames on a bus are for others.

use od_wire::CanId;

use crate::deadline::Deadline;
use crate::device::ROOMY;

/// The frames that a node has something to do for.
#[derive(Clone, Copy, Debug)]
pub(super) struct Ear {
    /// Requests of SDO clients.
    pub(super) sdo: CanId,
    /// SYNC.
    pub(super) sync: CanId,
    /// Sets of other frames, by the function codes in bits 7 to 11 of their CAN-IDs. 0: no frame at all.
    pub(super) codes: u32,
}

/// No data frame has it that is not for NMT.
pub(super) const NONE: CanId = CanId::standard(0);

impl Ear {
    /// All zeros: nothing.
    pub(super) const DEAF: Self = Self {
        sdo: NONE,
        sync: NONE,
        codes: 0,
    };

    /// All frames.
    pub(super) const EVERYTHING: u32 = u32::MAX;

    /// Whether the node has something to do for frames with this CAN-ID.
    #[inline(always)]
    pub(super) fn hears(&self, id: CanId) -> bool {
        self.codes & code(id) != 0 || id == self.sdo || id == self.sync
    }
}

/// The function code of a CAN-ID as a bit.
#[inline(always)]
pub(super) const fn code(id: CanId) -> u32 {
    1 << (id.raw() >> 7 & 31)
}

/// Codes of NMT, error control and LSS.
pub(super) const NMT: u32 = 1 << 0;
pub(super) const ERROR_CONTROL: u32 = 1 << 14;
pub(super) const LSS: u32 = 1 << 15;

/// Frames that need no more than a glance.
#[derive(Clone, Copy, Debug)]
pub(super) struct Quick {
    /// Requests of SDO clients: nothing but the request itself is to be looked at.
    pub(super) requests: bool,
    /// SYNC: it is to be counted.
    pub(super) syncs: bool,
    /// SYNC: the TPDOs that each one marks in `pending`, and no more. 0: it does something else.
    pub(super) marks: u8,
    /// A tick of event timers.
    pub(super) ticks: [Ticks; ROOMY as usize],
}

impl Quick {
    /// All frames are to be looked at.
    pub(super) const NONE: Self = Self {
        requests: false,
        syncs: false,
        marks: 0,
        ticks: [Ticks::NONE; ROOMY as usize],
    };
}

/// A tick of event timers that needs no more than that their TPDOs are sent.
#[derive(Clone, Copy, Debug)]
pub(super) struct Ticks {
    /// The TPDOs whose event timers run, in the bits of `pending`. 0: more is to be done.
    pub(super) timed: u8,
    /// The first of all other deadlines, while that of the node is known.
    pub(super) others: Deadline,
}

impl Ticks {
    /// More is to be done.
    const NONE: Self = Self {
        timed: 0,
        others: Deadline::NEVER,
    };
}
