//! The client side of slcan: an adapter on a serial line, an slcan server, or `odkit sim`.

use od_sim::links::adapter::{self, Adapter, Opening, RATES};
use od_sim::links::slcan;
use od_wire::{Duration, Frame};

use super::stamps::Stamp;
use super::stream::{Message, Protocol, shown};

/// Maximum time to wait for the response of an adapter; some never respond.
const PATIENCE: Duration = Duration::from_millis(300);

/// State of the conversation with an adapter.
#[derive(Default)]
pub(super) struct Slcan {
    /// Requested bit rate in kbit/s; `None`: the adapter keeps its own.
    rate: Option<u16>,
    /// Whether to request time stamps.
    stamps: bool,
    /// Greatest time stamp so far, in milliseconds.
    greatest: u16,
    adapter: Adapter,
}

impl Slcan {
    /// A client that sets the bit rate, if there is one, and requests time stamps from the adapter.
    pub(super) fn new(rate: Option<u16>, stamps: bool) -> Self {
        Self {
            rate,
            stamps,
            ..Self::default()
        }
    }
}

impl Slcan {
    /// The time stamp of a frame. The clock of an adapter begins again after a minute, or after 65,536 ms.
    fn stamp(&mut self, line: &[u8]) -> Option<Stamp> {
        let millis = slcan::stamp_of(line)?;
        self.greatest = self.greatest.max(millis);
        let period = if self.greatest < 60_000 {
            60_000
        } else {
            65_536
        };
        Some(Stamp {
            micros: u64::from(millis) * 1000,
            period: period * 1000,
        })
    }
}

impl Protocol for Slcan {
    fn begin(&mut self, listen_at: Option<u16>) -> Result<Vec<u8>, String> {
        let rate = listen_at.or(self.rate);
        let opening = Opening {
            rate,
            listens: listen_at.is_some(),
            stamps: self.stamps,
        };
        self.adapter.begin(opening).ok_or_else(|| {
            let rates = RATES.map(|rate| rate.to_string()).join(", ");
            let rate = rate.unwrap_or_default();
            format!("slcan does not support {rate} kbit/s; write one of {rates}")
        })
    }

    fn take(&mut self, bytes: &mut Vec<u8>) -> Result<Option<Message>, String> {
        let Some(end) = bytes.iter().position(|byte| matches!(byte, b'\r' | 0x07)) else {
            return Ok(None);
        };
        let line: Vec<u8> = bytes.drain(..=end).filter(|byte| *byte != b'\n').collect();
        let (line, is_right) = match line.split_last() {
            Some((last, line)) => (line, *last == b'\r'),
            None => return Ok(None),
        };
        Ok(Some(match self.adapter.line(line, is_right) {
            adapter::Message::Frame(frame) => Message::Frame(frame, self.stamp(line)),
            adapter::Message::Open => Message::Open,
            adapter::Message::Nothing => Message::Nothing,
            adapter::Message::Closed => {
                return Err(
                    "the adapter does not open its CAN channel; give it a bit rate, such as with \
                     `--bit-rate 500`"
                        .into(),
                );
            }
            adapter::Message::Refused => {
                return Err("the adapter refuses a frame; it may be bus-off".into());
            }
            adapter::Message::Noise(line) => {
                let line = shown(&line);
                return Err(format!(
                    "unexpected line `{line}`; is an slcan adapter there, at this baud rate?"
                ));
            }
        }))
    }

    fn write(&self, frame: &Frame, out: &mut Vec<u8>) {
        slcan::write_frame(frame, out);
        out.push(b'\r');
    }

    fn patience(&self) -> (Duration, bool) {
        (PATIENCE, true)
    }

    fn end(&self) -> &'static [u8] {
        if self.stamps { b"C\rZ0\r" } else { b"C\r" }
    }
}
