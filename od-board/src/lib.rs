//! A CANopen node on a board: what a firmware needs besides the node itself.
//!
//! - [`Board`] owns node, values, application and storage, and can be a `static`.
//! - [`Port`] connects it to a CAN controller with the traits of `embedded-can`, nb or blocking.
//! - `Shared` (feature `embassy`) is a node for several tasks, and the task that runs it.
//! - [`Filters`] are the acceptance filters for the CAN-IDs that the node listens to.
//! - [`storage`] keeps saved values on NOR flash, in the background or at once.
//! - [`Clock`] is time of a counter of 32 bits that wraps.
#![no_std]
#![forbid(unsafe_code)]

#[cfg(test)]
extern crate std;

mod board;
mod clock;
mod filters;
mod owner;
mod port;
#[cfg(feature = "embassy")]
mod shared;
pub mod storage;

pub use board::{Board, Plain};
pub use clock::Clock;
pub use filters::{Filter, Filters};
pub use owner::Owner;
pub use port::Port;
#[cfg(feature = "embassy")]
pub use shared::{Receive, Shared, Transmit};

pub use od_wire as wire;
