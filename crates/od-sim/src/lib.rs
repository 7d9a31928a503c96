//! The virtual bench: devices in virtual time, their bus, candump text, frames in plain words,
//! scenario scripts, and the protocols of adapters and daemons.
//!
//! Like the runtime it has no clock, thread, socket or file of its own; they are arguments. So the
//! same bench runs in `odkit`, in a test and in a browser's worker. Clock, threads and sockets
//! are only in `serve` (feature `serve`), which runs a bench in real time.

#![forbid(unsafe_code)]
#![cfg_attr(docsrs, feature(doc_cfg))]

mod bench;
pub mod bus;
mod chance;
mod cursor;
#[cfg(feature = "dbc")]
pub mod dbc;
mod device;
pub mod diagnose;
pub mod faults;
pub mod grammar;
pub mod journal;
pub mod lesson;
pub mod line;
pub mod links;
pub mod logs;
#[cfg_attr(not(feature = "training"), allow(dead_code))]
pub mod master;
#[cfg(feature = "serve")]
pub mod recorded;
pub mod rig;
pub mod script;
mod sdo;
#[cfg(feature = "serve")]
pub mod serve;
pub mod shaft;
pub mod signal;
pub mod stats;
#[cfg(all(test, feature = "eds"))]
mod tests;
pub mod words;

pub use bus::Bus;
pub use device::leds::Led;
#[cfg(feature = "eds")]
pub use device::loaded::EdsOptions;
pub use device::saved::{Saved, is_saved};
pub use device::services::Services;
pub use device::world::ShaftView;
pub use device::{VirtualDevice, notice, pdos, twin};
pub use line::Line;
pub use od_model::Refused;
