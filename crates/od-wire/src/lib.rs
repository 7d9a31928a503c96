//! CANopen frames and their meaning, for both ends of the bus.
//!
//! [`Frame`], [`CanId`], [`NodeId`] and [`CobId`] hold valid values only; [`Instant`] and
//! [`Duration`] are virtual time; [`AbortCode`] is the reason of an SDO abort. Each service has one
//! module that converts bytes to a type and back. This crate has no state.
//!
//! ```
//! use od_wire::{AbortCode, Frame, NodeId, sdo};
//!
//! let response = Frame::standard(0x581, &[0x80, 0x00, 0x20, 0x00, 0x00, 0x00, 0x02, 0x06]);
//! assert_eq!(response.id(), NodeId::ONE.plus(0x580));
//! let Some(data) = response.data().first_chunk() else { unreachable!() };
//! let sdo::Response::Abort { code, .. } = sdo::Response::parse(data) else { unreachable!() };
//! assert_eq!(code, AbortCode::NoObject.code());
//! ```
#![no_std]
#![forbid(unsafe_code)]
#![cfg_attr(docsrs, feature(doc_cfg))]

#[cfg(test)]
extern crate std;

mod abort;
pub mod emcy;
mod frame;
mod ids;
#[cfg(feature = "defmt")]
mod log;
pub mod lss;
pub mod nmt;
pub mod sdo;
mod time;
pub mod time_of_day;

pub use abort::{AbortCode, AbortReason};
pub use frame::{CanId, Frame};
pub use ids::{CobId, NodeId};
pub use time::{Duration, Instant};
