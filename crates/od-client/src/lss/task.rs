//! Services of an LSS master, and their results.

use od_wire::NodeId;
use od_wire::lss::{Part, Request};

/// The LSS address: the four numbers of 1018h (CiA 305).
///
/// ```
/// use od_client::lss::Identity;
///
/// let identity = Identity::new([0xEC, 0x0A, 0x1_0000, 4712]);
/// assert_eq!((identity.vendor, identity.serial), (0xEC, 4712));
/// ```
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Debug, Default)]
pub struct Identity {
    /// 1018h:01, vendor-ID.
    pub vendor: u32,
    /// 1018h:02, product code.
    pub product: u32,
    /// 1018h:03, revision number.
    pub revision: u32,
    /// 1018h:04, serial number.
    pub serial: u32,
}

impl Identity {
    /// From the four numbers in the order of 1018h.
    pub const fn new([vendor, product, revision, serial]: [u32; 4]) -> Self {
        Self {
            vendor,
            product,
            revision,
            serial,
        }
    }

    /// The four numbers in the order of 1018h.
    pub const fn parts(self) -> [u32; 4] {
        [self.vendor, self.product, self.revision, self.serial]
    }
}

/// One service of the LSS master (CiA 305, chapter 6).
///
/// A service for a single slave needs exactly one slave in configuration state.
///
/// ```
/// use od_client::Instant;
/// use od_client::lss::{Master, Options, Task};
///
/// let mut master = Master::new(Options::DEFAULT);
/// master.begin(Task::InquireNodeId).expect("it has no other task");
/// let frame = master.poll_transmit(Instant::ZERO).expect("the request");
/// assert_eq!(frame.to_string(), "7E5#5E00000000000000");
/// ```
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug)]
#[non_exhaustive]
pub enum Task {
    /// Switch state global: all slaves to configuration state, or to waiting state. No slave
    /// answers.
    SwitchGlobal {
        /// To configuration state.
        configuration: bool,
    },
    /// Switch state selective: the slave with this LSS address to configuration state.
    SwitchSelective(Identity),
    /// Inquire one number of the LSS address.
    Inquire(Part),
    /// Inquire node ID.
    InquireNodeId,
    /// Configure node ID; `None` writes FFh, which makes the slave a non-configured one.
    ConfigureNodeId(Option<NodeId>),
    /// Configure bit timing: a table (0: CiA 301) and an index into it (0: 1000 kbit/s to
    /// 8: 10 kbit/s).
    ConfigureBitTiming {
        /// Table selector.
        table: u8,
        /// Table index.
        index: u8,
    },
    /// Activate bit timing. The slaves are silent for this time, change over, and are silent
    /// for it again. No slave answers.
    ActivateBitTiming {
        /// Switch delay in ms.
        delay_ms: u16,
    },
    /// Store configuration.
    Store,
    /// Identify remote slave: asks whether a slave with these numbers exists. The last two are ranges
    /// that include both ends.
    Identify {
        /// Vendor-ID.
        vendor: u32,
        /// Product code.
        product: u32,
        /// Lowest and highest revision number.
        revision: [u32; 2],
        /// Lowest and highest serial number.
        serial: [u32; 2],
    },
    /// Identify non-configured remote slave: asks whether a slave without node ID exists.
    IdentifyNonConfigured,
    /// Fastscan: finds the LSS address of one slave in waiting state. This slave is then in
    /// configuration state, so the next fastscan finds another one.
    Fastscan,
}

impl Task {
    /// The frame of a step, while there are further steps. Fastscan has frames of its own.
    pub(super) fn request(self, step: u8) -> Option<Request> {
        let at = usize::from(step);
        match self {
            Self::SwitchSelective(identity) => {
                let value = *identity.parts().get(at)?;
                let part = *Part::ALL.get(at)?;
                return Some(Request::SwitchSelective { part, value });
            }
            Self::Identify {
                vendor,
                product,
                revision,
                serial,
            } => {
                let [low_revision, high_revision] = revision;
                let [low, high] = serial;
                let values = [vendor, product, low_revision, high_revision, low, high];
                let value = *values.get(at)?;
                return Some(Request::IdentifyRemote { step, value });
            }
            _ if step > 0 => return None,
            _ => {}
        }
        Some(match self {
            Self::SwitchGlobal { configuration } => Request::SwitchGlobal { configuration },
            Self::Inquire(part) => Request::Inquire { part },
            Self::InquireNodeId => Request::InquireNodeId,
            Self::ConfigureNodeId(node) => Request::ConfigureNodeId {
                node_id: node.map_or(0xFF, NodeId::raw),
            },
            Self::ConfigureBitTiming { table, index } => {
                Request::ConfigureBitTiming { table, index }
            }
            Self::ActivateBitTiming { delay_ms } => Request::ActivateBitTiming { delay_ms },
            Self::Store => Request::Store,
            Self::IdentifyNonConfigured => Request::IdentifyNonConfigured,
            Self::SwitchSelective(_) | Self::Identify { .. } | Self::Fastscan => return None,
        })
    }

    /// Returns whether no slave responds.
    pub(super) const fn is_unconfirmed(self) -> bool {
        matches!(
            self,
            Self::SwitchGlobal { .. } | Self::ActivateBitTiming { .. }
        )
    }

    /// Returns whether no response is a result, too: no such slave exists.
    pub(super) const fn is_question(self) -> bool {
        matches!(self, Self::Identify { .. } | Self::IdentifyNonConfigured)
    }
}

/// Result of a service.
///
/// ```
/// use od_client::lss::{Answer, Master, Options, Task};
/// use od_client::{Frame, Instant, NodeId};
///
/// let mut master = Master::new(Options::DEFAULT);
/// master.begin(Task::InquireNodeId).expect("it has no other task");
/// master.poll_transmit(Instant::ZERO);
/// master.handle_frame(Instant::ZERO, &Frame::standard(0x7E4, &[0x5E, 1, 0, 0, 0, 0, 0, 0]));
/// assert_eq!(master.poll_answer(), Some(Ok(Answer::NodeId(Some(NodeId::ONE)))));
/// ```
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug)]
#[non_exhaustive]
pub enum Answer {
    /// Success; for a service without a response: it was sent.
    Done,
    /// A number of the LSS address.
    Number(u32),
    /// The node ID; `None` if the slave has none (FFh) or an invalid one.
    NodeId(Option<NodeId>),
    /// Whether such a slave exists.
    Exists(bool),
    /// The slave that fastscan found; `None` if there are no more.
    Found(Option<Identity>),
}
