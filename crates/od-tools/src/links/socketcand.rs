//! The client side of socketcand: a daemon that serves the CAN interfaces of its computer.

use od_sim::logs::candump::parse_frame;
use od_wire::Frame;

use super::stamps::Stamp;
use super::stream::{Message, Protocol, shown};

/// State of the conversation with the daemon.
pub(super) struct Socketcand {
    bus: String,
    step: Step,
}

#[derive(Clone, Copy, PartialEq, Eq)]
enum Step {
    Greeting,
    Opening,
    RawMode,
    Open,
}

impl Socketcand {
    /// A client of this bus, such as `can0`.
    pub(super) fn new(bus: &str) -> Self {
        Self {
            bus: bus.to_owned(),
            step: Step::Greeting,
        }
    }

    /// One command of the daemon, without its brackets.
    fn message(&mut self, text: &str) -> Result<Message, String> {
        let mut words = text.split_ascii_whitespace();
        match (words.next().unwrap_or_default(), self.step) {
            ("hi", Step::Greeting) => {
                self.step = Step::Opening;
                Ok(Message::Reply(
                    format!("< open {} >", self.bus).into_bytes(),
                ))
            }
            ("ok", Step::Opening) => {
                self.step = Step::RawMode;
                Ok(Message::Reply(b"< rawmode >".to_vec()))
            }
            ("ok", Step::RawMode) => {
                self.step = Step::Open;
                Ok(Message::Open)
            }
            (kind @ ("frame" | "rtr"), _) => {
                let id = words.next().unwrap_or_default();
                let stamp = words.next().and_then(time_of_day);
                let data: String = words.collect();
                let data = match kind {
                    "rtr" => format!("R{data}"),
                    _ => data,
                };
                let frame = parse_frame(&format!("{id}#{data}"));
                let message = frame.map(|frame| Message::Frame(frame, stamp));
                message.map_err(|_| unexpected(text))
            }
            // With a number it is an error frame of the bus.
            ("error", _) => match words.next() {
                Some(class) if class.bytes().all(|byte| byte.is_ascii_hexdigit()) => {
                    Ok(Message::Nothing)
                }
                _ => Err(format!(
                    "the server answers `{text}` for bus `{}`",
                    self.bus
                )),
            },
            ("ok" | "echo" | "hi", _) => Ok(Message::Nothing),
            _ => Err(unexpected(text)),
        }
    }
}

/// Reads the time of day of a frame, such as `1700000000.123456`.
fn time_of_day(text: &str) -> Option<Stamp> {
    let (seconds, micros) = text.split_once('.')?;
    let seconds: u64 = seconds.parse().ok()?;
    let micros: u64 = format!("{micros:0<6.6}").parse().ok()?;
    Some(Stamp {
        micros: seconds.checked_mul(1_000_000)?.checked_add(micros)?,
        period: 0,
    })
}

fn unexpected(text: &str) -> String {
    let text = shown(text.as_bytes());
    format!("unexpected answer `< {text} >`; is a socketcand server there?")
}

impl Protocol for Socketcand {
    fn begin(&mut self, listen_at: Option<u16>) -> Result<Vec<u8>, String> {
        match listen_at {
            None => Ok(Vec::new()),
            Some(_) => Err(
                "socketcand cannot change the bit rate; the computer of the server sets it, such as \
                 with `ip link set can0 type can bitrate 500000`"
                    .into(),
            ),
        }
    }

    fn take(&mut self, bytes: &mut Vec<u8>) -> Result<Option<Message>, String> {
        let Some(end) = bytes.iter().position(|byte| *byte == b'>') else {
            return Ok(None);
        };
        let message: Vec<u8> = bytes.drain(..=end).collect();
        let text = String::from_utf8_lossy(&message[..end]).into_owned();
        let (before, text) = match text.split_once('<') {
            Some((before, text)) => (before.trim(), text),
            None => (text.as_str(), ""),
        };
        match before {
            "" => self.message(text.trim()).map(Some),
            garbage => Err(unexpected(garbage)),
        }
    }

    fn write(&self, frame: &Frame, out: &mut Vec<u8>) {
        let (id, dlc) = (frame.id(), frame.dlc());
        let mut text = if frame.is_remote() {
            format!("< sendrtr {id} {dlc} ")
        } else {
            format!("< send {id} {dlc} ")
        };
        for byte in frame.data() {
            text.push_str(&format!("{byte:02X} "));
        }
        text.push('>');
        out.extend_from_slice(text.as_bytes());
    }
}
