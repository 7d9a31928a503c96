//! One dependency for a CANopen device: dictionary, macro, node.
//!
//! [`object_dictionary!`] makes a typed, `const` [`Dictionary`] of an EDS file or of rows in the
//! source. A [`Node`] runs it, sans-io: it receives frames and the time, and returns frames, the next
//! deadline and events.
//!
//! ```
//! use odkit::storage::NoStorage;
//! use odkit::{Frame, Instant, NoApplication, Node, NodeId};
//!
//! odkit::object_dictionary! {
//!     /// A thermometer.
//!     mod thermometer {
//!         add 0x1000 { name = "Device type"; type = u32; access = const; default = 0 }
//!         add 0x1001 { name = "Error register"; type = u8 }
//!         add 0x1018 { code = record; name = "Identity object" }
//!         add 0x1018sub1 { name = "Vendor-ID"; type = u32; default = 0x5F }
//!         add 0x2000 { name = "Temperature"; type = i16; default = 215 }
//!     }
//! }
//!
//! let mut node = Node::new(thermometer::Device, NodeId::ONE, NoApplication, NoStorage);
//! let now = Instant::ZERO;
//! node.power_on(now);
//! assert_eq!(node.poll_transmit(now).unwrap().to_string(), "701#00");
//!
//! let request = Frame::standard(0x601, &[0x40, 0x00, 0x20, 0, 0, 0, 0, 0]);
//! node.handle_frame(now, &request);
//! let response = node.poll_transmit(now).unwrap();
//! assert_eq!(response.to_string(), "581#4B002000D7000000");
//! ```
//!
//! The crates below this one are public, too: `od-model` (dictionary), `od-wire` (frames and their
//! bytes), `od-runtime` (node and encoder). A device needs only this one.
#![no_std]
#![forbid(unsafe_code)]
#![cfg_attr(docsrs, feature(doc_cfg))]

#[doc(inline)]
pub use od_board as board;
pub use od_macros::object_dictionary;
pub use od_model::{
    Access, Address, DataType, Dictionary, Entry, Group, Kind, Literal, Missing, Object,
    ObjectCode, Slot, typed,
};
pub use od_runtime::{
    AbortCode, Application, BusEvent, BusOffProfile, CanId, ChangeKind, Chunk, CobId,
    CommunicationReset, Context, CutSave, Device, Duration, Emcy, ErrorProfile, ErrorReset, Event,
    EventTimer, Frame, Halt, Instant, LengthRule, LssProfile, NmtProfile, NoApplication, Node,
    NodeId, Notice, PdoProfile, Pin, PinKind, Profile, Reset, Restore, SaveAnswer, SavedCobIds,
    SdoProfile, Services, Signals, Store, StoreProfile, StoreTooSmall, Stream, StreamEnd,
    TextTooLong, TimeOfDay, encoder, program, rooms, storage,
};
#[cfg(feature = "std")]
pub use od_runtime::{DeviceKind, kind};
pub use od_wire::{emcy, lss, nmt, sdo};

/// The paths that [`object_dictionary!`] emits; not an API. The number changes with the emitted
/// code, so that a macro and a crate of different versions give an error with this name.
#[doc(hidden)]
pub mod __private8 {
    pub use od_model::typed::emit::*;
    pub use od_model::{Address, Dictionary};
    pub use od_runtime::rooms::{Rooms, Values};
    pub use od_runtime::storage::NoStorage;
    pub use od_runtime::{Device, NoApplication, Node, Profile, Services, rooms};
}
