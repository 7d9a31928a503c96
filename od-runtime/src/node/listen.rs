//! Selection of the CAN-IDs that the node listens for, by its state and its objects.

use od_wire::nmt::State;

use super::Machines;
use super::ear::{ERROR_CONTROL, Ear, LSS, NMT, NONE, Quick, code};
use crate::device::{Device, ROOMY};
use crate::extras::Extras;
use crate::objects::Objects;

impl<D: Device, const PDO: usize, const SDO: usize, X: Extras<D, SDO>> Machines<D, PDO, SDO, X> {
    /// Selects the CAN-IDs again after a change of the state or of an object.
    #[inline(never)]
    pub(super) fn listen(&mut self, objects: &Objects<'_, D>) {
        self.ear = Ear::DEAF;
        self.quick = Quick::NONE;
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
            ear.sync = self.sync_id.unwrap_or(NONE);
            for pdo in self.tpdos() {
                ear.codes |= pdo.requested_by().map_or(0, code);
            }
            if D::RPDOS {
                for pdo in self.rpdos() {
                    ear.codes |= pdo.received_by().map_or(0, code);
                }
            }
            if D::CHANGES && self.watches_live {
                ear.codes = Ear::EVERYTHING;
            }
        }
        self.ear = ear;
        self.quick.requests = ear.sdo != NONE && ear.codes != Ear::EVERYTHING;
        self.expect_sync();
        if ROOMY {
            self.expect_ticks();
        }
    }
}
