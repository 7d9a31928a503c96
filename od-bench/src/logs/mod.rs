//! Logs of a bus: what candump, Vector, PEAK and Wireshark write, read and written.
//!
//! [`read`] takes the bytes of a file and finds out which it is; [`Format::write`] makes one.

mod asc;
pub mod candump;
mod foreign;
mod pcap;
mod pcapng;
mod read;
mod record;
pub(crate) mod stamp;
mod trc;
mod write;

pub use read::{Log, Problem, read};
pub use record::{Record, What};
pub use write::Format;
