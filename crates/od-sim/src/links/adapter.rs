//! The client side of slcan: for an adapter on a serial line, an slcan server, or `odkit sim`.

use std::format;
use std::prelude::v1::*;

use od_wire::Frame;

use super::slcan;

/// Bit rates in kbit/s; the index is the number in the command `S`.
pub const RATES: [u16; 9] = [10, 20, 50, 100, 125, 250, 500, 800, 1000];

/// Longest line of an adapter; the end of a longer line is cut off.
const LONGEST: usize = 256;

/// Line of an adapter.
#[derive(Clone, PartialEq, Eq, Debug)]
pub enum Message {
    /// A frame of the bus.
    Frame(Frame),
    /// The channel is open.
    Open,
    /// The adapter refuses to open the channel.
    Closed,
    /// The adapter refuses a frame.
    Refused,
    /// An answer without effect.
    Nothing,
    /// Not a line of an adapter.
    Noise(Vec<u8>),
}

/// The way in which an adapter opens its channel.
#[derive(Clone, Copy, Default, Debug)]
pub struct Opening {
    /// Bit rate in kbit/s; `None`: the adapter keeps its present rate.
    pub rate: Option<u16>,
    /// The adapter only listens: it acknowledges no frames.
    pub listens: bool,
    /// The adapter adds time stamps, if it has them.
    pub stamps: bool,
}

/// State of the conversation with an adapter.
#[derive(Clone, Debug, Default)]
pub struct Adapter {
    /// Answers that must come before the channel is open.
    due: u8,
    is_open: bool,
    /// An incomplete line.
    line: Vec<u8>,
}

impl Adapter {
    /// Returns the bytes that open the channel; `None` for a rate that slcan does not have.
    pub fn begin(&mut self, opening: Opening) -> Option<Vec<u8>> {
        // The first end of line completes a line that an earlier host left.
        let mut text = String::from("\rC\r");
        *self = Self {
            due: 3,
            ..Self::default()
        };
        if let Some(rate) = opening.rate {
            let number = RATES.iter().position(|one| *one == rate)?;
            text.push_str(&format!("S{number}\r"));
            self.due += 1;
        }
        if opening.stamps {
            text.push_str("Z1\r");
            self.due += 1;
        }
        text.push_str(if opening.listens { "L\r" } else { "O\r" });
        Some(text.into_bytes())
    }

    /// Handles bytes from the adapter.
    pub fn receive(&mut self, bytes: &[u8], mut handle: impl FnMut(Message)) {
        for byte in bytes {
            match byte {
                b'\r' | 0x07 => {
                    let line = std::mem::take(&mut self.line);
                    handle(self.line(&line, *byte == b'\r'));
                    self.line = line;
                    self.line.clear();
                }
                b'\n' => {}
                _ if self.line.len() < LONGEST => self.line.push(*byte),
                _ => {}
            }
        }
    }

    /// Handles a line, given without its end. `is_right` is false if the line ended with a bell, which marks an error.
    pub fn line(&mut self, line: &[u8], is_right: bool) -> Message {
        if let Some(frame) = slcan::frame_of(line) {
            return Message::Frame(frame);
        }
        match line {
            [] => self.answer(is_right),
            [b'z' | b'Z'] | [b'V' | b'v' | b'N' | b'F', ..] => Message::Nothing,
            // A frame of CAN FD, which no CANopen node sends.
            [b'd' | b'D' | b'b' | b'B', rest @ ..] if rest.iter().all(u8::is_ascii_hexdigit) => {
                Message::Nothing
            }
            // The end of a line whose beginning another reader received.
            _ if !self.is_open => Message::Nothing,
            line => Message::Noise(line.to_vec()),
        }
    }

    /// An answer without text: accepted, or an error.
    fn answer(&mut self, is_right: bool) -> Message {
        if self.is_open {
            return if is_right {
                Message::Nothing
            } else {
                Message::Refused
            };
        }
        self.due = self.due.saturating_sub(1);
        match (self.due, is_right) {
            (0, true) => {
                self.is_open = true;
                Message::Open
            }
            (0, false) => Message::Closed,
            _ => Message::Nothing,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::links::codec::{Codec, Step};
    use od_wire::Instant;

    fn messages(adapter: &mut Adapter, bytes: &[u8]) -> Vec<Message> {
        let mut all = Vec::new();
        adapter.receive(bytes, |one| all.push(one));
        all
    }

    fn at(rate: Option<u16>) -> Opening {
        Opening {
            rate,
            ..Opening::default()
        }
    }

    #[test]
    fn it_opens_the_channel_of_odkit_sim() {
        let mut server = slcan::Channel::default();
        for rate in [None, Some(10), Some(1000)] {
            let mut adapter = Adapter::default();
            let begin = adapter.begin(at(rate)).unwrap_or_default();
            let (mut steps, mut answer) = (Vec::new(), Vec::new());
            server.receive(&begin, Instant::ZERO, &mut steps);
            for step in steps {
                if let Step::Reply(bytes) = step {
                    answer.extend(bytes);
                }
            }
            assert_eq!(
                messages(&mut adapter, &answer).last(),
                Some(&Message::Open),
                "{rate:?}"
            );
        }
        assert_eq!(Adapter::default().begin(at(Some(300))), None);
    }

    #[test]
    fn frames_come_in_pieces_and_the_bell_is_an_error() {
        let mut adapter = Adapter::default();
        assert!(
            adapter
                .begin(Opening {
                    listens: true,
                    ..Opening::default()
                })
                .is_some_and(|text| text.ends_with(b"L\r"))
        );
        assert_eq!(
            messages(&mut adapter, b"\r\r\x07").last(),
            Some(&Message::Closed)
        );
        assert!(adapter.begin(at(Some(500))).is_some());
        assert_eq!(
            messages(&mut adapter, b"\r\r\r\r").last(),
            Some(&Message::Open)
        );
        assert_eq!(messages(&mut adapter, b"t7011"), []);
        let boot = Message::Frame(Frame::standard(0x701, &[5]));
        assert_eq!(
            messages(&mut adapter, b"05\rz\r\x07"),
            [boot, Message::Nothing, Message::Refused]
        );
        for fd in [&b"d18581112131415161718\r"[..], b"B000001239AABBCCDD\r"] {
            assert_eq!(messages(&mut adapter, fd), [Message::Nothing]);
        }
        assert_eq!(
            messages(&mut adapter, b"dx\r"),
            [Message::Noise(b"dx".to_vec())]
        );
        let long = [b'x'; 2 * LONGEST];
        assert_eq!(messages(&mut adapter, &long), []);
        assert_eq!(
            messages(&mut adapter, b"\r"),
            [Message::Noise(vec![b'x'; LONGEST])]
        );
    }
}
