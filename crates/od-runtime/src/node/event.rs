//! Events of the node for the host: to show, to log, or to act on.

use od_model::Address;

use crate::application::Reset;
use crate::blank::Blank;
use crate::storage::image::Loaded;
use od_wire::NodeId;
use od_wire::emcy::Emcy;
use od_wire::nmt::State;

impl Blank for Event {
    const BLANK: Self = Self::State(State::Initialising);
}

/// Something happened in the node.
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
    /// LSS activated this bit rate; the number is the device's own (2100h).
    BitRate(u8),
    /// The storage is not as the last save left it; this is what the node loaded at a reset. Neither
    /// blank nor complete, and not cut.
    Loaded(Loaded),
    /// A save failed, that of a master or the device's own. The values saved before it remain.
    NotSaved,
    /// Power loss or an NMT reset interrupted a save.
    SaveCut {
        /// The node loaded the factory values; else the values that were saved before it.
        factory: bool,
    },
    /// The CAN controller is bus-off; the profile decides whether the node restarts it.
    BusOff {
        /// The controller restarts as soon as the bus allows it.
        restarts: bool,
    },
    /// The node is back from bus-off.
    BusOn,
    /// An error came.
    Error(Emcy),
    /// The error with this code went.
    ErrorCleared(u16),
    /// The service of this object (1005h, 1012h, 1014h, 1201h to 127Fh, 1400h to 15FFh, 1800h to 19FFh) is not
    /// valid: its CAN-ID does not fit its frame, is restricted (CiA 301, table 40), or is that of another
    /// service by which the node sends.
    CobIdRefused(u16),
    /// 16 EMCY messages wait for the inhibit time (1015h), so that of the error that came or went
    /// before this event is dropped. 1001h and 1003h have it.
    EmcyDropped,
}
