//! Client side of a CANopen bus, with I/O, for programs that look at devices.
//!
//! [`link::Link`] is a bus with a clock of its own, in real or in virtual time;
//! [`master::Master`] waits for answers on it; [`conform`] is the open conformance test, [`learn`] makes an EDS of a node.

pub mod bench;
pub mod compare;
pub mod configure;
pub mod conform;
mod error;
pub mod filter;
pub mod interrupt;
pub mod learn;
pub mod link;
pub mod links;
pub mod lss;
pub mod master;
pub mod nmt;
pub mod objects;
pub mod replay;
pub mod scan;
pub mod tap;
pub mod watch;

pub use error::Error;
