//! The bench in real time: its clock, its sockets, its clients. Feature `serve`.
//!
//! [`main`] is the `main` of a crate with a device of its own; [`run`] is for programs that read
//! their arguments themselves.

mod client;
mod clients;
mod commands;
mod control;
mod device_events;
mod door;
mod error;
mod events;
pub mod files;
mod fleet;
mod greeting;
mod hint;
mod http;
pub mod links;
mod live;
mod log;
pub mod options;
mod outbox;
mod pace;
mod process;
mod program;
mod ready;
mod run;
pub mod running;
mod stats;
mod terminal;

pub use control::address::ControlAddress;
pub use error::Error;
pub use fleet::{Make, Maker};
pub use links::Link;
pub use options::Options;
pub use program::main;
pub use run::run;
