//! A CANopen slave node and a CiA 406 encoder, sans-io.
//!
//! A node receives frames and the time, and returns frames, the next deadline and events.
//! It uses no clock, thread, allocation or `unsafe`, and no input makes it panic.
//!
//! # The loop
//!
//! A [`Node`] owns its device, the current values, the behaviour and the storage. After every input, call
//! [`poll_transmit`](Node::poll_transmit) until it returns no frame; then sleep until
//! the next frame or [`poll_timeout`](Node::poll_timeout), whichever is first:
//!
//! ```
//! use od_runtime::rooms::{LoadedRooms, LoadedValues};
//! use od_runtime::storage::NoStorage;
//! use od_runtime::{Device, Frame, Instant, NoApplication, Node, NodeId, Services};
//!
//! // A device whose EDS is read at run time; `odkit::object_dictionary!` makes one at compile time.
//! struct Loaded(od_eds::Tables);
//!
//! impl Services for Loaded {}
//!
//! impl Device for Loaded {
//!     type Values = LoadedValues;
//!     type Rooms = LoadedRooms;
//!
//!     fn dictionary(&self) -> od_model::Dictionary<'_> {
//!         self.0.dictionary()
//!     }
//! }
//!
//! let eds = "[1000]\nParameterName=Device type\nDataType=7\nAccessType=ro\nDefaultValue=0x196\n\
//!            [1017]\nParameterName=Heartbeat\nDataType=6\nAccessType=rw\nDefaultValue=100\n";
//! let device = Loaded(od_eds::Tables::new(&od_eds::parse(eds).description));
//! let mut node = Node::new(device, NodeId::ONE, NoApplication, NoStorage);
//! let mut bus = Vec::new(); // in place of the CAN controller
//!
//! // Power on: the node sends its boot-up message.
//! let mut now = Instant::ZERO;
//! node.power_on(now);
//! while let Some(frame) = node.poll_transmit(now) {
//!     bus.push(frame.to_string());
//! }
//!
//! // A frame comes: a master reads 1000h.
//! let request = Frame::standard(0x601, &[0x40, 0x00, 0x10, 0, 0, 0, 0, 0]);
//! node.handle_frame(now, &request);
//! while let Some(frame) = node.poll_transmit(now) {
//!     bus.push(frame.to_string());
//! }
//!
//! // Nothing comes until the node's own deadline: its first heartbeat.
//! if let Some(at) = node.poll_timeout() {
//!     now = at; // a device sleeps until then
//!     node.handle_timeout(now);
//!     while let Some(frame) = node.poll_transmit(now) {
//!         bus.push(frame.to_string());
//!     }
//! }
//! assert_eq!(bus, ["701#00", "581#4300100096010000", "701#7F"]);
//! assert_eq!(now, Instant::from_millis(100));
//! ```
//!
//! A host that knows the state of its CAN controller reports it with [`Node::handle_bus`].
//!
//! The behaviour of a device is an [`Application`]; the encoder of CiA 406 is one
//! ([`encoder::Encoder`]). A [`Profile`] contains the differences of a device family. Saved values
//! go to any [`storage::Storage`].
#![no_std]
#![forbid(unsafe_code)]
#![cfg_attr(docsrs, feature(doc_cfg))]

#[cfg(any(feature = "std", test))]
extern crate std;

mod application;
mod blank;
mod deadline;
mod device;
mod emcy;
pub mod encoder;
mod error_control;
mod fifo;
#[cfg(feature = "std")]
pub mod kind;
mod limits;
mod listening;
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
mod services;
pub mod storage;
mod store;
mod sync;

// Types in the signatures of the functions of `Node`.
pub use od_wire::emcy::Emcy;
pub use od_wire::time_of_day::TimeOfDay;
pub use od_wire::{AbortCode, CanId, CobId, Duration, Frame, Instant, NodeId};

pub use application::{
    Application, ChangeKind, Chunk, Context, Halt, NoApplication, Pin, PinKind, Reset, Signals,
    Stream, StreamEnd,
};
pub use device::Device;
#[cfg(feature = "std")]
pub use kind::DeviceKind;
pub use node::{BusEvent, Event, Node};
pub use profile::{
    BusOffProfile, CommunicationReset, CutSave, ErrorProfile, ErrorReset, EventTimer, LengthRule,
    LssProfile, NmtProfile, Notice, PdoProfile, Profile, Restore, SaveAnswer, SavedCobIds,
    SdoProfile, StoreProfile,
};
pub use services::Services;
pub use store::{Store, StoreTooSmall, TextTooLong};
