//! Interface between the node and the behaviour of the device.

use core::fmt;

use od_model::Address;

use crate::emcy::Change;
use crate::fifo::Fifo;
use crate::store::Store;
use od_wire::emcy::Emcy;
use od_wire::nmt::State;
use od_wire::time_of_day::TimeOfDay;
use od_wire::{AbortCode, Instant, NodeId};

/// Kind of a reset (CiA 301, chapter 7.3.2).
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug)]
#[non_exhaustive]
pub enum Reset {
    /// Power-on: everything in RAM is lost.
    PowerOn,
    /// NMT reset node: all values are loaded from storage again.
    Node,
    /// NMT reset communication: 1000h–1FFFh are loaded from storage again.
    Communication,
    /// 1011h on a device that restores at once: values became their defaults in RAM.
    Defaults,
}

/// Parts of the node that an application may use during a call.
pub struct Context<'c, 'a> {
    /// Current values.
    pub store: &'c mut Store<'a>,
    /// Time of the call.
    pub now: Instant,
    /// Requests to the node, carried out when the call is over.
    pub signals: &'c mut Signals<[Change]>,
}

/// Changes that [`Signals::new`] has room for.
const CHANGES: usize = 32;

/// Requests of an application to its node, carried out when the call is over.
///
/// `Q` is the memory for the errors that begin or end in a call.
#[derive(Clone, Debug)]
pub struct Signals<Q: ?Sized = [Change; CHANGES]> {
    /// The constants of the type, one bit each.
    requests: u8,
    /// Errors that began or ended, in order.
    pub(crate) errors: Fifo<Q>,
}

impl Default for Signals {
    fn default() -> Self {
        Self::new()
    }
}

impl Signals {
    /// Communication objects were changed by the application itself.
    pub(crate) const RECONFIGURE: u8 = 1;
    /// The application's own deadline may have moved.
    pub(crate) const TICK: u8 = 2;
    /// The operating records must be saved.
    pub(crate) const KEEP: u8 = 4;
    /// The application requests a TIME message.
    pub(crate) const SEND_TIME: u8 = 8;

    /// No requests, and room for 32 errors.
    pub const fn new() -> Self {
        Self::with_room([Change::NONE; CHANGES])
    }
}

impl<Q> Signals<Q> {
    /// No requests.
    pub(crate) const fn with_room(room: Q) -> Self {
        Self {
            requests: 0,
            errors: Fifo::new(room),
        }
    }
}

impl<Q: ?Sized> Signals<Q> {
    /// Returns whether there is nothing to carry out.
    #[inline]
    pub(crate) const fn is_idle(&self) -> bool {
        self.errors.is_empty() && self.requests == 0
    }

    /// Returns whether the application made this request, and removes it.
    pub(crate) fn take(&mut self, request: u8) -> bool {
        let found = self.requests & request != 0;
        self.requests &= !request;
        found
    }

    /// Reports that the application changed communication objects (1000h–1FFFh); the services
    /// read them again.
    pub fn reconfigure(&mut self) {
        self.requests |= Signals::RECONFIGURE;
    }

    /// Requests a save of the operating records (hours, counters) only. A failed save is not
    /// repeated until the next request.
    pub fn keep(&mut self) {
        self.requests |= Signals::KEEP;
    }

    /// Requests a TIME message with the time of [`Application::time`]. The node sends it if bit 30
    /// of 1012h is set and the NMT state is Pre-operational or Operational.
    pub fn send_time(&mut self) {
        self.requests |= Signals::SEND_TIME;
    }

    /// Requests a call of [`Application::tick`], whose deadline may have changed.
    pub fn wake(&mut self) {
        self.requests |= Signals::TICK;
    }
}

impl Signals<[Change]> {
    /// Reports an error: the node sends an EMCY message and updates 1001h and 1003h.
    ///
    /// An active error with the same code and the same bits of 1001h is not reported again.
    pub fn raise(&mut self, error: Emcy) {
        self.errors.push(Change::Raised(error));
    }

    /// Reports the end of an error: the node updates 1001h and sends an EMCY message with code
    /// 0000h (error reset) and this manufacturer-specific information.
    pub fn clear(&mut self, code: u16, info: [u8; 5]) {
        self.errors.push(Change::Cleared {
            code,
            register: None,
            info,
        });
    }

    /// As [`clear`](Self::clear), if several errors share a code: ends the one that set these bits
    /// of 1001h.
    pub fn clear_one(&mut self, code: u16, register: u8, info: [u8; 5]) {
        self.errors.push(Change::Cleared {
            code,
            register: Some(register),
            info,
        });
    }
}

/// A part of a streamed value.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct Chunk<'b> {
    /// Bytes of the value before this part.
    pub at: u32,
    /// The bytes; empty only if the value is empty.
    pub bytes: &'b [u8],
    /// The value ends with this part, and the server received all parts correctly.
    pub last: bool,
}

/// Reason why a stream does not carry out a request of the SDO server.
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug)]
pub enum Halt {
    /// Never: the transfer ends with this abort code.
    Abort(AbortCode),
    /// Not now: the server delays its response to the master, and repeats the request at this
    /// moment or at [`Node::handle_change`](crate::Node::handle_change), whichever is first.
    Until(Instant),
}

impl fmt::Display for Halt {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Abort(code) => write!(f, "the stream aborts the transfer: {code}"),
            Self::Until(at) => write!(f, "the stream is busy until {at:?}"),
        }
    }
}

impl core::error::Error for Halt {}

impl From<AbortCode> for Halt {
    fn from(code: AbortCode) -> Self {
        Self::Abort(code)
    }
}

/// End of a streamed transfer.
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug)]
#[non_exhaustive]
pub enum StreamEnd {
    /// The stream received all bytes, or the master did.
    Complete,
    /// The server aborted it with this code: a code of the stream itself, a wrong checksum, or a
    /// time-out of the master ([`AbortCode::Timeout`]).
    Aborted(AbortCode),
    /// The master aborted it, with this code.
    Cancelled(u32),
    /// The master began another transfer instead.
    Replaced,
    /// NMT reset, NMT stop, or bus-off.
    Cut,
}

/// A value that the application moves part by part, so that it need not be in memory as a whole: a
/// program, or a record of measurements.
///
/// [`Application::stream`] says which objects have one. The SDO server checks access, toggle bits,
/// sequence and CRC; the stream sets the limits of length, and the node calls neither
/// [`validate`](Application::validate) nor [`written`](Application::written). The stream gets parts
/// of a download before the server knows that all of it will arrive. If a transfer has to be all or
/// nothing, the stream must ensure it until the part that is [`last`](Chunk::last).
///
/// [`end`](Self::end) follows exactly once after each `begin` that succeeded, except at power-off:
/// a [`Reset::PowerOn`] drops a transfer without a call.
pub trait Stream {
    /// A master begins to write a value, of `size` bytes if the master announces a size.
    ///
    /// # Errors
    /// [`Halt`]; [`AbortCode::TooLong`] if a value of this size does not fit.
    fn begin_download(
        &mut self,
        cx: &mut Context<'_, '_>,
        address: Address,
        size: Option<u32>,
    ) -> Result<(), Halt>;

    /// Accepts the next part, up to the size of the server's buffer. In a block transfer a part is
    /// at most one block.
    ///
    /// # Errors
    /// [`Halt`]; with [`Halt::Until`] nothing was accepted, and the server passes the same part
    /// again.
    fn write(
        &mut self,
        cx: &mut Context<'_, '_>,
        address: Address,
        chunk: Chunk<'_>,
    ) -> Result<(), Halt>;

    /// A master begins to read the value. Returns its length in bytes.
    ///
    /// # Errors
    /// [`Halt`].
    fn begin_upload(&mut self, cx: &mut Context<'_, '_>, address: Address) -> Result<u32, Halt>;

    /// Fills `to` with the bytes of the value from `at` on; they are within its length. The server
    /// asks again for bytes that the master did not confirm.
    ///
    /// # Errors
    /// [`Halt`]; with [`Halt::Until`] the server ignores the content of `to`.
    fn read(
        &mut self,
        cx: &mut Context<'_, '_>,
        address: Address,
        at: u32,
        to: &mut [u8],
    ) -> Result<(), Halt>;

    /// Ends the transfer.
    fn end(&mut self, cx: &mut Context<'_, '_>, address: Address, end: StreamEnd) {
        let _ = (cx, address, end);
    }
}

/// Connection of a device to the world outside the bus: a terminal, a switch, a shaft.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct Pin {
    /// Name in scripts, as in `in1`.
    pub name: &'static str,
    /// The side that sets it.
    pub kind: PinKind,
}

/// The side that sets a [`Pin`], and its value without power.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum PinKind {
    /// The world outside sets it.
    Input,
    /// The device sets it; 0 without power.
    Output,
    /// The device sets it; without power it keeps its value, as the angle of a shaft does.
    Kept,
}

impl Pin {
    /// A connection that the world outside sets.
    pub const fn input(name: &'static str) -> Self {
        let kind = PinKind::Input;
        Self { name, kind }
    }

    /// A connection that the device sets; 0 without power.
    pub const fn output(name: &'static str) -> Self {
        let kind = PinKind::Output;
        Self { name, kind }
    }

    /// A connection that the device sets, and that keeps its value without power.
    pub const fn kept(name: &'static str) -> Self {
        let kind = PinKind::Kept;
        Self { name, kind }
    }
}

/// Kind of a change of a mapped value, by which an event-driven TPDO is sent or not
/// ([`Application::change_kind`]).
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum ChangeKind {
    /// The TPDO is sent.
    Event,
    /// Nothing is sent; the next value is compared with the one that was sent last, as a dead band
    /// needs it.
    BelowThreshold,
    /// Nothing is sent; the next value is compared with this one, as the mask of an edge needs it.
    Masked,
}

/// Behaviour of a device: checks writes, reacts to them, and provides live values.
///
/// Every function has an empty default, so a device without behaviour is [`NoApplication`].
/// An application sends no frame itself: the node sends frames because of changed values and
/// signals.
pub trait Application {
    /// Called after a reset, when the values are loaded: updates the rest of the device.
    fn reset(&mut self, cx: &mut Context<'_, '_>, reset: Reset) {
        let _ = (cx, reset);
    }

    /// Returns the node ID that the device starts with, if it has one of its own (switches, an
    /// object, LSS). Called at a [`Reset`], after the values are loaded. `None`: the node keeps
    /// its node ID.
    fn node_id(&self, store: &Store<'_>) -> Option<NodeId> {
        let _ = store;
        None
    }

    /// Returns whether [`refresh`](Self::refresh) may update the value at an address. The node asks
    /// after each [`reset`](Self::reset), for all values from 2000h on, and reads a value that is
    /// not live without a call of the application. By default all values are live.
    fn is_live(&self, address: Address) -> bool {
        let _ = address;
        true
    }

    /// Updates the value at `address`, which an SDO or a PDO is about to read.
    ///
    /// # Errors
    /// Abort code of the SDO; a PDO sends the old value.
    fn refresh(&mut self, cx: &mut Context<'_, '_>, address: Address) -> Result<(), AbortCode> {
        let _ = (cx, address);
        Ok(())
    }

    /// Checks a `value` that a master wants to write; it has the length of the object and is
    /// within its limits. The store still holds the old value.
    ///
    /// # Errors
    /// Abort code of the SDO; the value stays as it was.
    fn validate(
        &mut self,
        cx: &mut Context<'_, '_>,
        address: Address,
        value: &[u8],
    ) -> Result<(), AbortCode> {
        let _ = (cx, address, value);
        Ok(())
    }

    /// Reacts to a value that a master wrote; the store holds it.
    fn written(&mut self, cx: &mut Context<'_, '_>, address: Address) {
        let _ = (cx, address);
    }

    /// Returns the stream of a string or DOMAIN whose value the store does not hold; `None`: the store
    /// holds it. A node that knows its dictionary as a type asks only if `object_dictionary!` gave a
    /// value `capacity = 0`, so the store has no room for it; any other node asks for each value.
    fn stream(&mut self, address: Address) -> Option<&mut dyn Stream> {
        let _ = address;
        None
    }

    /// Called before (`begins`) and after a save reads the values of the store. An application that
    /// shows another value in an object than the one to save exchanges the two between these calls.
    fn saving(&mut self, cx: &mut Context<'_, '_>, begins: bool) {
        let _ = (cx, begins);
    }

    /// Receives the state of the storage: sound or damaged before a [`reset`](Self::reset), sound
    /// after a save or restore. [`tick`](Self::tick) follows.
    fn storage_is(&mut self, sound: bool) {
        let _ = sound;
    }

    /// Returns bytes 3 to 7 of an EMCY message that a service sends.
    fn error_info(&self, store: &Store<'_>) -> [u8; 5] {
        let _ = store;
        [0; 5]
    }

    /// Receives the time of a TIME message (1012h, bit 31).
    fn set_time(&mut self, cx: &mut Context<'_, '_>, time: TimeOfDay) {
        let _ = (cx, time);
    }

    /// Returns the time for a TIME message that was requested with [`Signals::send_time`]; `None`:
    /// the time is not known, and nothing is sent.
    fn time(&mut self, cx: &mut Context<'_, '_>) -> Option<TimeOfDay> {
        let _ = cx;
        None
    }

    /// Receives the NMT state when it changes after the boot-up.
    fn state_is(&mut self, cx: &mut Context<'_, '_>, state: State) {
        let _ = (cx, state);
    }

    /// Reports that the master is lost: life guarding or a heartbeat failed, or the node is
    /// bus-off. Called before 1029h acts. The next [`state_is`](Self::state_is) with Operational
    /// ends this state.
    fn master_lost(&mut self, cx: &mut Context<'_, '_>) {
        let _ = cx;
    }

    /// Returns the kind of a change of a mapped value: for an event, an event-driven TPDO is sent. By
    /// default each change is an event; a dead band or a mask of edges makes fewer. `last` are the
    /// bits that the TPDO sent last, or those of the last [masked](ChangeKind::Masked) change; `now`
    /// are the current bits.
    fn change_kind(&self, store: &Store<'_>, address: Address, last: u64, now: u64) -> ChangeKind {
        let _ = (store, address, last, now);
        ChangeKind::Event
    }

    /// Connections of the device to the world outside the bus, for a host that simulates this
    /// world.
    fn pins(&self) -> &'static [Pin] {
        &[]
    }

    /// Returns the value at a connection, by its number in [`pins`](Self::pins).
    fn pin(&self, number: usize) -> i64 {
        let _ = number;
        0
    }

    /// Sets an input. A call of [`Node::handle_change`](crate::Node::handle_change) follows.
    fn set_pin(&mut self, number: usize, value: i64) {
        let _ = (number, value);
    }

    /// Acts on time or on a change outside the bus, and returns when it wants to be called next.
    /// `None`: only after a change.
    fn tick(&mut self, cx: &mut Context<'_, '_>) -> Option<Instant> {
        let _ = cx;
        None
    }
}

/// Device without behaviour: only its dictionary.
#[derive(Clone, Copy, Debug, Default)]
pub struct NoApplication;

impl Application for NoApplication {
    fn is_live(&self, _: Address) -> bool {
        false
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_request_is_carried_out_once() {
        let requests = [
            (Signals::reconfigure as fn(&mut _), Signals::RECONFIGURE),
            (Signals::wake, Signals::TICK),
            (Signals::keep, Signals::KEEP),
            (Signals::send_time, Signals::SEND_TIME),
        ];
        for (ask, request) in requests {
            let mut signals = Signals::new();
            assert!(signals.is_idle());
            ask(&mut signals);
            assert!(!signals.is_idle());
            assert!(!signals.take(!request), "no other");
            assert!(signals.take(request));
            assert!(!signals.take(request) && signals.is_idle());
        }
    }
}
