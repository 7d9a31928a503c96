//! One dependency for a CANopen device: dictionary, macro, node.
//!
//! [`object_dictionary!`] makes a typed, `const` [`Dictionary`] of an EDS file or of rows in the
//! source. A [`Node`] runs it, sans-io: it receives frames and the time, and returns frames, the next
//! deadline and events.
//!
//! ```
//! use odkit::storage::Memory;
//! use odkit::{Frame, Instant, Lent, NoApplication, NodeId, Profile};
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
//! let mut values = [0; thermometer::STORE_LEN];
//! let mut application = NoApplication;
//! let mut storage = Memory::new([0xFF; 256]);
//! let mut device = Lent {
//!     dictionary: thermometer::DICTIONARY,
//!     values: &mut values,
//!     application: &mut application,
//!     storage: &mut storage,
//!     profile: Some(&Profile::CIA301),
//! };
//! let mut node = thermometer::Node::new(NodeId::ONE);
//! let now = Instant::ZERO;
//! node.power_on(&mut device, now)?;
//! assert_eq!(node.poll_transmit(&mut device, now).unwrap().to_string(), "701#00");
//!
//! let request = Frame::standard(0x601, &[0x40, 0x00, 0x20, 0, 0, 0, 0, 0]);
//! node.handle_frame(&mut device, now, &request);
//! let response = node.poll_transmit(&mut device, now).unwrap();
//! assert_eq!(response.to_string(), "581#4B002000D7000000");
//! # Ok::<(), odkit::Unfit>(())
//! ```
//!
//! The crates behind this one are public, too: `od-model` (dictionary), `od-wire` (frames and
//! their bytes), `od-runtime` (node and encoder). A device needs only this one.
#![no_std]
#![forbid(unsafe_code)]

#[doc(inline)]
pub use od_board as board;
pub use od_macros::object_dictionary;
pub use od_model::{
    Access, Address, DataType, Dictionary, Entry, Group, Kind, Literal, Missing, Object,
    ObjectCode, Slot, typed,
};
pub use od_runtime::{
    AbortCode, AnyDevice, Application, BusEvent, BusOffProfile, CanId, Chunk, Clocks, CobId,
    CommunicationReset, Context, CutSave, Device, DeviceKind, Duration, Emcy, ErrorProfile,
    ErrorReset, Event, Extra, Extras, Frame, FullRooms, Halt, Instant, LengthRule, Lent,
    LssProfile, NmtProfile, NoApplication, Node, NodeId, Notice, Only, PdoProfile, Profile, Reset,
    Restore, Rooms, SaveAnswer, SavedCobIds, SdoProfile, SdoServer, Signals, Store, StoreProfile,
    StoreTooSmall, Stream, StreamEnd, TextTooLong, TimeOfDay, Unfit, encoder, program, rooms,
    storage,
};
pub use od_wire::{emcy, lss, nmt, sdo};

/// The paths that [`object_dictionary!`] emits; not an API. The number changes with the shape of
/// the emitted code, so that a macro and a crate of different versions fail at this name.
#[doc(hidden)]
pub mod __private4 {
    pub use od_board::Board;
    pub use od_model::Dictionary;
    pub use od_model::typed::emit::*;
    pub use od_runtime::storage::NoStorage;
    pub use od_runtime::{Device, Extra, NoApplication, Node, Only, Profile, rooms};
}
