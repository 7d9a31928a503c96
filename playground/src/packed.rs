//! Packed frames: 24 bytes each, little endian, so that thousands are passed in one call; and objects as one number.
//!
//! | offset | what |
//! |---|---|
//! | 0 | `f64`, virtual microseconds |
//! | 8 | `u32`, identifier |
//! | 12 | `u8`, flags: 1 extended, 2 remote, 4 sent by [`Bus::send`](crate::Bus::send), 8 disturbed |
//! | 13 | `u8`, DLC |
//! | 14 | `u8`, number of the device that sent it or describes its sender, counted from 1; 0 for none |
//! | 15 | `u8`, reserved |
//! | 16 | eight bytes of data, the unused ones 0 |
//!
//! A failed attempt to send a frame has other data: reason (0 unknown, 1 no acknowledge, 2 another
//! bit rate, 3 reflections, 4 another frame with the same identifier, 5 short circuit), 1 if its sender went bus-off, the sender's
//! transmit error counter in two bytes, and the number of failed attempts in four.

use od_model::Address;
use od_runtime::{Frame, Instant};
use od_sim::journal;
use od_sim::line::FrameError;
use od_sim::rig::LineEvent;

/// Bytes of a packed frame.
pub(crate) const LEN: usize = 24;

pub(crate) const EXTENDED: u8 = 1;
pub(crate) const REMOTE: u8 = 2;
pub(crate) const OWN: u8 = 4;
pub(crate) const DISTURBED: u8 = 8;

/// Offsets.
pub(crate) mod at {
    pub(crate) const TIME: usize = 0;
    pub(crate) const ID: usize = TIME + 8;
    pub(crate) const FLAGS: usize = ID + 4;
    pub(crate) const DLC: usize = FLAGS + 1;
    pub(crate) const DEVICE: usize = DLC + 1;
    pub(crate) const DATA: usize = DEVICE + 2;
}

/// Adds a frame; `device` is `None` if a program sent it.
pub(crate) fn push(batch: &mut Vec<u8>, at: Instant, device: Option<usize>, frame: &Frame) {
    let id = frame.id();
    let mut flags = if device.is_none() { OWN } else { 0 };
    if id.is_extended() {
        flags |= EXTENDED;
    }
    if frame.is_remote() {
        flags |= REMOTE;
    }
    let device = device.map_or(0, |device| u8::try_from(device + 1).unwrap_or(u8::MAX));
    let mut packed = [0; LEN];
    let time = (at.as_micros() as f64).to_le_bytes();
    packed[at::TIME..at::ID].copy_from_slice(&time);
    packed[at::ID..at::FLAGS].copy_from_slice(&id.raw().to_le_bytes());
    packed[at::FLAGS..at::DATA].copy_from_slice(&[flags, frame.dlc(), device, 0]);
    packed[at::DATA..].copy_from_slice(frame.bytes());
    batch.extend_from_slice(&packed);
}

/// Adds an event of the bus line.
pub(crate) fn push_event(batch: &mut Vec<u8>, seen: &LineEvent) {
    let one = match seen {
        LineEvent::Frame { at, device, frame } => return push(batch, *at, *device, frame),
        LineEvent::Heard {
            at: when,
            device,
            frame,
        } => {
            let start = batch.len();
            push(batch, *when, *device, frame);
            if let Some(flags) = batch.get_mut(start + at::FLAGS) {
                *flags &= !OWN;
            }
            return;
        }
        LineEvent::Disturbed(one) => one,
    };
    let why = match one.error {
        FrameError::NoAcknowledge => 1,
        FrameError::OtherBitRate => 2,
        FrameError::Reflections => 3,
        FrameError::SameId => 4,
        FrameError::ShortCircuit => 5,
    };
    let [low, high] = one.transmit_errors.to_le_bytes();
    let [a, b, c, d] = one.attempts.to_le_bytes();
    let data = [why, one.bus_off.into(), low, high, a, b, c, d];
    let start = batch.len();
    push(batch, one.at, one.device, &Frame::of(one.frame.id(), &data));
    if let Some(flags) = batch.get_mut(start + at::FLAGS) {
        *flags |= DISTURBED;
    }
}

/// Adds a line of a log.
#[cfg(feature = "logs")]
pub(crate) fn push_line(batch: &mut Vec<u8>, line: &od_sim::logs::Record) {
    use od_sim::logs::What;
    let start = batch.len();
    let nothing = Frame::standard(0, &[0; 8]);
    let (frame, disturbed) = match &line.what {
        What::Frame(frame) => (frame, 0),
        What::Error(_) => (&nothing, DISTURBED),
    };
    push(batch, line.at, None, frame);
    if let Some(flags) = batch.get_mut(start + at::FLAGS) {
        *flags = *flags & !OWN | disturbed | if line.sent { OWN } else { 0 };
    }
}

/// An object as one number: `index * 256 + sub`.
pub(crate) fn object(address: Address) -> u32 {
    u32::from(address.index) << 8 | u32::from(address.sub)
}

fn flags(packed: &[u8]) -> u8 {
    packed.get(at::FLAGS).copied().unwrap_or_default()
}

/// Returns whether this frame was disturbed on the line.
pub(crate) fn is_disturbed(packed: &[u8]) -> bool {
    flags(packed) & DISTURBED != 0
}

/// Returns whether a program sent it.
#[cfg(feature = "logs")]
pub(crate) fn is_own(packed: &[u8]) -> bool {
    flags(packed) & OWN != 0
}

/// Its time in virtual microseconds.
pub(crate) fn micros(packed: &[u8]) -> Option<f64> {
    Some(f64::from_le_bytes(packed.get(..8)?.try_into().ok()?))
}

/// The frame in these bytes; `None` if there are too few.
pub(crate) fn frame(packed: &[u8]) -> Option<Frame> {
    let packed: &[u8; LEN] = packed.get(..LEN)?.try_into().ok()?;
    let raw = u32::from_le_bytes(packed[at::ID..at::FLAGS].try_into().ok()?);
    let (flags, dlc) = (packed[at::FLAGS], packed[at::DLC].min(8));
    journal::frame(
        raw,
        &packed[at::DATA..at::DATA + usize::from(dlc)],
        flags & EXTENDED != 0,
        flags & REMOTE != 0,
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_frame_is_unpacked_as_it_was_packed() -> Result<(), &'static str> {
        for sent in [
            journal::frame(0x601, &[0x40, 4, 0x60, 0], false, false),
            journal::frame(0x701, &[0; 3], false, true),
            journal::frame(0x1234_5678, &[1, 2, 3, 4, 5, 6, 7, 8], true, false),
        ] {
            let sent = sent.ok_or("eight bytes at most")?;
            let mut batch = Vec::new();
            push(&mut batch, Instant::from_millis(7), Some(2), &sent);
            assert_eq!(batch.len(), LEN);
            assert_eq!(batch[at::DEVICE], 3);
            assert_eq!(frame(&batch), Some(sent));
            assert_eq!(frame(&batch[1..]), None);
        }
        Ok(())
    }
}
