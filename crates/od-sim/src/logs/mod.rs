//! Reads and writes the bus logs of candump, Vector, PEAK and Wireshark.
//!
//! [`read`] takes the bytes of a file and detects its format; [`Format::write`] writes one.

mod adapters;
mod asc;
mod blf;
pub mod candump;
mod channel;
mod columns;
mod csv;
mod foreign;
mod joined;
mod pcap;
mod pcapng;
mod read;
mod record;
pub(crate) mod stamp;
mod trc;
mod typed;
mod write;

pub use read::{Log, read};
pub use record::{BusError, Record, Unread, What};
pub use write::Format;
