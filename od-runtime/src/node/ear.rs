//! What a node listens for: most frames on a bus are for others.

use od_wire::CanId;
use od_wire::nmt::State;

use super::Machines;
use crate::device::Device;
use crate::extras::Extras;
use crate::objects::Objects;

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
const NONE: CanId = CanId::standard(0);

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
const fn code(id: CanId) -> u32 {
    1 << (id.raw() >> 7 & 31)
}

impl<D: Device, const PDO: usize, const SDO: usize, X: Extras<D, SDO>> Machines<D, PDO, SDO, X> {
    /// What the node listens for follows from its state and its objects, which have changed.
    #[inline(never)]
    pub(super) fn listen(&mut self, objects: &Objects<'_, D>) {
        self.ear = Ear::DEAF;
        if self.state == State::Initialising || self.mute.is_some() {
            if D::LSS && self.is_unconfigured() {
                self.ear.codes = LSS;
            }
            return;
        }
        let mut ear = Ear {
            sdo: NONE,
            sync: NONE,
            codes: NMT,
        };
        if Self::HAS_MONITOR {
            ear.codes |= ERROR_CONTROL;
        }
        if D::LSS && objects.profile().lss.is_some() {
            ear.codes |= LSS;
        }
        if self.state != State::Stopped {
            ear.sdo = self.node_id.plus(0x600);
            for one in self.extras.servers().iter().filter(|_| D::SERVERS) {
                ear.codes |= one.received_by().map_or(0, code);
            }
            ear.codes |= self.time_id().filter(|_| D::TIME).map_or(0, code);
        }
        if self.state == State::Operational {
            ear.sync = self.sync_id;
            for pdo in self.tpdo.iter().take(self.tpdo_count) {
                ear.codes |= pdo.requested_by().map_or(0, code);
            }
            if D::RPDOS {
                for pdo in self.rpdo.iter().take(self.rpdo_count) {
                    ear.codes |= pdo.received_by().map_or(0, code);
                }
            }
            if D::CHANGES && self.watches_live {
                ear.codes = Ear::EVERYTHING;
            }
        }
        self.ear = ear;
    }
}

/// Codes of NMT, error control and LSS.
const NMT: u32 = 1 << 0;
const ERROR_CONTROL: u32 = 1 << 14;
const LSS: u32 = 1 << 15;
