//! One record of a log.

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
    /// An error frame.
    Error,
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
        Self {
            at,
            sent: false,
            what: What::Error,
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
