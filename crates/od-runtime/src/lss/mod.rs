//! LSS slave (CiA 305): sets node ID and bit rate without knowing either.

mod identify;

use crate::blank::Blank;
use crate::objects::Objects;
use crate::profile::LssProfile;
use crate::services::Services;
use crate::storage::StorageError;
use crate::storage::image::{self, Banks, Medium, Plan};
use od_wire::lss::{Request, Response};

/// The node ID of a slave that is not configured (CiA 305, chapter 6.4.2).
pub(crate) const UNCONFIGURED: u8 = 0xFF;

/// Error codes of 11h, 13h and 17h.
mod error {
    pub(super) const NONE: u8 = 0;
    pub(super) const OUT_OF_RANGE: u8 = 1;
    pub(super) const NOT_SUPPORTED: u8 = 1;
    pub(super) const ACCESS: u8 = 2;
}

/// Action of the node after a request, besides the response.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(crate) enum Action {
    /// Only the response, if there is one.
    Answer(Option<Response>),
    /// Silence for `delay_ms` milliseconds, then the bit rate of this index of 2100h, then silence
    /// again if the family has a second delay.
    Activate {
        /// Switch delay, in ms.
        delay_ms: u16,
        /// The new bit rate, as a code of the device's own object.
        bit_rate: u8,
    },
}

/// The slave.
#[derive(Clone, Copy, Debug)]
pub struct Slave {
    configuration: bool,
    selective: identify::Sequence,
    remote: identify::Sequence,
    fastscan: identify::Fastscan,
    /// Node ID set by 11h and not stored yet.
    pub(crate) node_id: Option<u8>,
    /// Bit rate set by 13h and not stored yet, as a value of 2100h.
    bit_rate: Option<u8>,
}

impl Blank for Slave {
    const BLANK: Self = Self {
        configuration: false,
        selective: identify::Sequence::new(),
        remote: identify::Sequence::new(),
        fastscan: identify::Fastscan::new(),
        node_id: None,
        bit_rate: None,
    };
}

impl Slave {
    /// Returns to the waiting state. A device with LSS only in Stopped does so when it leaves
    /// Stopped. A configuration that was not stored stays pending until a reset.
    pub(crate) fn leave(&mut self) {
        let (node_id, bit_rate) = (self.node_id, self.bit_rate);
        *self = Self {
            node_id,
            bit_rate,
            ..Self::BLANK
        };
    }

    /// Returns whether a slave that is not configured can start: 11h gave it a node ID, and it is
    /// in the waiting state again (CiA 305, chapter 6.3.2).
    pub(crate) fn is_ready(&self) -> bool {
        !self.configuration && self.node_id.is_some_and(|id| id != UNCONFIGURED)
    }

    /// Handles a frame of the master (CiA 305, chapters 6.3.2, 6.3.3, 6.4.2 to 6.4.5, 6.5.2, 6.5.3, 6.6.2, 6.6.4
    /// and 6.7). `active` is the active node ID; [`UNCONFIGURED`]: none.
    pub(crate) fn handle<D: Services>(
        &mut self,
        objects: &mut Objects<'_, D>,
        profile: &LssProfile,
        active: u8,
        data: &[u8],
    ) -> Action {
        let Some(request) = Request::parse(data) else {
            return Action::Answer(None);
        };
        let answer = match request {
            Request::SwitchGlobal { configuration } => {
                self.configuration = configuration;
                None
            }
            Request::SwitchSelective { part, value } => {
                let matches = number(objects, part as u8) == value;
                let complete = self.selective.step(part as u8, 3, matches);
                self.configuration |= complete;
                complete.then_some(Response::Selected {
                    state: profile.shows_state.into(),
                })
            }
            Request::IdentifyRemote { step, value } if profile.identify_remote => {
                let own = number(objects, identify::part(step));
                let matches = identify::in_range(step, value, own);
                let complete = self.remote.step(step, 5, matches);
                complete.then_some(Response::Identified)
            }
            Request::IdentifyNonConfigured if profile.non_configured => {
                let node_id = if profile.is_own() {
                    Some(active)
                } else {
                    self.node_id
                };
                (node_id == Some(UNCONFIGURED)).then_some(Response::NonConfigured)
            }
            Request::Fastscan {
                number: value,
                bit,
                part,
                next,
            } if profile.fastscan && (active == UNCONFIGURED || !profile.is_own()) => {
                // Fastscan has found the node that is being configured (CiA 305, chapter 6.7), so
                // it does not respond.
                if self.configuration {
                    return Action::Answer(None);
                }
                let own = number(objects, part);
                let seen = self.fastscan.step(value, bit, part, next, own);
                self.configuration |= seen == identify::Seen::Complete;
                (seen != identify::Seen::Other).then_some(Response::Identified)
            }
            _ if !self.configuration => None,
            Request::ConfigureNodeId { node_id } => {
                let valid = matches!(node_id, 1..=127 | UNCONFIGURED);
                if valid {
                    self.node_id = Some(node_id);
                }
                let error = if valid {
                    error::NONE
                } else {
                    error::OUT_OF_RANGE
                };
                Some(Response::Configured {
                    command: 0x11,
                    error,
                })
            }
            Request::ConfigureBitTiming { table, index } => {
                let rate = profile.bit_rates.get(usize::from(index)).copied().flatten();
                let rate = rate.filter(|_| table == 0);
                self.bit_rate = rate.or(self.bit_rate);
                let error = if rate.is_some() {
                    error::NONE
                } else {
                    error::OUT_OF_RANGE
                };
                Some(Response::Configured {
                    command: 0x13,
                    error,
                })
            }
            Request::ActivateBitTiming { delay_ms } => {
                let active_rate = |objects: &mut Objects<'_, D>| {
                    if profile.is_own() {
                        stored(objects)[1]
                    } else {
                        let LssProfile { bit_rate, .. } = profile;
                        Some(objects.store.unsigned(bit_rate.index, bit_rate.sub) as u8)
                    }
                };
                let Some(bit_rate) = self.bit_rate.or_else(|| active_rate(objects)) else {
                    // The device keeps the bit rate that it was delivered with.
                    return Action::Answer(None);
                };
                return Action::Activate { delay_ms, bit_rate };
            }
            Request::Store => {
                let error = if profile.is_own() {
                    self.store_own(objects, active)
                } else {
                    self.store(objects, profile)
                };
                Some(Response::Configured {
                    command: 0x17,
                    error,
                })
            }
            Request::Inquire { part } => Some(Response::Number {
                part,
                value: number(objects, part as u8),
            }),
            Request::InquireNodeId if profile.inquire_node_id => Some(Response::NodeId {
                node_id: self.node_id.unwrap_or(active),
            }),
            _ => None,
        };
        Action::Answer(answer)
    }

    /// Writes the pending configuration to 2101h and 2100h, and saves only these two objects (CiA 305, chapter
    /// 6.4.5); the next start uses them. FFh is not a node ID, so it is not stored.
    fn store<D: Services>(&mut self, objects: &mut Objects<'_, D>, profile: &LssProfile) -> u8 {
        let pending = [
            (
                profile.node_id,
                self.node_id.filter(|id| *id != UNCONFIGURED),
            ),
            (profile.bit_rate, self.bit_rate),
        ];
        // A save in the background must be complete before this one begins.
        objects.complete_save();
        for (address, value) in pending {
            if let Some(value) = value
                && !objects.store.set_unsigned(address, value.into())
            {
                return error::NOT_SUPPORTED;
            }
        }
        let ours = [profile.node_id, profile.bit_rate];
        let (device, profile) = (objects.device(), &objects.profile.store);
        let plan = Plan::Only(&ours);
        code(image::write(
            objects.storage,
            device,
            &objects.store,
            profile,
            plan,
        ))
    }

    /// Writes the pending configuration into the image, in records without an object (CiA 305, chapter 6.4.5);
    /// the next start uses it. A node ID of FFh is stored as FFh.
    fn store_own<D: Services>(&mut self, objects: &mut Objects<'_, D>, active: u8) -> u8 {
        objects.complete_save();
        let (device, profile) = (objects.device(), &objects.profile.store);
        let mut banks = Banks::NONE;
        let mut medium = Medium::new(objects.storage, &mut banks);
        let stored = medium.own(device).and_then(|[node_id, bit_rate]| {
            let node_id = self.node_id.or(node_id).unwrap_or(active);
            let (own, len) = image::own_records(node_id, self.bit_rate.or(bit_rate));
            let plan = Plan::Own(own.get(..len).unwrap_or_default());
            medium.begin(&objects.store, profile, &plan)?;
            medium.commit()
        });
        code(stored)
    }
}

/// Error code of the response to a save.
fn code(saved: Result<(), StorageError>) -> u8 {
    match saved {
        Ok(()) => error::NONE,
        Err(_) => error::ACCESS,
    }
}

/// Number of the LSS address (CiA 301, object 1018h) at a position, from 0; 0 if the sub-object is missing.
fn number<D: Services>(objects: &Objects<'_, D>, part: u8) -> u32 {
    objects.store.word(0x1018, part.wrapping_add(1), 0)
}

/// Returns the stored node ID and bit rate of a device without objects for them; nothing if the
/// storage cannot be read.
pub(crate) fn stored<D: Services>(objects: &mut Objects<'_, D>) -> [Option<u8>; 2] {
    let device = objects.device();
    let mut banks = Banks::NONE;
    let mut medium = Medium::new(objects.storage, &mut banks);
    medium.own(device).unwrap_or_default()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_pending_configuration_survives_the_end_of_stopped() {
        let mut slave = Slave {
            configuration: true,
            node_id: Some(5),
            bit_rate: Some(3),
            ..Slave::BLANK
        };
        assert!(!slave.is_ready());
        slave.leave();
        assert!(!slave.configuration);
        assert_eq!((slave.node_id, slave.bit_rate), (Some(5), Some(3)));
        assert!(slave.is_ready());
        slave.node_id = Some(UNCONFIGURED);
        assert!(!slave.is_ready());
        slave.node_id = None;
        assert!(!slave.is_ready());
    }
}
