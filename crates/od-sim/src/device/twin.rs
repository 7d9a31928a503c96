//! Twin of a device: it receives the calls of the device, and may carry them out elsewhere, for
//! instance on a microcontroller.

use std::prelude::v1::*;

use od_model::Address;
use od_runtime::encoder::Encoder;
use od_runtime::storage::Storage;
use od_runtime::{BusEvent, Event, Frame, Instant, NodeId};
use od_wire::emcy::Emcy;
use od_wire::nmt::State;

use crate::shaft::Shaft;

/// Call of a device, one of [`Node`](od_runtime::Node).
#[derive(Clone, Copy, Debug)]
pub enum Call<'a> {
    /// Power on; the EEPROM already contains its factory values.
    PowerOn,
    /// Power off; the device may be off already.
    PowerOff,
    /// A frame was received.
    Frame(&'a Frame),
    /// A deadline is due.
    Timeout,
    /// The CAN controller reports a change of its state.
    Bus(BusEvent),
    /// Something outside the bus changed.
    Change,
    /// The initialisation ends at once.
    Boot,
    /// The device sets a value.
    Value(Address, &'a [u8]),
    /// The device reports the start (`true`) or the end of an error.
    Error(Emcy, bool),
    /// End of a sequence of calls; the device does nothing.
    End,
}

/// The device before a call: its node as the previous call left it; shaft, switches and faults as they are now.
pub struct Before<'d> {
    /// The NMT state.
    pub state: State,
    /// The active node ID.
    pub node_id: NodeId,
    /// Whether the device has power.
    pub is_powered: bool,
    /// The next deadline of the node.
    pub due: Option<Instant>,
    /// The encoder of the device, if it has one.
    pub encoder: Option<&'d Encoder<Shaft>>,
    /// The EEPROM.
    pub storage: &'d mut dyn Storage,
}

/// Receiver of the calls of a device.
pub trait Twin: Send {
    /// Receives a call, before the device does.
    fn call(&mut self, device: Before<'_>, now: Instant, call: Call<'_>);

    /// Receives a frame that the device sent because of the last call.
    fn sent(&mut self, frame: &Frame);

    /// Receives an event of the node.
    fn happened(&mut self, event: &Event);
}

/// The twin of a device, if it has one. A copy of the device has none.
#[derive(Default)]
pub(crate) struct TwinSlot(pub(crate) Option<Box<dyn Twin>>);

impl Clone for TwinSlot {
    fn clone(&self) -> Self {
        Self(None)
    }
}
