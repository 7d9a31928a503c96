//! Events of the node for the host: to show, to log, or to act on.

use od_model::Address;

use crate::application::Reset;
use crate::blank::Blank;
use crate::storage::image::Loaded;
use od_wire::NodeId;
use od_wire::emcy::Emcy;
use od_wire::nmt::State;

/// Event in the node.
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug)]
#[non_exhaustive]
pub enum Event {
    /// The NMT state changed.
    State(State),
    /// The device was reset, and starts with this node ID.
    Reset(Reset, NodeId),
    /// A master wrote an object.
    Written(Address),
    /// 1010h: the groups of this sub-index were saved.
    Saved(u8),
    /// 1011h: the groups of this sub-index were restored, at once or at the next reset.
    Restored(u8),
    /// LSS activated this bit rate. The number is the manufacturer's own code, as in 2100h.
    BitRate(u8),
    /// At a reset the storage was not as the last save left it: the node loaded this. A blank or
    /// complete storage is not reported; for an interrupted save see [`SaveCut`](Self::SaveCut).
    Loaded(Loaded),
    /// A save of a master or of the device itself failed. The values saved before it remain.
    NotSaved,
    /// Power loss or an NMT reset interrupted a save.
    SaveCut {
        /// `true`: the node loaded the factory values; `false`: the values saved before.
        factory: bool,
    },
    /// The CAN controller is bus-off; the profile decides whether the node restarts it.
    BusOff {
        /// The controller restarts as soon as the bus allows it.
        restarts: bool,
    },
    /// The node returned from bus-off.
    BusOn,
    /// An error began.
    Error(Emcy),
    /// The error with this code ended.
    ErrorCleared(u16),
    /// The service of this object (1005h, 1012h, 1014h, 1201h to 127Fh, 1400h to 15FFh, 1800h to
    /// 19FFh) is not valid: its CAN-ID does not fit its frame, is restricted (CiA 301, table 40),
    /// or belongs to another service with which the node sends.
    CobIdRefused(u16),
    /// 16 EMCY messages wait for the inhibit time (1015h), so the node dropped the message of the
    /// error before this event. 1001h and 1003h contain the error.
    EmcyDropped,
}

impl Blank for Event {
    const BLANK: Self = Self::State(State::Initialising);
}
