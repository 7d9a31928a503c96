//! The bench in real time: its clock, its sockets, its threads. Feature `serve`.
//!
//! [`main`] is the `main` of a crate with a device of its own; [`run`] is for programs that read
//! their arguments themselves.

mod client;
mod failure;
mod fleet;
mod greeting;
pub mod links;
mod live;
mod maker;
pub mod options;
mod program;
mod run;
mod terminal;
mod threads;

pub use failure::Failure;
pub use links::Link;
pub use maker::{Make, Maker};
pub use options::Options;
pub use program::main;
pub use run::run;
