//! The client's side of slcan: an adapter on a serial line, a server of one, or `odkit sim`.

use od_bench::links::slcan;
use od_wire::{Duration, Frame};

use super::stream::{Protocol, Said, shown};

/// Bit rates in kbit/s, by their number in the command `S`.
const RATES: [u16; 9] = [10, 20, 50, 100, 125, 250, 500, 800, 1000];
/// Adapters that answer at all answer in this time.
const PATIENCE: Duration = Duration::from_millis(300);

/// State of the conversation with an adapter.
#[derive(Default)]
pub(super) struct Slcan {
    /// Bit rate in kbit/s that was asked for; `None`: the adapter keeps its own.
    rate: Option<u16>,
    /// Answers that are due before the channel is open.
    due: u8,
    /// The adapter has refused to open it.
    is_open: bool,
}

impl Slcan {
    pub(super) fn new(rate: Option<u16>) -> Self {
        Self {
            rate,
            ..Self::default()
        }
    }

    /// An answer without text: right, or wrong.
    fn answer(&mut self, is_right: bool) -> Result<Said, String> {
        if self.is_open {
            return match is_right {
                true => Ok(Said::Nothing),
                false => Err("the adapter refuses a frame; it may be bus-off".into()),
            };
        }
        self.due = self.due.saturating_sub(1);
        match (self.due, is_right) {
            (0, true) => {
                self.is_open = true;
                Ok(Said::Open)
            }
            (0, false) => Err(
                "the adapter does not open its CAN channel; give it a bit rate, such as with \
                 `--bit-rate 500`"
                    .into(),
            ),
            _ => Ok(Said::Nothing),
        }
    }
}

impl Protocol for Slcan {
    fn begin(&mut self, listen_at: Option<u16>) -> Result<Vec<u8>, String> {
        // The first end of line ends what an earlier host left.
        let mut text = String::from("\rC\r");
        self.due = 3;
        self.is_open = false;
        if let Some(rate) = listen_at.or(self.rate) {
            let number = RATES.iter().position(|one| *one == rate).ok_or_else(|| {
                let rates = RATES.map(|rate| rate.to_string()).join(", ");
                format!("slcan does not support {rate} kbit/s; write one of {rates}")
            })?;
            text.push_str(&format!("S{number}\r"));
            self.due += 1;
        }
        text.push_str(if listen_at.is_some() { "L\r" } else { "O\r" });
        Ok(text.into_bytes())
    }

    fn take(&mut self, bytes: &mut Vec<u8>) -> Result<Option<Said>, String> {
        let Some(end) = bytes.iter().position(|byte| matches!(byte, b'\r' | 0x07)) else {
            return Ok(None);
        };
        let line: Vec<u8> = bytes.drain(..=end).filter(|byte| *byte != b'\n').collect();
        let (line, is_right) = match line.split_last() {
            Some((last, line)) => (line, *last == b'\r'),
            None => return Ok(None),
        };
        if let Some(frame) = slcan::frame_of(line) {
            return Ok(Some(Said::Frame(frame)));
        }
        Ok(Some(match line {
            [] => self.answer(is_right)?,
            [b'z' | b'Z'] | [b'V' | b'v' | b'N' | b'F', ..] => Said::Nothing,
            // The end of a line whose beginning went to somebody else.
            _ if !self.is_open => Said::Nothing,
            line => {
                let line = shown(line);
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
        b"C\r"
    }
}
