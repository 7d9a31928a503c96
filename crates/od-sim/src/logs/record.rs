//! A record of a log: a frame or an error of the bus, with its time.

use std::fmt;
use std::prelude::v1::*;

use od_wire::{CanId, Frame, Instant};

/// Entry of a log.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct Record {
    /// Time from the beginning of the log.
    pub at: Instant,
    /// Sent by the writer of the log (Tx); otherwise received.
    pub sent: bool,
    /// Frame or error frame.
    pub what: What,
}

/// Frame or error frame on the bus.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum What {
    /// A frame.
    Frame(Frame),
    /// An error.
    Error(BusError),
}

/// An error that an adapter reports. Only a log of SocketCAN says which one it is; in any other log it is an error frame.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Debug)]
pub enum BusError {
    /// An error frame.
    Frame,
    /// No node acknowledged a frame of the adapter.
    NoAcknowledge,
    /// The adapter has counted 96 errors.
    Warning,
    /// The adapter has counted 128 errors: it is error passive.
    Passive,
    /// The adapter has counted 256 errors: it is bus-off, and sends and receives nothing.
    BusOff,
}

impl BusError {
    /// The error in a few words.
    pub const fn text(self) -> &'static str {
        match self {
            Self::Frame => "error frame",
            Self::NoAcknowledge => "error frame: no acknowledge",
            Self::Warning => "the adapter has counted 96 errors",
            Self::Passive => "the adapter is error passive",
            Self::BusOff => "the adapter is bus-off",
        }
    }

    /// Returns whether a frame was destroyed; otherwise only the state of the adapter has changed.
    pub(crate) const fn is_frame(self) -> bool {
        matches!(self, Self::Frame | Self::NoAcknowledge)
    }

    /// Reads an error message of SocketCAN: the classes in its CAN-ID, and eight bytes (`linux/can/error.h`). Events that are
    /// no error have none: lost arbitration, a restart, a full buffer.
    pub(super) const fn of_socketcan(id: u32, data: [u8; 8]) -> Option<Self> {
        const ACKNOWLEDGE_SLOT: u8 = 0x19;
        let [_, state, _, place, ..] = data;
        Some(match id {
            _ if id & 0x040 != 0 => Self::BusOff,
            _ if id & 0x020 != 0 || id & 0x008 != 0 && place == ACKNOWLEDGE_SLOT => {
                Self::NoAcknowledge
            }
            _ if id & 0x098 != 0 => Self::Frame,
            _ if id & 0x004 != 0 && state & 0x30 != 0 => Self::Passive,
            _ if id & 0x004 != 0 && state & 0x0C != 0 => Self::Warning,
            _ => return None,
        })
    }

    /// The classes and the bytes of its message of SocketCAN.
    pub(super) const fn socketcan(self) -> (u32, [u8; 8]) {
        match self {
            Self::Frame => (0x008, [0, 0, 4, 0, 0, 0, 0, 0]),
            Self::NoAcknowledge => (0x020, [0; 8]),
            Self::Warning => (0x004, [0, 0x0C, 0, 0, 0, 0, 0, 0]),
            Self::Passive => (0x004, [0, 0x30, 0, 0, 0, 0, 0, 0]),
            Self::BusOff => (0x040, [0; 8]),
        }
    }
}

impl Record {
    pub(super) const fn received(at: Instant, frame: Frame) -> Self {
        Self {
            at,
            sent: false,
            what: What::Frame(frame),
        }
    }

    /// An error frame.
    pub(super) const fn error(at: Instant) -> Self {
        Self::of(at, BusError::Frame)
    }

    /// An error.
    pub(super) const fn of(at: Instant, error: BusError) -> Self {
        Self {
            at,
            sent: false,
            what: What::Error(error),
        }
    }

    pub(super) const fn sent(mut self, sent: bool) -> Self {
        self.sent = sent;
        self
    }
}

/// Bit 29 of a CAN-ID of SocketCAN: an error frame.
pub(super) const ERROR: u32 = 1 << 29;
/// Bit 30: a remote frame.
pub(super) const REMOTE: u32 = 1 << 30;
/// Bit 31: a CAN-ID of 29 bits.
pub(super) const EXTENDED: u32 = 1 << 31;

/// Reads a CAN-ID from these digits, if it fits into 11 or 29 bits.
pub(super) fn id(digits: &str, radix: u32, extended: bool) -> Result<CanId, String> {
    let raw = u32::from_str_radix(digits, radix)
        .map_err(|_| format!("`{digits}` is not a valid CAN-ID"))?;
    match extended {
        true if raw <= 0x1FFF_FFFF => Ok(CanId::extended(raw)),
        false if raw <= 0x7FF => Ok(CanId::standard(raw as u16)),
        _ => Err(format!("the CAN-ID {digits} is too large")),
    }
}

/// Reads a frame whose bytes are separate words in base `radix`, 10 or 16; a remote frame has none.
pub(super) fn frame<'w>(
    id: CanId,
    dlc: u8,
    remote: bool,
    words: impl Iterator<Item = &'w str>,
    radix: u32,
) -> Result<Frame, String> {
    if remote {
        return Frame::remote(id, dlc).ok_or_else(|| too_long(dlc));
    }
    let mut data = [0; 8];
    let room = data
        .get_mut(..usize::from(dlc))
        .ok_or_else(|| too_long(dlc))?;
    let mut words = words;
    for byte in room {
        let word = words.next().unwrap_or_default();
        *byte = u8::from_str_radix(word, radix)
            .ok()
            .filter(|_| word.len() <= 3)
            .ok_or_else(|| format!("the data is not {dlc} bytes"))?;
    }
    Ok(Frame::with_dlc(id, data, dlc))
}

/// Fields between commas, semicolons or tabulators, without their quotes.
pub(super) fn fields(line: &str) -> impl Iterator<Item = &str> {
    let separator = [';', '\t'].into_iter().find(|one| line.contains(*one));
    line.split(separator.unwrap_or(','))
        .map(|field| field.trim().trim_matches('"'))
}

/// Bases of CAN-ID and data, by the settings at the head of a log of Kvaser: `Format of id field: DEC`.
pub(super) fn bases(lines: &[&str]) -> [u32; 2] {
    ["id", "data"].map(|field| {
        let name = format!("Format of {field} field:");
        let mut settings = lines.iter().filter_map(|line| line.split_once(&*name));
        match settings.next() {
            Some((_, base)) if base.contains("DEC") => 10,
            _ => 16,
        }
    })
}

fn too_long(dlc: u8) -> String {
    format!("the length {dlc} is more than 8")
}

/// Content of a line.
pub(super) enum Entry {
    /// A frame or an error frame.
    Record(Record),
    /// An event that is not a frame: a change of the controller's state, a request to send.
    Other,
    /// A comment or a header.
    Nothing,
}

/// Reads one line, or says what is wrong with it.
pub(super) type Reader<'t> = Box<dyn FnMut(&'t str) -> Result<Entry, String> + 't>;

/// Message for a CAN FD frame.
pub(super) const FD: &str = "it is a CAN FD frame, and CANopen does not use CAN FD";

/// A line of a text, or a frame of a capture, that could not be read.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct Unread {
    /// Number of the line, or of the frame, from 1.
    pub line: u32,
    /// Whether it is a frame of a capture.
    pub is_frame: bool,
    /// The problem.
    pub why: String,
}

impl fmt::Display for Unread {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let unit = if self.is_frame { "frame" } else { "line" };
        write!(f, "{unit} {}: {}", self.line, self.why)
    }
}
