//! Recorded behaviour that a simulated device repeats: its responses, times and errors.
//!
//! It is stored in comments at the end of an EDS, so that every tool can still read the file:
//!
//! ```text
//! ;odkit-twin=1
//! ;twin length 10s
//! ;twin answer 400us
//! ;twin boot-up 1200ms
//! ;twin heartbeat 990ms
//! ;twin tpdo 1 50ms
//! ;twin emcy 20ms 1000h 01h 00 00 00 00 00
//! ;twin without segments blocks
//! ;twin abort 2100h:01 08000022h
//! ;twin empty 1003h:01 00 00 00 00
//! ;twin value 6004h:00 100ms 12 00 00 00
//! ```
//!
//! | line | meaning |
//! |---|---|
//! | `;odkit-twin=1` | version of the format; the others follow |
//! | `length TIME` | length of the recording; the values begin again after it |
//! | `answer TIME` | from an SDO request to its response |
//! | `boot-up TIME` | from NMT reset node to the boot-up message |
//! | `heartbeat TIME`, `tpdo NUMBER TIME` | measured period, if it differs from the configured one |
//! | `emcy TIME CODE REGISTER BYTES` | an error, with its time after the boot-up message |
//! | `without segments blocks` | SDO downloads in segments, or block transfers, are refused |
//! | `empty OBJECT BYTES` | the value, 1 to 4 bytes, while no data is available (08000024h) |
//! | `abort OBJECT CODE` | a read is refused with this SDO abort code |
//! | `value OBJECT TIME BYTES` | the value, with its time after the boot-up message |

mod device;
mod pace;
pub(crate) mod play;
mod read;

use std::collections::BTreeMap;
use std::fmt;
use std::prelude::v1::*;

use od_model::{Address, values};
use od_wire::emcy::Emcy;

pub use read::read;

use crate::grammar::duration::duration;

/// Version of the format that this odkit writes and reads.
pub const VERSION: u32 = 1;
/// Limit of lines that [`read`] accepts.
pub const LINES: usize = 20_000;
/// Limit of bytes of a recorded value.
pub const BYTES: usize = 1_024;
/// Longest recorded time, in microseconds: an hour.
pub const LONGEST: u64 = 3_600_000_000;

/// Recorded behaviour of a device. Times are in microseconds.
#[derive(Clone, PartialEq, Eq, Debug, Default)]
pub struct Recorded {
    /// Length of the recording; the values begin again after it.
    pub length: u64,
    /// From an SDO request to its response.
    pub answer: u64,
    /// From NMT reset node to the boot-up message; `None` if it was not measured.
    pub boot_up: Option<u64>,
    /// Measured period of the heartbeat.
    pub heartbeat: Option<u64>,
    /// Measured periods of TPDOs, by their number from 1 on.
    pub tpdos: BTreeMap<u16, u64>,
    /// Errors after the boot-up message.
    pub errors: Vec<(u64, Emcy)>,
    /// Whether SDO downloads in segments are refused.
    pub no_segments: bool,
    /// Whether SDO block transfers are refused.
    pub no_blocks: bool,
    /// Values in place of the SDO abort 08000024h (no data), of 1 to 4 bytes.
    pub empty: BTreeMap<Address, Vec<u8>>,
    /// Reads that are refused, with the SDO abort code.
    pub aborts: BTreeMap<Address, u32>,
    /// Values that change: time, object, value.
    pub values: Vec<(u64, Address, Vec<u8>)>,
}

impl fmt::Display for Recorded {
    /// The lines in the form of an EDS.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(f, ";odkit-twin={VERSION}")?;
        writeln!(f, ";twin length {}", duration(self.length))?;
        writeln!(f, ";twin answer {}", duration(self.answer))?;
        if let Some(boot_up) = self.boot_up {
            writeln!(f, ";twin boot-up {}", duration(boot_up))?;
        }
        if let Some(period) = self.heartbeat {
            writeln!(f, ";twin heartbeat {}", duration(period))?;
        }
        for (number, period) in &self.tpdos {
            writeln!(f, ";twin tpdo {number} {}", duration(*period))?;
        }
        for (at, error) in &self.errors {
            let (code, register) = (error.code, error.register);
            let info = values::hex(&error.info);
            writeln!(
                f,
                ";twin emcy {} {code:04X}h {register:02X}h {info}",
                duration(*at)
            )?;
        }
        if self.no_segments || self.no_blocks {
            let segments = if self.no_segments { " segments" } else { "" };
            let blocks = if self.no_blocks { " blocks" } else { "" };
            writeln!(f, ";twin without{segments}{blocks}")?;
        }
        for (address, bytes) in &self.empty {
            let (object, bytes) = (full(*address), values::hex(bytes));
            writeln!(f, ";twin empty {object} {bytes}")?;
        }
        for (address, code) in &self.aborts {
            writeln!(f, ";twin abort {} {code:08X}h", full(*address))?;
        }
        for (at, address, bytes) in &self.values {
            let (object, bytes) = (full(*address), values::hex(bytes));
            writeln!(f, ";twin value {object} {} {bytes}", duration(*at))?;
        }
        Ok(())
    }
}

/// An object with its sub-index, including 0.
fn full(Address { index, sub }: Address) -> String {
    format!("{index:04X}h:{sub:02X}")
}
