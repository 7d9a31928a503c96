//! The serial line CAN protocol of adapters and hosts (Lawicel; can-utils; python-can).
//!
//! A line of a client ends with CR. The answer is CR, or BEL after an error.
//! Frames are sent as `t1232AABB`, `T0000012321122`, `r1230`, `R000001230`.

use std::format;
use std::prelude::v1::*;

use od_runtime::{BusEvent, CanId, Frame, Instant};

use super::codec::{Codec, Step, reply};
use crate::line::Controller;

/// The answer to a valid line.
const OK: &[u8] = b"\r";
/// The answer to an error.
const BELL: &[u8] = b"\x07";

/// The longest valid line is `T` with 8 bytes: 26 characters, and 4 of a
/// time stamp that some hosts send.
const LONGEST: usize = 64;

/// State of one client's adapter.
#[derive(Debug, Default)]
pub struct Channel {
    line: Vec<u8>,
    too_long: bool,
    open: bool,
    listen_only: bool,
    time_stamps: bool,
}

impl Codec for Channel {
    fn receive(&mut self, bytes: &[u8], _: Instant, steps: &mut Vec<Step>) {
        for byte in bytes {
            match byte {
                b'\r' => {
                    let line = std::mem::take(&mut self.line);
                    if std::mem::take(&mut self.too_long) {
                        reply(steps, BELL);
                    } else if let Some(frame) = self.command(&line, steps) {
                        // The acknowledgement of a frame comes before its effects.
                        steps.push(Step::Frame(frame));
                    }
                    self.line = line;
                    self.line.clear();
                }
                // Terminals send line feeds, too; no line contains one.
                b'\n' => {}
                _ if self.line.len() < LONGEST => self.line.push(*byte),
                _ => self.too_long = true,
            }
        }
    }

    /// Bit 2 is the error warning limit, bit 5 error passive, bit 7 a bus error that took the controller off the bus. No
    /// queue of this adapter overflows.
    fn status(&mut self, controller: Controller) -> Vec<u8> {
        let flags = match controller.event() {
            BusEvent::Off => 0xA4,
            BusEvent::Passive => 0x24,
            BusEvent::Warning => 0x04,
            _ => 0x00,
        };
        format!("F{flags:02X}\r").into_bytes()
    }

    fn form(&self) -> Option<&'static str> {
        match (self.open, self.time_stamps) {
            (false, _) => None,
            (true, false) => Some("slcan"),
            (true, true) => Some("slcan with time stamps"),
        }
    }

    fn encode(&mut self, frame: &Frame, now: Instant, _: u64, out: &mut Vec<u8>) {
        if !self.open {
            return;
        }
        write_frame(frame, out);
        if self.time_stamps {
            let millis = now.as_micros() / 1000 % 60_000;
            out.extend_from_slice(format!("{millis:04X}").as_bytes());
        }
        out.extend_from_slice(OK);
    }
}

impl Channel {
    /// Handles one line without its CR.
    fn command(&mut self, line: &[u8], steps: &mut Vec<Step>) -> Option<Frame> {
        let answer = match line {
            // Hosts send empty lines to end an incomplete line of an earlier host.
            [] => OK,
            // Hosts open an open channel and close a closed one, to be sure.
            [b'C'] => {
                self.open = false;
                OK
            }
            [kind @ (b'O' | b'L')] => {
                if !self.open {
                    steps.push(Step::Open);
                }
                (self.open, self.listen_only) = (true, *kind == b'L');
                OK
            }
            // Bit rates, filters, polling, UART rate: accepted without effect.
            [b'S', b'0'..=b'9'] => OK,
            [b's', rest @ ..] if matches!(rest.len(), 4 | 6) && is_hex(rest) => OK,
            [b'M' | b'm', rest @ ..] if rest.len() == 8 && is_hex(rest) => OK,
            [b'W', b'0'..=b'2'] | [b'X', b'0' | b'1'] | [b'U', b'0'..=b'6'] => OK,
            [b'Q', b'0'..=b'2'] | [b'P' | b'A'] => OK,
            [b'Z', on @ (b'0' | b'1')] => {
                self.time_stamps = *on == b'1';
                OK
            }
            [b'V'] => b"V1013\r",
            [b'v'] => b"v0100\r",
            [b'N'] => b"NODKT\r",
            [b'F'] => {
                steps.push(Step::Status);
                return None;
            }
            [kind @ (b't' | b'T' | b'r' | b'R'), rest @ ..] => {
                let frame = parse_frame(*kind, rest).filter(|_| self.open && !self.listen_only);
                let answer: &[u8] = match (frame, kind) {
                    (None, _) => BELL,
                    (Some(_), b't' | b'r') => b"z\r",
                    (Some(_), _) => b"Z\r",
                };
                reply(steps, answer);
                return frame;
            }
            _ => BELL,
        };
        reply(steps, answer);
        None
    }
}

/// A frame as a line without its CR.
pub fn write_frame(frame: &Frame, out: &mut Vec<u8>) {
    let id = frame.id();
    let kind = match (frame.is_remote(), id.is_extended()) {
        (false, false) => 't',
        (false, true) => 'T',
        (true, false) => 'r',
        (true, true) => 'R',
    };
    out.extend_from_slice(format!("{kind}{id}{}", frame.dlc()).as_bytes());
    for byte in frame.data() {
        out.extend_from_slice(format!("{byte:02X}").as_bytes());
    }
}

/// The frame of a line without its CR, if it is one.
pub fn frame_of(line: &[u8]) -> Option<Frame> {
    match line {
        [kind @ (b't' | b'T' | b'r' | b'R'), rest @ ..] => parse_frame(*kind, rest),
        _ => None,
    }
}

/// The time stamp of a frame's line in milliseconds, if it has one.
pub fn stamp_of(line: &[u8]) -> Option<u16> {
    let (kind, rest) = line.split_first()?;
    let id = if kind.is_ascii_uppercase() { 8 } else { 3 };
    let dlc = rest.get(id)?.checked_sub(b'0')?;
    let is_remote = kind.eq_ignore_ascii_case(&b'r');
    let data = if is_remote { 0 } else { 2 * usize::from(dlc) };
    let stamp = rest.get(id + 1 + data..).filter(|rest| is_stamp(rest))?;
    u16::try_from(hex(stamp)?).ok()
}

fn is_hex(text: &[u8]) -> bool {
    text.iter().all(u8::is_ascii_hexdigit)
}

/// Parses the rest after the letter: CAN-ID, length, data, and an optional time stamp.
fn parse_frame(kind: u8, text: &[u8]) -> Option<Frame> {
    let extended = kind.is_ascii_uppercase();
    let (id, rest) = text.split_at_checked(if extended { 8 } else { 3 })?;
    let id = hex(id)?;
    let id = match extended {
        true if id <= 0x1FFF_FFFF => CanId::extended(id),
        false if id <= 0x7FF => CanId::standard(id as u16),
        _ => return None,
    };
    let (length, rest) = rest.split_first()?;
    let dlc = length.checked_sub(b'0').filter(|dlc| *dlc <= 8)?;
    if kind.eq_ignore_ascii_case(&b'r') {
        return Frame::remote(id, dlc).filter(|_| rest.is_empty() || is_stamp(rest));
    }
    let (data, rest) = rest.split_at_checked(2 * usize::from(dlc))?;
    if !rest.is_empty() && !is_stamp(rest) {
        return None;
    }
    let mut bytes = [0; 8];
    for (byte, digits) in bytes.iter_mut().zip(data.chunks(2)) {
        *byte = hex(digits)? as u8;
    }
    Some(Frame::with_dlc(id, bytes, dlc))
}

fn is_stamp(rest: &[u8]) -> bool {
    rest.len() == 4 && is_hex(rest)
}

/// Up to eight hex digits, without a sign.
fn hex(digits: &[u8]) -> Option<u32> {
    if !is_hex(digits) {
        return None;
    }
    u32::from_str_radix(std::str::from_utf8(digits).ok()?, 16).ok()
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::string::ToString;

    /// Returns the response, and the frames for the bus.
    fn taken(channel: &mut Channel, input: &[u8]) -> (Vec<u8>, Vec<Frame>) {
        let (mut steps, mut answered, mut seen) = (Vec::new(), Vec::new(), Vec::new());
        channel.receive(input, Instant::ZERO, &mut steps);
        for step in steps {
            match step {
                Step::Reply(bytes) => answered.extend(bytes),
                Step::Frame(frame) => seen.push(frame),
                Step::Open => {}
                Step::Status => answered.extend(channel.status(Controller::default())),
                Step::Line(_) | Step::Pause | Step::Leave => unreachable!("slcan has none"),
            }
        }
        (answered, seen)
    }

    #[track_caller]
    fn check(input: &str, reply: &str, frames: &str) {
        let (answered, seen) = taken(&mut Channel::default(), input.as_bytes());
        let seen: Vec<_> = seen.iter().map(ToString::to_string).collect();
        assert_eq!(String::from_utf8_lossy(&answered), reply, "{input:?}");
        assert_eq!(seen.join(" "), frames, "{input:?}");
    }

    #[test]
    fn python_can_opens_like_this() {
        check("C\rS6\r\rO\rO\rF\r", "\r\r\r\r\rF00\r", "");
        check("O\rr7050\r", "\rz\r", "705#R");
    }

    #[test]
    fn every_kind_of_frame() {
        check(
            "O\rt60184004600000000000\r",
            "\rz\r",
            "601#4004600000000000",
        );
        check("O\rt0800\r", "\rz\r", "080#");
        check("O\rT1ffffff02aaBB\r", "\rZ\r", "1FFFFFF0#AABB");
        check("O\rr7018\rR000007013\r", "\rz\rZ\r", "701#R8 00000701#R3");
        check("O\rt0801051234\r", "\rz\r", "080#05");
    }

    #[test]
    fn an_error_is_answered_with_a_bell_only() {
        for line in [
            "x",
            "S",
            "SA",
            "S66",
            "s12",
            "t",
            "t60",
            "t601",
            "t6018",
            "t60190",
            "t8000",
            "t601140",
            "t6011g0",
            "t6011400",
            "T601140",
            "T2000000000",
            "r701",
            "r7019",
            "O1",
            "t6012+1+1",
            "t-011aa",
            "\u{0}",
            "ä",
            "d1230",
            "V ",
            "Z2",
        ] {
            let expected = match line {
                "t601140" => "\rz\r",
                _ => "\r\x07",
            };
            let frames = if line == "t601140" { "601#40" } else { "" };
            check(&format!("O\r{line}\r"), expected, frames);
        }
        check("t6011\rt601140\r", "\x07\x07", "");
        check("L\rt601140\r", "\r\x07", "");
        check(
            &format!("O\r{}\rV\r", "t".repeat(100_000)),
            "\r\x07V1013\r",
            "",
        );
    }

    #[test]
    fn a_closed_channel_receives_nothing() {
        let frame = Frame::standard(0x701, &[0]);
        let mut channel = Channel::default();
        let mut out = Vec::new();
        channel.encode(&frame, Instant::ZERO, 0, &mut out);
        assert!(out.is_empty());
        channel.receive(b"Z1\rO\r", Instant::ZERO, &mut Vec::new());
        channel.encode(&frame, Instant::from_micros(61_000_000), 0, &mut out);
        assert_eq!(out, b"t70110003E8\r");
        channel.receive(b"Z0\rC\r", Instant::ZERO, &mut Vec::new());
        out.clear();
        channel.encode(&frame, Instant::ZERO, 0, &mut out);
        assert!(out.is_empty());
    }

    #[test]
    fn a_line_may_have_a_time_stamp() {
        for (line, stamp) in [
            ("t70110003E8", Some(1000)),
            ("t701100", None),
            ("T0000070100000", Some(0)),
            ("r7010EA5F", Some(59_999)),
            ("r7018", None),
            ("t701100123", None),
            ("t", None),
            ("", None),
        ] {
            assert_eq!(stamp_of(line.as_bytes()), stamp, "{line}");
        }
    }

    #[test]
    fn a_written_line_is_read_back() {
        let mut channel = Channel::default();
        channel.receive(b"O\r", Instant::ZERO, &mut Vec::new());
        for frame in [
            Frame::standard(0x581, &[0x43, 2, 0x60, 0, 0, 0, 0, 0x20]),
            Frame::standard(0x80, &[]),
            Frame::of(CanId::extended(0x12345), &[1]),
            Frame::remote(CanId::standard(0x701), 0).unwrap(),
            Frame::remote(CanId::extended(0x701), 8).unwrap(),
        ] {
            let mut out = Vec::new();
            channel.encode(&frame, Instant::ZERO, 0, &mut out);
            assert_eq!(taken(&mut channel, &out).1, [frame]);
        }
    }
}
