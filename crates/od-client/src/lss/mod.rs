//! LSS master (CiA 305): node ID and bit rate of a device that may have neither.

mod fastscan;
mod master;
mod task;

pub use master::{Busy, Master, Options};
pub use od_wire::lss::Part;
pub use task::{Answer, Identity, Task};
