//! The other end of a bus: a client of nodes on a bench, on a bus of python-can, or on a real link.

mod arguments;
pub(crate) mod calls;
pub(crate) mod conform;
mod core;
pub(crate) mod errors;
pub(crate) mod heard;
mod known;
mod link;
pub(crate) mod node;
mod on_bus;
mod on_wire;
