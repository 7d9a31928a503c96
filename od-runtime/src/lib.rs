//! A CANopen slave node and a CiA 406 encoder, sans-io.
//!
//! A node receives frames and the time, and returns frames, the next deadline and events.
//! It uses no clock, thread, allocation or `unsafe`, and no input makes it panic.
//!
//! # The loop
//!
//! A [`Node`] keeps the state of the services. What belongs to the device (dictionary,
//! values, behaviour, storage) is lent to each call as a [`Lent`]. After every input, call
//! [`poll_transmit`](Node::poll_transmit) until it returns no frame; then sleep until
//! the next frame or [`poll_timeout`](Node::poll_timeout), whichever is first:
//!
//! ```
//! use od_runtime::storage::Memory;
//! use od_runtime::{Frame, Instant, Lent, NoApplication, Node, NodeId, Profile};
//!
//! // In a device this is a constant that `od_macros::object_dictionary!` made of the EDS.
//! let eds = "[1000]\nParameterName=Device type\nDataType=7\nAccessType=ro\nDefaultValue=0x196\n\
//!            [1017]\nParameterName=Heartbeat\nDataType=6\nAccessType=rw\nDefaultValue=100\n";
//! let tables = od_eds::Tables::new(&od_eds::parse(eds).description);
//!
//! let mut values = vec![0; tables.dictionary().store_len()];
//! let mut application = NoApplication;
//! let mut storage = Memory::new([0xFF; 256]);
//! let mut device = Lent {
//!     dictionary: tables.dictionary(),
//!     values: &mut values,
//!     application: &mut application,
//!     storage: &mut storage,
//!     profile: Some(&Profile::CIA301),
//! };
//! let mut node: Node = Node::new(NodeId::ONE);
//! let mut bus = Vec::new(); // in place of the CAN controller
//!
//! // Power comes: the boot-up message goes out.
//! let mut now = Instant::ZERO;
//! node.power_on(&mut device, now)?;
//! while let Some(frame) = node.poll_transmit(&mut device, now) {
//!     bus.push(frame.to_string());
//! }
//!
//! // A frame comes: a master reads 1000h.
//! let request = Frame::standard(0x601, &[0x40, 0x00, 0x10, 0, 0, 0, 0, 0]);
//! node.handle_frame(&mut device, now, &request);
//! while let Some(frame) = node.poll_transmit(&mut device, now) {
//!     bus.push(frame.to_string());
//! }
//!
//! // Nothing comes until the node's own deadline: its first heartbeat.
//! if let Some(at) = node.poll_timeout() {
//!     now = at; // a device sleeps until then
//!     node.handle_timeout(&mut device, now);
//!     while let Some(frame) = node.poll_transmit(&mut device, now) {
//!         bus.push(frame.to_string());
//!     }
//! }
//! assert_eq!(bus, ["701#00", "581#4300100096010000", "701#7F"]);
//! assert_eq!(now, Instant::from_millis(100));
//! # Ok::<(), od_runtime::Unfit>(())
//! ```
//!
//! A host that knows the state of its CAN controller reports it with [`Node::handle_bus`].
//!
//! The behaviour of a device is an [`Application`]; the encoder of CiA 406 is one
//! ([`encoder::Encoder`]). A [`Profile`] contains the differences of a device family. Saved values
//! go to any [`storage::Storage`].
#![no_std]
#![forbid(unsafe_code)]

#[cfg(any(feature = "std", test))]
extern crate std;

mod application;
mod change;
mod deadline;
mod device;
mod emcy;
pub mod encoder;
mod error_control;
mod extras;
mod fifo;
mod kind;
mod lent;
mod limits;
mod lss;
mod node;
mod number;
mod objects;
mod pdo;
mod profile;
pub mod program;
#[doc(hidden)]
pub mod rooms;
mod sdo;
pub mod storage;
mod store;
mod sync;

// Types in the signatures of the node's functions.
pub use od_wire::emcy::Emcy;
pub use od_wire::time_of_day::TimeOfDay;
pub use od_wire::{AbortCode, CanId, CobId, Duration, Frame, Instant, NodeId};

pub use application::{
    Application, Chunk, Context, Halt, NoApplication, Reset, Signals, Stream, StreamEnd,
};
pub use device::{AnyDevice, Device};
pub use extras::{Clocks, Extra, Extras, Only};
pub use kind::DeviceKind;
pub use lent::Lent;
pub use node::{BusEvent, Event, Node, Unfit};
pub use profile::{
    BusOffProfile, CommunicationReset, CutSave, ErrorProfile, ErrorReset, LengthRule, LssProfile,
    NmtProfile, Notice, PdoProfile, Profile, Restore, SaveAnswer, SavedCobIds, SdoProfile,
    StoreProfile,
};
pub use rooms::{FullRooms, Rooms};
pub use sdo::SdoServer;
pub use store::{Store, StoreTooSmall, TextTooLong};
