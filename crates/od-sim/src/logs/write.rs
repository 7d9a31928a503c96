//! Writes records in the formats of other tools.

use std::fmt::Write as _;
use std::prelude::v1::*;

use super::record::{ERROR, Record, What};
use super::{asc, candump, pcapng, trc};

/// File format of a log.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
#[non_exhaustive]
pub enum Format {
    /// `candump -L`.
    Candump,
    /// Vector ASC.
    Asc,
    /// PEAK TRC, version 2.1.
    Trc,
    /// pcapng, for Wireshark.
    Pcapng,
}

impl Format {
    /// The format of files with this ending: `log`, `asc`, `trc` or `pcapng`.
    pub fn of_ending(ending: &str) -> Option<Self> {
        Some(match ending {
            "log" => Self::Candump,
            "asc" => Self::Asc,
            "trc" => Self::Trc,
            "pcapng" => Self::Pcapng,
            _ => return None,
        })
    }

    /// Writes the whole file.
    pub fn write(self, records: &[Record]) -> Vec<u8> {
        let mut text = String::new();
        // Writing to a String does not fail.
        let _ = match self {
            Self::Asc => as_asc(&mut text, records),
            Self::Trc => as_trc(&mut text, records),
            Self::Candump | Self::Pcapng => {
                let mut out = self.head();
                records.iter().for_each(|record| self.add(&mut out, record));
                return out;
            }
        };
        text.into_bytes()
    }

    /// The name of the format, for messages.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Candump => "candump",
            Self::Asc => "ASC",
            Self::Trc => "TRC",
            Self::Pcapng => "pcapng",
        }
    }

    /// Returns whether these bytes begin like a log of [`add`](Self::add). In a text every complete
    /// line must be a record.
    pub fn recognises(self, head: &[u8]) -> bool {
        if self == Self::Pcapng {
            return head.starts_with(&pcapng::head()[..4]);
        }
        let end = head.iter().rposition(|byte| *byte == b'\n').unwrap_or(0);
        let Ok(text) = std::str::from_utf8(&head[..end]) else {
            return false;
        };
        let mut lines = text.lines().filter(|line| !line.trim().is_empty());
        self == Self::Candump && !text.is_empty() && lines.all(candump::is_record)
    }

    /// Returns whether a file of this format can grow record by record.
    pub const fn grows(self) -> bool {
        matches!(self, Self::Candump | Self::Pcapng)
    }

    /// The beginning of a file that [grows](Self::grows).
    pub fn head(self) -> Vec<u8> {
        match self {
            Self::Pcapng => pcapng::head(),
            _ => Vec::new(),
        }
    }

    /// Length of the complete records in these bytes, which begin with a record.
    pub fn whole(self, bytes: &[u8]) -> usize {
        match self {
            Self::Pcapng => pcapng::whole(bytes),
            _ => bytes
                .iter()
                .rposition(|byte| *byte == b'\n')
                .map_or(0, |at| at + 1),
        }
    }

    /// Adds a record to a file that [grows](Self::grows).
    pub fn add(self, out: &mut Vec<u8>, record: &Record) {
        let at = record.at;
        let line = match record.what {
            _ if self == Self::Pcapng => return pcapng::add(out, record),
            What::Frame(frame) => candump::format_line(at, "can0", &frame),
            What::Error(error) => {
                let (id, data) = error.socketcan();
                let data: String = data.iter().map(|byte| format!("{byte:02X}")).collect();
                format!("({at:?}) can0 {:08X}#{data}", ERROR | id)
            }
        };
        out.extend_from_slice(line.as_bytes());
        out.push(b'\n');
    }
}

/// Bytes with a blank before each.
fn bytes(text: &mut String, data: &[u8]) -> std::fmt::Result {
    data.iter().try_for_each(|byte| write!(text, " {byte:02X}"))
}

const ASC_HEAD: &str = "date Thu Jan 1 12:00:00.000 am 1970
base hex  timestamps absolute
internal events logged
Begin Triggerblock Thu Jan 1 12:00:00.000 am 1970
   0.000000 Start of measurement
";

fn as_asc(text: &mut String, records: &[Record]) -> std::fmt::Result {
    text.push_str(ASC_HEAD);
    for Record { at, sent, what } in records {
        write!(text, "{:>11} ", format!("{at:?}"))?;
        let frame = match what {
            What::Frame(frame) => frame,
            What::Error(error) => {
                match asc::status(*error) {
                    Some(status) => writeln!(text, "CAN 1 Status:{status}")?,
                    None => text.push_str("1  ErrorFrame\n"),
                }
                continue;
            }
        };
        text.push_str("1  ");
        let x = if frame.id().is_extended() { "x" } else { "" };
        let id = format!("{:X}{x}", frame.id().raw());
        let direction = if *sent { "Tx" } else { "Rx" };
        let kind = if frame.is_remote() { 'r' } else { 'd' };
        write!(text, "{id:<15} {direction:<4} {kind} {}", frame.dlc())?;
        bytes(text, frame.data())?;
        text.push('\n');
    }
    text.push_str("End TriggerBlock\n");
    Ok(())
}

const TRC_HEAD: [&str; 8] = [
    ";$FILEVERSION=2.1",
    ";$STARTTIME=25569.0000000000",
    ";$COLUMNS=N,O,T,B,I,d,R,L,D",
    ";",
    ";   Message   Time    Type    ID     Rx/Tx",
    ";   Number    Offset  |  Bus  [hex]  |  Reserved",
    ";   |         [ms]    |  |    |      |  |  Data Length",
    ";---+-- ------+------ +- +- --+----- +- +- +--- +- -- -- -- -- -- -- --",
];

fn as_trc(text: &mut String, records: &[Record]) -> std::fmt::Result {
    for line in TRC_HEAD {
        write!(text, "{line}\r\n")?;
    }
    for (number, Record { at, sent, what }) in (1..).zip(records) {
        let micros = at.as_micros();
        let millis = format!("{}.{:03}", micros / 1000, micros % 1000);
        write!(text, "{number:>7} {millis:>13} ")?;
        let frame = match what {
            What::Frame(frame) => frame,
            What::Error(error) => {
                match trc::status(*error) {
                    Some(status) => {
                        text.push_str("ST 1         - Rx -  4   ");
                        bytes(text, &status.to_be_bytes())?;
                        text.push_str("\r\n");
                    }
                    None => text.push_str("ER 1         - Rx -  5    04 00 08 00 00\r\n"),
                }
                continue;
            }
        };
        let kind = if frame.is_remote() { "RR" } else { "DT" };
        let direction = if *sent { "Tx" } else { "Rx" };
        let width = if frame.id().is_extended() { 8 } else { 4 };
        let id = format!("{:0width$X}", frame.id().raw());
        write!(text, "{kind} 1 {id:>9} {direction} -  {}", frame.dlc())?;
        if !frame.data().is_empty() {
            text.push_str("   ");
            bytes(text, frame.data())?;
        }
        text.push_str("\r\n");
    }
    Ok(())
}

#[cfg(test)]
mod tests;
