//! pcap files with frames of SocketCAN, as tcpdump and Wireshark write them.

use std::prelude::v1::*;

use od_wire::{CanId, Frame, Instant};

use super::record::{ERROR, EXTENDED, REMOTE, Record};

/// The link type of SocketCAN frames in a capture.
pub(super) const LINK: u16 = 227;

/// Message for a capture without CAN frames.
pub(super) const OTHER_LINK: &str = "its frames are not SocketCAN frames (link type 227)";

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
pub(super) fn read(bytes: &[u8]) -> Option<Result<Vec<Record>, String>> {
    let magic = u32::from_le_bytes(bytes.get(..4)?.try_into().ok()?);
    let (is_little, nanos) = match magic {
        0xA1B2_C3D4 => (true, false),
        0xA1B2_3C4D => (true, true),
        0xD4C3_B2A1 => (false, false),
        0x4D3C_B2A1 => (false, true),
        _ => return None,
    };
    let file = File { bytes, is_little };
    Some(match file.word(20) {
        Some(link) if link & 0xFFFF == u32::from(LINK) => records(file, nanos),
        _ => Err(OTHER_LINK.into()),
    })
}

fn records(file: File<'_>, nanos: bool) -> Result<Vec<Record>, String> {
    let mut records = Vec::new();
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
            return Err(format!("it ends in the middle of a frame, at byte {at}"));
        };
        let micros = u64::from(fraction) / if nanos { 1000 } else { 1 };
        let time = Instant::from_micros(u64::from(seconds) * 1_000_000 + micros);
        records.extend(socketcan(time, bytes));
        at = end;
    }
    Ok(records)
}

/// One frame of a capture: identifier with flags, big endian, then length and data.
pub(super) fn socketcan(at: Instant, bytes: &[u8]) -> Option<Record> {
    let raw = u32::from_be_bytes(bytes.get(..4)?.try_into().ok()?);
    let dlc = (*bytes.get(4)?).min(8);
    let data = bytes.get(8..)?;
    if raw & ERROR != 0 {
        return Some(Record::error(at));
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
    Some(Record::received(at, frame?))
}
