//! pcap files with frames of SocketCAN, as tcpdump and Wireshark write them.

use std::prelude::v1::*;

use od_wire::{CanId, Frame, Instant};

use super::channel::Channels;
use super::record::{BusError, ERROR, EXTENDED, Entry, FD, REMOTE, Record, Unread};

/// The link type of SocketCAN frames in a capture.
pub(super) const LINK: u16 = 227;
/// Link types of a capture on all interfaces: a header of Linux, then the frame.
const COOKED: u16 = 113;
const COOKED_2: u16 = 276;
/// Protocols in these headers.
const CAN: u16 = 0x000C;
const CAN_FD: u16 = 0x000D;
/// Type of a packet in these headers: sent by this computer.
const OUTGOING: u8 = 4;

/// Message for a capture without CAN frames.
const OTHER_LINK: &str = "its frames are not SocketCAN frames (link type 227; of a capture on all interfaces 113 or 276)";

fn is_can(link: u16) -> bool {
    matches!(link, LINK | COOKED | COOKED_2)
}

/// Content of a capture.
#[derive(Default)]
pub(super) struct Capture {
    /// Records, each with the number of its channel.
    pub(super) records: Vec<(Record, u8)>,
    pub(super) skipped: Vec<Unread>,
    /// Packets of other protocols.
    pub(super) others: usize,
    pub(super) channels: Channels,
    /// Packets so far.
    count: u32,
}

impl Capture {
    /// Counts the next packet.
    pub(super) fn begin(&mut self) {
        self.count = self.count.saturating_add(1);
    }

    /// Adds a packet of an interface with this link type and name.
    pub(super) fn packet(&mut self, at: Instant, link: u16, name: &str, bytes: &[u8]) {
        self.begin();
        let half = |at: usize| Some(u16::from_be_bytes(bytes.get(at..at + 2)?.try_into().ok()?));
        let (protocol, sent, start) = match link {
            LINK => (Some(CAN), false, 0),
            COOKED => (half(14), half(0) == Some(OUTGOING.into()), 16),
            COOKED_2 => (half(0), bytes.get(10) == Some(&OUTGOING), 20),
            _ => (None, false, 0),
        };
        let frame = bytes.get(start..).unwrap_or_default();
        match protocol {
            Some(CAN) if !is_fd(frame) => match socketcan(at, frame) {
                Some(Entry::Record(record)) => {
                    // A capture on all interfaces has the number of the interface in this header.
                    let own = bytes.get(4..8).filter(|_| link == COOKED_2);
                    let own = own.map(|number| {
                        number
                            .iter()
                            .fold(0, |all, byte| all << 8 | u32::from(*byte))
                    });
                    match own {
                        Some(number) => self.add(record.sent(sent), &number.to_string()),
                        None => self.add(record.sent(sent), name),
                    }
                }
                Some(_) => self.others += 1,
                None => self.skip("it is too short for a CAN frame".into()),
            },
            Some(CAN | CAN_FD) => self.skip(FD.into()),
            _ => self.others += 1,
        }
    }

    /// Adds a record of the channel with this name.
    pub(super) fn add(&mut self, record: Record, channel: &str) {
        let number = self.channels.number(channel);
        self.records.push((record, number));
    }

    /// Notes that the current packet cannot be read.
    pub(super) fn skip(&mut self, why: String) {
        self.skipped.push(Unread {
            line: self.count.max(1),
            is_frame: true,
            why,
        });
    }

    /// Ends the capture. It is an error if it has no CAN frame at all.
    pub(super) fn finish(mut self, cut: Option<String>) -> Result<Self, String> {
        match cut {
            Some(why) if self.records.is_empty() => return Err(why),
            Some(why) => self.skip(why),
            None => {}
        }
        if self.records.is_empty() && self.skipped.is_empty() && self.others > 0 {
            return Err(OTHER_LINK.into());
        }
        Ok(self)
    }
}

/// Length of the largest CAN FD frame with its head.
const FD_FRAME: usize = 72;
/// Flag of a CAN FD frame, beside its length.
const FLAG_FD: u8 = 4;

fn is_fd(bytes: &[u8]) -> bool {
    let is_long = bytes.len() == FD_FRAME || bytes.get(4).is_some_and(|length| *length > 8);
    is_long || bytes.get(5).is_some_and(|flags| flags & FLAG_FD != 0)
}

/// A file, little or big endian.
#[derive(Clone, Copy)]
pub(super) struct File<'b> {
    pub(super) bytes: &'b [u8],
    pub(super) is_little: bool,
}

impl File<'_> {
    pub(super) fn word(&self, at: usize) -> Option<u32> {
        let bytes: [u8; 4] = self.bytes.get(at..at.checked_add(4)?)?.try_into().ok()?;
        Some(if self.is_little {
            u32::from_le_bytes(bytes)
        } else {
            u32::from_be_bytes(bytes)
        })
    }

    pub(super) fn half(&self, at: usize) -> Option<u16> {
        let bytes: [u8; 2] = self.bytes.get(at..at.checked_add(2)?)?.try_into().ok()?;
        Some(if self.is_little {
            u16::from_le_bytes(bytes)
        } else {
            u16::from_be_bytes(bytes)
        })
    }
}

/// The records of a pcap file; `None` if the bytes are not one.
pub(super) fn read(bytes: &[u8]) -> Option<Result<Capture, String>> {
    let magic = u32::from_le_bytes(bytes.get(..4)?.try_into().ok()?);
    let (is_little, nanos) = match magic {
        0xA1B2_C3D4 => (true, false),
        0xA1B2_3C4D => (true, true),
        0xD4C3_B2A1 => (false, false),
        0x4D3C_B2A1 => (false, true),
        _ => return None,
    };
    let file = File { bytes, is_little };
    // The upper half has other bits.
    let link = file.word(20).map(|link| (link & 0xFFFF) as u16);
    Some(match link.filter(|link| is_can(*link)) {
        Some(link) => records(file, nanos, link),
        None => Err(OTHER_LINK.into()),
    })
}

fn records(file: File<'_>, nanos: bool, link: u16) -> Result<Capture, String> {
    let mut capture = Capture::default();
    let mut at = 24;
    while let (Some(seconds), Some(fraction), Some(length), Some(_)) = (
        file.word(at),
        file.word(at + 4),
        file.word(at + 8),
        file.word(at + 12),
    ) {
        let data = at + 16;
        let end = data.saturating_add(length as usize);
        let Some(bytes) = file.bytes.get(data..end) else {
            let cut = format!("it ends in the middle of a frame, at byte {at}");
            return capture.finish(Some(cut));
        };
        let micros = u64::from(fraction) / if nanos { 1000 } else { 1 };
        let time = Instant::from_micros(u64::from(seconds) * 1_000_000 + micros);
        capture.packet(time, link, "", bytes);
        at = end;
    }
    capture.finish(None)
}

/// One frame of a capture: CAN-ID with flags, big endian, then length and data.
fn socketcan(at: Instant, bytes: &[u8]) -> Option<Entry> {
    let raw = u32::from_be_bytes(bytes.get(..4)?.try_into().ok()?);
    let dlc = (*bytes.get(4)?).min(8);
    let data = bytes.get(8..)?;
    if raw & ERROR != 0 {
        let error = BusError::of_socketcan(raw, data.get(..8)?.try_into().ok()?);
        return Some(match error {
            Some(error) => Entry::Record(Record::of(at, error)),
            None => Entry::Other,
        });
    }
    let id = if raw & EXTENDED != 0 {
        CanId::extended(raw & 0x1FFF_FFFF)
    } else {
        CanId::standard((raw & 0x7FF) as u16)
    };
    let frame = if raw & REMOTE != 0 {
        Frame::remote(id, dlc)
    } else {
        Frame::new(id, &data[..data.len().min(usize::from(dlc))])
    };
    Some(Entry::Record(Record::received(at, frame?)))
}
