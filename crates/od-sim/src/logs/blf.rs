//! BLF logs of CANoe, CANalyzer and python-can: binary objects in compressed containers.
//!
//! A file is a head and objects. An object begins with `LOBJ`, the length of its head, a version, its own length and its
//! kind, little endian. A container has other objects in its data; an object may begin in one container and end in the
//! next.

use std::prelude::v1::*;

use miniz_oxide::inflate::decompress_to_vec_zlib_with_limit;
use od_wire::{CanId, Frame, Instant};

use super::pcap::Capture;
use super::record::{FD, Record};

const FILE: &[u8] = b"LOGG";
const OBJECT: &[u8] = b"LOBJ";
/// Length of the head of any object, and minimum length of the head of an event.
const HEAD: usize = 16;
const EVENT_HEAD: usize = 32;
/// Maximum number of bytes between two objects, for alignment.
const PADDING: usize = 8;
/// Largest container, in bytes; programs write 128 KiB.
const CONTAINER: usize = 1 << 26;
/// A file does not unpack to more than this multiple of its length.
const RATIO: usize = 64;

/// Kinds of objects.
mod kind {
    pub(super) const CAN_MESSAGE: u32 = 1;
    pub(super) const CAN_ERROR: u32 = 2;
    pub(super) const CONTAINER: u32 = 10;
    pub(super) const CAN_ERROR_EXT: u32 = 73;
    pub(super) const CAN_MESSAGE_2: u32 = 86;
    pub(super) const CAN_FD_MESSAGE: u32 = 100;
    pub(super) const CAN_FD_MESSAGE_64: u32 = 101;
    pub(super) const CAN_FD_ERROR_64: u32 = 104;
}

/// Flag of an event: its time is in 10 µs; otherwise in nanoseconds.
const TEN_MICROS: u32 = 1;
/// Directions of a frame.
const SENT: u8 = 1;
const TO_SEND: u8 = 2;
/// Bit 31 of a CAN-ID: 29 bits.
const EXTENDED: u32 = 1 << 31;

/// The records of a BLF log; `None` if the bytes are not one.
pub(super) fn read(bytes: &[u8]) -> Option<Result<Capture, String>> {
    bytes.starts_with(FILE).then(|| records(bytes))
}

fn records(bytes: &[u8]) -> Result<Capture, String> {
    let mut capture = Capture::default();
    let start = word(bytes, 4).unwrap_or(0) as usize;
    let mut objects = Objects::of(bytes, start);
    // Number of unpacked bytes, and the beginning of an object that continues in the next container.
    let (mut unpacked, mut rest) = (0, Vec::new());
    while let Some(object) = objects.next() {
        if object.kind != kind::CONTAINER {
            event(&object, &mut capture);
            continue;
        }
        let inner = match unpack(object.bytes) {
            Ok(inner) => inner,
            Err(why) => return capture.finish(Some(why)),
        };
        unpacked += inner.len();
        if unpacked > bytes.len().saturating_mul(RATIO) {
            let why = format!("it unpacks to more than {RATIO} times its size");
            return capture.finish(Some(why));
        }
        rest.extend_from_slice(&inner);
        let mut events = Objects::of(&rest, 0);
        while let Some(object) = events.next() {
            event(&object, &mut capture);
        }
        let end = events.at;
        rest.drain(..end);
    }
    // Zeros at the end are padding.
    let end = bytes.get(objects.at..).unwrap_or_default();
    let is_cut = end.iter().chain(&rest).any(|byte| *byte != 0);
    let cut = is_cut.then(|| String::from("it ends in the middle of an object"));
    let capture = capture.finish(cut)?;
    if capture.records.is_empty() && capture.skipped.is_empty() {
        return Err("it has no CAN frame".into());
    }
    Ok(capture)
}

/// The content of a container: packed (2) or as it is (0).
fn unpack(object: &[u8]) -> Result<Vec<u8>, String> {
    let data = object.get(32..).unwrap_or_default();
    let size = word(object, 24).unwrap_or(0) as usize;
    match half(object, 16) {
        Some(0) => Ok(data.to_vec()),
        Some(2) => decompress_to_vec_zlib_with_limit(data, size.min(CONTAINER))
            .map_err(|_| String::from("a container cannot be unpacked")),
        _ => Err("the compression of a container is not known".into()),
    }
}

/// An object with its head.
struct Object<'b> {
    kind: u32,
    bytes: &'b [u8],
}

/// Objects one after the other.
struct Objects<'b> {
    bytes: &'b [u8],
    /// Position of the next object, or of one that is not complete.
    at: usize,
}

impl<'b> Objects<'b> {
    const fn of(bytes: &'b [u8], at: usize) -> Self {
        Self { bytes, at }
    }

    /// The next complete object.
    fn next(&mut self) -> Option<Object<'b>> {
        let rest = self.bytes.get(self.at..)?;
        let near = &rest[..rest.len().min(PADDING + OBJECT.len())];
        let padding = near.windows(4).position(|four| four == OBJECT)?;
        self.at += padding;
        let rest = rest.get(padding..)?;
        let len = word(rest, 8)? as usize;
        let bytes = rest.get(..len).filter(|_| len >= HEAD)?;
        self.at += len;
        Some(Object {
            kind: word(rest, 12)?,
            bytes,
        })
    }
}

/// Adds the frame of an event.
fn event(object: &Object<'_>, capture: &mut Capture) {
    capture.begin();
    let is_error = match object.kind {
        kind::CAN_ERROR | kind::CAN_ERROR_EXT | kind::CAN_FD_ERROR_64 => true,
        kind::CAN_MESSAGE
        | kind::CAN_MESSAGE_2
        | kind::CAN_FD_MESSAGE
        | kind::CAN_FD_MESSAGE_64 => false,
        _ => return capture.others += 1,
    };
    let Some(at) = time(object.bytes) else {
        return capture.skip("its head is too short".into());
    };
    let start = half(object.bytes, 4).map_or(EVENT_HEAD, usize::from);
    let data = object
        .bytes
        .get(start.max(EVENT_HEAD)..)
        .unwrap_or_default();
    let channel = match object.kind {
        kind::CAN_FD_MESSAGE_64 | kind::CAN_FD_ERROR_64 => data.first().copied().map(u16::from),
        _ => half(data, 0),
    };
    let channel = channel.unwrap_or_default().to_string();
    if is_error {
        return capture.add(Record::error(at), &channel);
    }
    match message(object.kind, data) {
        Some(Message { is_fd: true, .. }) => capture.skip(FD.into()),
        Some(Message {
            direction: TO_SEND, ..
        }) => capture.others += 1,
        Some(Message {
            frame: Some(frame),
            direction,
            ..
        }) => {
            let record = Record::received(at, frame).sent(direction == SENT);
            capture.add(record, &channel);
        }
        _ => capture.skip("it is too short for a CAN frame".into()),
    }
}

/// The time of an event since the start of the log.
fn time(object: &[u8]) -> Option<Instant> {
    let flags = word(object, 16)?;
    let stamp = u64::from_le_bytes(object.get(24..32)?.try_into().ok()?);
    Some(Instant::from_micros(if flags == TEN_MICROS {
        stamp.saturating_mul(10)
    } else {
        stamp / 1000
    }))
}

struct Message {
    frame: Option<Frame>,
    direction: u8,
    is_fd: bool,
}

/// The data of an event with a frame.
fn message(kind: u32, data: &[u8]) -> Option<Message> {
    let byte = |at: usize| data.get(at).copied();
    // Of each kind: flags with direction and RTR, DLC, CAN-ID, FD flag, and where the data begins.
    let (direction, remote, dlc, id, is_fd, start) = match kind {
        kind::CAN_FD_MESSAGE_64 => {
            let flags = word(data, 12)?;
            let remote = flags & 0x10 != 0;
            (
                byte(34)?,
                remote,
                byte(1)?,
                word(data, 4)?,
                flags & 0x1000 != 0,
                40,
            )
        }
        kind::CAN_FD_MESSAGE => {
            let flags = byte(2)?;
            let is_fd = byte(13)? & 1 != 0;
            (
                flags & 0xF,
                flags & 0x80 != 0,
                byte(3)?,
                word(data, 4)?,
                is_fd,
                20,
            )
        }
        _ => {
            let flags = byte(2)?;
            (
                flags & 0xF,
                flags & 0x80 != 0,
                byte(3)?,
                word(data, 4)?,
                false,
                8,
            )
        }
    };
    let id = if id & EXTENDED != 0 {
        CanId::extended(id & 0x1FFF_FFFF)
    } else {
        CanId::standard((id & 0x7FF) as u16)
    };
    let dlc = dlc.min(8);
    let frame = if remote {
        Frame::remote(id, dlc)
    } else {
        let bytes = data.get(start..start + usize::from(dlc));
        bytes.and_then(|bytes| Frame::new(id, bytes))
    };
    Some(Message {
        frame,
        direction,
        is_fd,
    })
}

fn word(bytes: &[u8], at: usize) -> Option<u32> {
    let four = bytes.get(at..at.checked_add(4)?)?;
    Some(u32::from_le_bytes(four.try_into().ok()?))
}

fn half(bytes: &[u8], at: usize) -> Option<u16> {
    let two = bytes.get(at..at.checked_add(2)?)?;
    Some(u16::from_le_bytes(two.try_into().ok()?))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::logs::read::read as log;
    use crate::logs::{Log, What};

    /// An event: its kind, its time in nanoseconds, and its data.
    fn event(kind: u32, nanos: u64, data: &[u8]) -> Vec<u8> {
        let mut all = b"LOBJ".to_vec();
        let len = (32 + data.len()) as u32;
        all.extend(32_u16.to_le_bytes());
        all.extend(1_u16.to_le_bytes());
        all.extend(len.to_le_bytes());
        all.extend(kind.to_le_bytes());
        all.extend(2_u32.to_le_bytes());
        all.extend([0; 4]);
        all.extend(nanos.to_le_bytes());
        all.extend(data);
        all.resize(all.len() + all.len() % 4, 0);
        all
    }

    fn message(flags: u8, dlc: u8, id: u32, bytes: [u8; 8]) -> Vec<u8> {
        [&[1, 0, flags, dlc][..], &id.to_le_bytes(), &bytes].concat()
    }

    /// A file with these events, cut into containers of `size` bytes.
    fn file(events: &[Vec<u8>], size: usize, is_packed: bool) -> Vec<u8> {
        let mut all = b"LOGG".to_vec();
        all.extend(144_u32.to_le_bytes());
        all.resize(144, 0);
        for part in events.concat().chunks(size) {
            let packed = miniz_oxide::deflate::compress_to_vec_zlib(part, 6);
            let data = if is_packed { &packed[..] } else { part };
            all.extend(b"LOBJ\x10\0\x01\0");
            all.extend((32 + data.len() as u32).to_le_bytes());
            all.extend(10_u32.to_le_bytes());
            all.extend(if is_packed { 2_u16 } else { 0 }.to_le_bytes());
            all.extend([0; 6]);
            all.extend((part.len() as u32).to_le_bytes());
            all.extend([0; 4]);
            all.extend(data);
            all.resize(all.len() + data.len() % 4, 0);
        }
        all
    }

    fn shown(log: &Log) -> Vec<String> {
        let said = |record: &Record| match record.what {
            What::Frame(frame) => {
                let way = if record.sent { "->" } else { "<-" };
                format!("{:?} {way} {frame}", record.at)
            }
            What::Error(_) => format!("{:?} error", record.at),
        };
        log.records.iter().map(said).collect()
    }

    #[test]
    fn frames_of_every_kind_are_read_from_containers_of_any_size() {
        let bytes = [0x40, 0x18, 0x10, 1, 0, 0, 0, 0];
        let mut fd = message(0, 1, 0x705, [0; 8]);
        fd.extend([0; 4]);
        fd.extend([5]);
        fd.resize(84, 0);
        let mut fd64 = vec![1, 1, 1, 0];
        fd64.extend(0x706_u32.to_le_bytes());
        fd64.resize(40, 0);
        fd64.extend([0x7F]);
        let mut long = fd64.clone();
        long[13] = 0x10;
        let events = [
            event(86, 1_000_000, &message(1, 8, 0x605, bytes)),
            event(1, 2_000_000, &message(0, 2, 0x185, bytes)),
            event(1, 3_000_000, &message(0x80, 1, 0x705, [0; 8])),
            event(1, 4_000_000, &message(0, 1, 0x9234_5678, bytes)),
            event(73, 5_000_000, &[0; 24]),
            event(100, 6_000_000, &fd),
            event(101, 7_000_000, &fd64),
            event(101, 8_000_000, &long),
            // A request to send, and a text of the program.
            event(1, 9_000_000, &message(2, 1, 0x185, bytes)),
            event(65, 9_000_000, b"a text of this length"),
        ];
        for (size, is_packed) in [(1 << 17, true), (37, false), (37, true), (1, false)] {
            let all = file(&events, size, is_packed);
            let read = log(&all).expect("a log");
            assert_eq!(
                shown(&read),
                [
                    "0.001000 -> 605#4018100100000000",
                    "0.002000 <- 185#4018",
                    "0.003000 <- 705#R1",
                    "0.004000 <- 12345678#40",
                    "0.005000 error",
                    "0.006000 <- 705#05",
                    "0.007000 <- 706#7F",
                ],
                "{size}"
            );
            assert_eq!(read.others, 2);
            assert_eq!(read.channels, ["1", "0"]);
            let said: Vec<String> = read.skipped.iter().map(ToString::to_string).collect();
            assert_eq!(said.len(), 1, "{said:?}");
            assert!(
                said[0].starts_with("frame 8: it is a CAN FD frame"),
                "{said:?}"
            );
        }
    }

    #[test]
    fn a_damaged_log_keeps_what_comes_before_and_says_what_is_wrong() {
        let bytes = [0; 8];
        let events: Vec<_> = (0..100)
            .map(|at| event(86, at * 1_000_000, &message(0, 8, 0x185, bytes)))
            .collect();
        let whole = file(&events, 480, false);
        let read = log(&whole[..whole.len() - 10]).expect("a log");
        assert!(read.records.len() > 80 && read.records.len() < 100);
        assert!(read.skipped[0].why.contains("in the middle of an object"));
        let mut wrong = file(&events, 480, true);
        let place = wrong.len() - 60;
        wrong[place] ^= 0xFF;
        let read = log(&wrong).expect("a log");
        assert!(read.records.len() > 80 && read.records.len() < 100);
        assert!(
            read.skipped[0].why.contains("cannot be unpacked"),
            "{:?}",
            read.skipped
        );
        let none = log(&file(&[], 1, true)).expect_err("no frame").to_string();
        assert_eq!(none, "it has no CAN frame");
        // A small file that unpacks to gigabytes ends early.
        let zeros = vec![0; 1 << 20];
        let bomb = file(&[zeros], 1 << 20, true);
        let said = log(&bomb).expect_err("a bomb").to_string();
        assert_eq!(said, "it unpacks to more than 64 times its size");
    }
}
