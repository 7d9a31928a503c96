//! `struct can_frame` of Linux, the message of a raw CAN socket: 16 bytes, with
//! the CAN-ID in the byte order of the machine.

use std::prelude::v1::*;

use od_runtime::{CanId, Frame, Instant};

use super::codec::{Codec, Step};

/// Bytes of a frame; a socket reads or writes one frame at a time.
pub const SIZE: usize = 16;

const EXTENDED: u32 = 1 << 31;
const REMOTE: u32 = 1 << 30;
const ERROR: u32 = 1 << 29;

/// The codec of a CAN socket.
#[derive(Clone, Copy, Debug, Default)]
pub struct CanSocket;

impl Codec for CanSocket {
    fn receive(&mut self, bytes: &[u8], _: Instant, steps: &mut Vec<Step>) {
        steps.extend(bytes.chunks(SIZE).filter_map(decode).map(Step::Frame));
    }

    fn form(&self) -> Option<&'static str> {
        Some("can_frame")
    }

    fn encode(&mut self, frame: &Frame, _: Instant, _: u64, out: &mut Vec<u8>) {
        encode(frame, out);
    }
}

/// Writes a frame.
pub fn encode(frame: &Frame, out: &mut Vec<u8>) {
    let mut id = frame.id().raw();
    if frame.id().is_extended() {
        id |= EXTENDED;
    }
    if frame.is_remote() {
        id |= REMOTE;
    }
    let mut bytes = [0; SIZE];
    bytes[..4].copy_from_slice(&id.to_ne_bytes());
    bytes[4] = frame.dlc();
    bytes[8..8 + frame.data().len()].copy_from_slice(frame.data());
    out.extend_from_slice(&bytes);
}

/// Reads a frame; `None` for an error message of the controller, a CAN FD frame, or an
/// incomplete frame.
pub fn decode(bytes: &[u8]) -> Option<Frame> {
    let bytes: &[u8; SIZE] = bytes.try_into().ok()?;
    let (id, rest) = bytes.split_first_chunk::<4>()?;
    let id = u32::from_ne_bytes(*id);
    let dlc = rest[0];
    if id & ERROR != 0 || dlc > 8 {
        return None;
    }
    let name = match id & EXTENDED {
        0 => CanId::standard((id & 0x7FF) as u16),
        _ => CanId::extended(id),
    };
    match id & REMOTE {
        0 => Frame::new(name, &bytes[8..8 + usize::from(dlc)]),
        _ => Frame::remote(name, dlc),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_written_frame_is_read_back() {
        for frame in [
            Frame::standard(0x581, &[0x43, 2, 0x60, 0, 0, 0, 0, 0x20]),
            Frame::standard(0x80, &[]),
            Frame::of(CanId::extended(0x1FFF_FFFF), &[1]),
            Frame::remote(CanId::standard(0x701), 0).unwrap(),
            Frame::remote(CanId::extended(0x701), 8).unwrap(),
        ] {
            let mut bytes = Vec::new();
            encode(&frame, &mut bytes);
            assert_eq!(bytes.len(), SIZE);
            assert_eq!(decode(&bytes), Some(frame));
        }
    }

    #[test]
    fn other_messages_are_left_out() {
        let mut bytes = Vec::new();
        encode(&Frame::standard(0x123, &[1, 2]), &mut bytes);
        assert_eq!(decode(&bytes[..15]), None);
        assert_eq!(decode(&[&bytes[..], &[0; 56]].concat()), None);
        bytes[4] = 9;
        assert_eq!(decode(&bytes), None);
        bytes[4] = 2;
        let id = 0x2000_0004_u32;
        bytes[..4].copy_from_slice(&id.to_ne_bytes());
        assert_eq!(decode(&bytes), None);
    }
}
