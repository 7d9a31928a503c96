//! A CANopen slave node and a CiA 406 encoder, sans-io.
//!
//! Frames and virtual time go in, frames, the next deadline and events come out.
//! No clock, no thread, no allocation, no `unsafe`, and no input that panics.
#![no_std]
#![forbid(unsafe_code)]

#[cfg(any(feature = "std", test))]
extern crate std;

mod abort;
mod application;
mod emcy;
pub mod encoder;
mod error_control;
mod fifo;
mod frame;
mod ids;
mod lss;
mod node;
mod objects;
mod pdo;
mod profile;
mod sdo;
pub mod storage;
mod store;
mod time;
pub mod wire;

pub use abort::AbortCode;
pub use application::{Application, Context, NoApplication, Reset, Signals};
pub use emcy::{Change as ErrorChange, Error};
pub use frame::{CanId, Frame};
pub use ids::{CobId, NodeId};
pub use node::{Event, Node};
pub use objects::Device;
pub use profile::{LengthRule, LssProfile, PdoProfile, Profile, Restore, SdoProfile, StoreProfile};
pub use sdo::crc16;
pub use store::{Store, StoreTooSmall, TextTooLong};
pub use time::{Duration, Instant};
