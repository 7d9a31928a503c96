//! The virtual bench: devices in virtual time, their bus, candump text, frames in plain
//! words, scenario scripts, and what adapters and daemons speak.
//!
//! Like the runtime it has no clock, thread, socket or file of its own; what it needs from
//! outside comes in as an argument. So the same bench runs behind `odkit`, in a test and in
//! a browser's worker. Clock, threads and sockets are in `serve` only (feature `serve`), which
//! runs a bench in real time.

#![forbid(unsafe_code)]

mod behaviour;
mod bench;
#[cfg(feature = "eds")]
mod beside;
pub mod bus;
#[cfg(feature = "eds")]
mod clock;
mod compiled;
#[cfg(feature = "eds")]
mod configured;
mod cursor;
#[cfg(feature = "real")]
mod described;
mod device;
mod eeprom;
pub mod faults;
mod forward;
pub mod grammar;
mod identity;
pub mod journal;
#[cfg(feature = "real")]
mod knowledge;
mod leds;
#[cfg(feature = "eds")]
mod left_out;
pub mod lesson;
pub mod links;
#[cfg(feature = "eds")]
mod loaded;
pub mod logs;
pub mod notice;
mod own;
pub mod pdos;
mod plain;
#[cfg(feature = "eds")]
mod programs;
#[cfg(feature = "serve")]
pub mod recorded;
pub mod rig;
mod saved;
pub mod script;
mod sdo;
#[cfg(feature = "serve")]
pub mod serve;
mod services;
pub mod shaft;
pub mod signal;
mod size;
mod source;
pub mod stats;
#[cfg(all(test, feature = "eds"))]
mod tests;
pub mod twin;
mod view;
pub mod wire;
mod wiring;
pub mod words;
mod world;

pub use bus::Bus;
pub use device::VirtualDevice;
pub use leds::Led;
#[cfg(feature = "eds")]
pub use loaded::EdsOptions;
pub use od_model::Refused;
pub use saved::{Saved, is_saved};
pub use services::Services;
pub use wire::Line;
pub use world::ShaftView;
