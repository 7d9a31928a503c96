//! LSS slave (CiA 305): node ID and bit rate without knowing either.

mod identify;

use crate::objects::Objects;
use crate::profile::LssProfile;
use od_wire::lss::{Part, Request, Response};

/// The pending node ID of a slave that has none (CiA 305, chapter 6.3.1).
const UNCONFIGURED: u8 = 0xFF;

/// Error codes of 11h, 13h and 17h.
mod error {
    pub(super) const NONE: u8 = 0;
    pub(super) const OUT_OF_RANGE: u8 = 1;
    pub(super) const NOT_SUPPORTED: u8 = 1;
    pub(super) const ACCESS: u8 = 2;
}

/// What a request makes the node do, besides the answer.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(crate) enum Action {
    /// Nothing, or the answer alone.
    Answer(Option<Response>),
    /// Silence for so many milliseconds, then the bit rate of this index of 2100h, then
    /// silence again where the family has it.
    Activate {
        /// Switch delay, in ms.
        delay_ms: u16,
        /// The new bit rate, as the device's own object numbers it.
        bit_rate: u8,
    },
}

/// The slave.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Slave {
    configuration: bool,
    selective: identify::Sequence,
    remote: identify::Sequence,
    fastscan: identify::Fastscan,
    /// Set by 11h and not stored yet.
    node_id: Option<u8>,
    /// Set by 13h and not stored yet; a value of 2100h.
    bit_rate: Option<u8>,
}

impl Slave {
    pub(crate) const fn new() -> Self {
        Self {
            configuration: false,
            selective: identify::Sequence::new(),
            remote: identify::Sequence::new(),
            fastscan: identify::Fastscan::new(),
            node_id: None,
            bit_rate: None,
        }
    }

    /// Back to waiting, as leaving Stopped does on devices that have LSS there alone. What
    /// was configured and not stored stays pending until a reset.
    pub(crate) fn leave(&mut self) {
        let (node_id, bit_rate) = (self.node_id, self.bit_rate);
        *self = Self {
            node_id,
            bit_rate,
            ..Self::new()
        };
    }

    /// A master's frame.
    pub(crate) fn handle(
        &mut self,
        objects: &mut Objects<'_>,
        profile: &LssProfile,
        data: &[u8],
    ) -> Action {
        let Some(request) = Request::parse(data) else {
            return Action::Answer(None);
        };
        let address = Part::ALL.map(|part| objects.store.unsigned(0x1018, part as u8 + 1) as u32);
        let answer = match request {
            Request::SwitchGlobal { configuration } => {
                self.configuration = configuration;
                None
            }
            Request::SwitchSelective { part, value } => {
                let matches = address[part as usize] == value;
                let complete = self.selective.step(part as u8, 3, matches);
                self.configuration |= complete;
                complete.then_some(Response::Selected { state: 1 })
            }
            Request::IdentifyRemote { step, value } if profile.identify_remote => {
                let complete = self
                    .remote
                    .step(step, 5, identify::in_range(step, value, address));
                complete.then_some(Response::Identified)
            }
            Request::IdentifyNonConfigured if profile.non_configured => {
                (self.node_id == Some(UNCONFIGURED)).then_some(Response::NonConfigured)
            }
            Request::Fastscan {
                number,
                bit,
                part,
                next,
            } if profile.fastscan => {
                // Who is being configured was found already (CiA 305, chapter 6.3.6).
                if self.configuration {
                    return Action::Answer(None);
                }
                let seen = self.fastscan.step(number, bit, part, next, address);
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
                let stored = objects
                    .store
                    .unsigned(profile.bit_rate.index, profile.bit_rate.sub);
                let bit_rate = self.bit_rate.unwrap_or(stored as u8);
                return Action::Activate { delay_ms, bit_rate };
            }
            Request::Store => {
                let error = self.store(objects, profile);
                Some(Response::Configured {
                    command: 0x17,
                    error,
                })
            }
            Request::Inquire { part } => Some(Response::Number {
                part,
                value: address[part as usize],
            }),
            Request::InquireNodeId if profile.inquire_node_id => {
                let active = objects.store.node_id().raw();
                Some(Response::NodeId {
                    node_id: self.node_id.unwrap_or(active),
                })
            }
            _ => None,
        };
        Action::Answer(answer)
    }

    /// Puts what is pending where 2101h and 2100h have it, and saves those two alone: the
    /// next start takes them. A node ID of FFh is none, and nothing is stored for it.
    fn store(&mut self, objects: &mut Objects<'_>, profile: &LssProfile) -> u8 {
        let pending = [
            (
                profile.node_id,
                self.node_id.filter(|id| *id != UNCONFIGURED),
            ),
            (profile.bit_rate, self.bit_rate),
        ];
        // What a save writes in the background is there before anything follows.
        objects.complete_save();
        for (address, value) in pending {
            if let Some(value) = value
                && !objects.store.set_unsigned(address, value.into())
            {
                return error::NOT_SUPPORTED;
            }
        }
        let ours = |entry: &od_model::Entry| {
            entry.address == profile.node_id || entry.address == profile.bit_rate
        };
        match crate::storage::image::save_only(
            objects.storage,
            &objects.store,
            &objects.profile.store,
            &ours,
        ) {
            Ok(()) => error::NONE,
            Err(_) => error::ACCESS,
        }
    }
}
