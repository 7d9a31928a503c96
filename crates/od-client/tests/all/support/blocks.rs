//! Frames of block transfers.

use od_client::Error;
use od_client::sdo::{Expected, Options};
use od_wire::sdo::{Response, crc16};

use super::{Machine, frame};

pub(crate) const COMMAND: &str = "01000405";
pub(crate) const SEQUENCE: &str = "03000405";

/// Blocks of `size` segments, for uploads and for downloads from 8 bytes on.
pub(crate) fn options(size: u8) -> Options {
    let mut options = Options::DEFAULT;
    options.block_from = Some(8);
    options.block_upload = true;
    options.block_size = size;
    options
}

pub(crate) fn hex(bytes: &[u8]) -> String {
    bytes.iter().map(|byte| format!("{byte:02X}")).collect()
}

/// Segment `number` of a block, with the seven bytes of `data` from `start`.
pub(crate) fn segment(number: u8, data: &[u8], start: usize) -> String {
    let end = data.len().min(start + 7);
    hex(&[number]) + &hex(&data[start..end])
}

pub(crate) fn crc(data: &[u8]) -> String {
    hex(&crc16(data).to_le_bytes())
}

#[track_caller]
pub(crate) fn fails(machine: &mut impl Machine, answer: &str, abort: &str, error: Error) {
    machine.talk(&[(answer, &format!("80032000{abort}"))]);
    assert_eq!(machine.outcome(), Some(Err(error)), "{answer}");
    assert_eq!(machine.poll_timeout(), None);
    machine.talk(&[("01", "-"), ("A20404", "-")]);
}

#[track_caller]
pub(crate) fn refuses(machine: &mut impl Machine, answer: &str, abort: &str, expected: Expected) {
    let got = match frame(&format!("581#{answer}")).bytes() {
        // The last segment of a block, not an abort.
        [0x81..=0x9F, ..] => Response::Unknown,
        data => Response::parse(data),
    };
    fails(machine, answer, abort, Error::OutOfTurn { expected, got });
}
