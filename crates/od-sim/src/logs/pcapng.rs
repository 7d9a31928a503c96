//! pcapng with frames of SocketCAN, read and written.

use std::prelude::v1::*;

use od_wire::Instant;

use super::pcap::{Capture, File, LINK};
use super::record::{ERROR, EXTENDED, REMOTE, Record, What};

const SECTION: u32 = 0x0A0D_0D0A;
const INTERFACE: u32 = 1;
const PACKET: u32 = 6;
/// Byte-order magic of a section in little endian.
const LITTLE: u32 = 0x1A2B_3C4D;

/// An interface of a section.
struct Interface {
    link: u16,
    /// Ticks per second.
    resolution: f64,
    /// Its name, such as `can0`; without one, its number.
    name: String,
}

/// The records of a pcapng file; `None` if the bytes are not one.
pub(super) fn read(bytes: &[u8]) -> Option<Result<Capture, String>> {
    let file = File {
        bytes,
        is_little: true,
    };
    (file.word(0)? == SECTION).then(|| records(file))
}

fn records(mut file: File<'_>) -> Result<Capture, String> {
    let mut interfaces: Vec<Interface> = Vec::new();
    let mut capture = Capture::default();
    let mut at = 0;
    while at + 12 <= file.bytes.len() {
        if file.word(at) == Some(SECTION) {
            file.is_little = true;
            file.is_little = file.word(at + 8) == Some(LITTLE);
            interfaces.clear();
        }
        let size = file.word(at + 4).unwrap_or(0) as usize;
        let end = at.saturating_add(size);
        if size < 12 || !size.is_multiple_of(4) || end > file.bytes.len() {
            return capture.finish(Some(cut(at)));
        }
        match (file.word(at), file.half(at + 8), file.word(at + 8)) {
            (Some(INTERFACE), Some(link), _) => {
                let option = |code| option(file, code, at + 16, end - 4);
                let name = option(IF_NAME).map(|name| String::from_utf8_lossy(name));
                let name = name.map(|name| name.trim_end_matches('\0').to_owned());
                interfaces.push(Interface {
                    link,
                    resolution: resolution(option(IF_TSRESOL)),
                    name: name.unwrap_or_else(|| interfaces.len().to_string()),
                });
            }
            (Some(PACKET), _, Some(owner)) => match interfaces.get(owner as usize) {
                Some(owner) => packet(&mut capture, file, at, end, owner),
                None => capture.others += 1,
            },
            _ => {}
        }
        at = end;
    }
    capture.finish(None)
}

fn cut(at: usize) -> String {
    format!("it ends in the middle of a block, at byte {at}")
}

fn packet(capture: &mut Capture, file: File<'_>, at: usize, end: usize, owner: &Interface) {
    let head = (file.word(at + 12), file.word(at + 16), file.word(at + 20));
    let bytes = file.bytes.get(at + 28..end.saturating_sub(4));
    let ((Some(high), Some(low), Some(length)), Some(bytes)) = (head, bytes) else {
        return capture.skip(cut(at));
    };
    let ticks = u64::from(high) << 32 | u64::from(low);
    let micros = ticks as f64 / owner.resolution * 1e6;
    let bytes = bytes.get(..length as usize).unwrap_or(bytes);
    let time = Instant::from_micros(micros.round() as u64);
    capture.packet(time, owner.link, &owner.name, bytes);
}

/// Codes of the options of an interface.
const IF_NAME: u16 = 2;
const IF_TSRESOL: u16 = 9;

/// The value of an option of an interface.
fn option<'b>(file: File<'b>, wanted: u16, from: usize, to: usize) -> Option<&'b [u8]> {
    let mut at = from;
    while at + 4 <= to {
        let (code, length) = (file.half(at)?, usize::from(file.half(at + 2)?));
        match code {
            0 => break,
            _ if code == wanted => return file.bytes.get(at + 4..at + 4 + length),
            _ => at += 4 + length.next_multiple_of(4),
        }
    }
    None
}

/// Ticks per second: a power of 10 or, with bit 7, of 2; without the option a million.
fn resolution(option: Option<&[u8]>) -> f64 {
    match option {
        Some([value, ..]) if value & 0x80 != 0 => 2f64.powi(i32::from(value & 0x7F)),
        Some([value, ..]) => 10f64.powi(i32::from(*value)),
        _ => 1e6,
    }
}

/// A section with one interface, times in microseconds.
pub(super) fn head() -> Vec<u8> {
    let mut out = Vec::new();
    block(&mut out, SECTION, |out| {
        words(out, &[LITTLE, 1, u32::MAX, u32::MAX]);
    });
    block(&mut out, INTERFACE, |out| words(out, &[LINK.into(), 0]));
    out
}

/// Length of the complete blocks at the start of these bytes.
pub(super) fn whole(bytes: &[u8]) -> usize {
    let mut at = 0;
    while let Some(length) = bytes.get(at + 4..at + 8) {
        let length = u32::from_le_bytes([length[0], length[1], length[2], length[3]]);
        match at.checked_add(length as usize) {
            Some(end) if length > 0 && end <= bytes.len() => at = end,
            _ => break,
        }
    }
    at
}

/// Adds a record after the existing ones.
pub(super) fn add(out: &mut Vec<u8>, record: &Record) {
    block(out, PACKET, |out| packet_body(out, record));
}

fn packet_body(out: &mut Vec<u8>, record: &Record) {
    let data;
    let (id, dlc, data) = match &record.what {
        What::Error(error) => {
            let (id, bytes) = error.socketcan();
            data = bytes;
            (ERROR | id, 8, &data[..])
        }
        What::Frame(frame) => {
            let extended = if frame.id().is_extended() {
                EXTENDED
            } else {
                0
            };
            let remote = if frame.is_remote() { REMOTE } else { 0 };
            (
                frame.id().raw() | extended | remote,
                frame.dlc(),
                frame.data(),
            )
        }
    };
    let micros = record.at.as_micros();
    let length = 8 + data.len() as u32;
    words(
        out,
        &[0, (micros >> 32) as u32, micros as u32, length, length],
    );
    out.extend_from_slice(&id.to_be_bytes());
    out.extend_from_slice(&[dlc, 0, 0, 0]);
    out.extend_from_slice(data);
    out.resize(out.len().next_multiple_of(4), 0);
}

fn words(out: &mut Vec<u8>, words: &[u32]) {
    for word in words {
        out.extend_from_slice(&word.to_le_bytes());
    }
}

/// Writes a block: its type, its length, its content, and its length again.
fn block(out: &mut Vec<u8>, kind: u32, body: impl FnOnce(&mut Vec<u8>)) {
    let mut inner = Vec::new();
    body(&mut inner);
    let size = 12 + inner.len() as u32;
    words(out, &[kind, size]);
    out.extend_from_slice(&inner);
    words(out, &[size]);
}
