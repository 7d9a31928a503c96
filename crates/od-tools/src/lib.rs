//! Client side of a CANopen bus, with I/O: what the commands of odkit do at a bus.
//!
//! [`link::Link`] is a bus with a clock of its own, in real or in virtual time;
//! [`master::Master`] waits for responses on it; [`conform`] is the conformance test, [`learn`] makes an EDS from a node.

pub mod bench;
pub mod compare;
pub mod configure;
pub mod conform;
mod error;
pub mod filter;
pub mod interrupt;
pub mod junit;
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
pub mod tpdos;
pub mod watch;

pub use error::Error;
