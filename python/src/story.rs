//! The inputs of a bench as a script that `odkit run` plays.

use std::fmt;

use od_model::{DataType, Kind};
use od_wire::{Frame, Instant};

/// Maximum number of lines; a longer run has no script.
const KEPT: usize = 1_000_000;

/// A line of a script.
#[derive(Clone, Debug)]
enum Line {
    /// Time passes to this moment, in microseconds.
    At(u64),
    /// A program sends a frame.
    Send(Frame),
    Text(String),
}

impl fmt::Display for Line {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::At(micros) => write!(f, "at {micros}us"),
            Self::Send(frame) => write!(f, "{frame}"),
            Self::Text(text) => f.write_str(text),
        }
    }
}

/// The lines of a script so far.
#[derive(Clone, Debug, Default)]
pub(crate) struct Story {
    lines: Vec<Line>,
    /// Time of the last line.
    last: Instant,
    /// The device of the last line.
    present: Option<usize>,
    /// The number of the first record of the journal that came at this moment, after the last line.
    pub(crate) fresh: usize,
    /// A line was added, and time has not moved since.
    pub(crate) acted: bool,
    /// The first action that scripts do not have.
    unplayable: Option<String>,
}

impl Story {
    /// Begins with the lines of a script that was played up to a moment.
    pub(crate) fn of(script: &str, last: Instant) -> Self {
        Self {
            lines: script
                .lines()
                .map(|line| Line::Text(line.to_owned()))
                .collect(),
            last,
            acted: true,
            ..Self::default()
        }
    }

    /// Adds the line of a new device, which gets the next number.
    pub(crate) fn device(&mut self, line: String, first: usize) {
        self.lines.push(Line::Text(line));
        self.present = Some(first);
        self.acted = true;
    }

    /// Adds an action at this moment, after these frames that devices sent at the same moment while others
    /// are still due. `device` is the device that it is about.
    pub(crate) fn add(&mut self, now: Instant, due: &[Frame], device: Option<usize>, line: &str) {
        self.reach(now, due);
        if self.lines.len() >= KEPT {
            self.cannot("more than 1,000,000 lines");
        }
        if self.unplayable.is_some() {
            return;
        }
        if let Some(device) = device.filter(|device| self.present != Some(*device)) {
            self.lines.push(Line::Text(format!("use {}", device + 1)));
            self.present = Some(device);
        }
        self.lines.push(Line::Text(line.to_owned()));
    }

    /// Adds a frame that a program sends at this moment; `due` as for `add`.
    pub(crate) fn send(&mut self, now: Instant, due: &[Frame], frame: Frame) {
        self.reach(now, due);
        if self.lines.len() >= KEPT {
            self.cannot("more than 1,000,000 lines");
        } else if self.unplayable.is_none() {
            self.lines.push(Line::Send(frame));
        }
    }

    /// The same at the end of a snapshot: its next line names its device, as after the script was played.
    pub(crate) fn ended(&self, now: Instant, due: &[Frame]) -> Self {
        let mut all = self.clone();
        all.reach(now, due);
        all.present = None;
        all
    }

    /// Adds an action that scripts do not have.
    pub(crate) fn cannot(&mut self, what: &str) {
        self.unplayable.get_or_insert_with(|| what.to_owned());
        self.lines = Vec::new();
    }

    /// Lets time pass to this moment, up to the last of these frames.
    pub(crate) fn reach(&mut self, now: Instant, due: &[Frame]) {
        let (at, last) = (now.as_micros(), self.last.as_micros());
        if self.unplayable.is_some() {
            return;
        }
        if due.is_empty() {
            // Other devices may act at the moment of the last line, too.
            if at > last || !self.acted {
                self.lines.push(Line::At(at));
            }
        } else {
            // The frames of the moment itself are not in the queue yet.
            let before = at.saturating_sub(1).max(last);
            self.lines.push(Line::At(before));
            self.lines.push(Line::Text(String::from("skip")));
            for frame in due {
                let within = at - before;
                let line = format!("expect {frame} within {within}us");
                self.lines.push(Line::Text(line));
            }
        }
        self.last = now;
        self.acted = true;
    }

    /// The script up to this moment.
    ///
    /// # Errors
    /// The action that scripts do not have.
    pub(crate) fn script(&self, now: Instant, due: &[Frame]) -> Result<String, String> {
        self.ended(now, due).text()
    }

    /// The lines so far.
    ///
    /// # Errors
    /// The action that scripts do not have.
    pub(crate) fn text(&self) -> Result<String, String> {
        match &self.unplayable {
            Some(what) => Err(format!("a script has no line for {what}")),
            None => Ok(self.lines.iter().map(|line| format!("{line}\n")).collect()),
        }
    }
}

/// A value in a line of a script; `None` if a line cannot have it.
pub(crate) fn value(data_type: DataType, bytes: &[u8]) -> Option<String> {
    let number = bytes
        .iter()
        .rev()
        .fold(0_u64, |value, byte| value << 8 | u64::from(*byte));
    let shift = 64 - 8 * bytes.len().clamp(1, 8) as u32;
    Some(match data_type.kind() {
        Kind::Boolean | Kind::Unsigned if bytes.len() <= 8 => number.to_string(),
        Kind::Signed if bytes.len() <= 8 => ((number << shift) as i64 >> shift).to_string(),
        Kind::Real => match *bytes {
            [a, b, c, d] => f32::from_le_bytes([a, b, c, d]).to_string(),
            _ => f64::from_bits(number).to_string(),
        },
        Kind::Text => {
            let text = std::str::from_utf8(bytes).ok()?;
            let plain = |letter: char| !letter.is_control() && letter != '"' && letter != '#';
            text.chars().all(plain).then(|| format!("\"{text}\""))?
        }
        _ => {
            let bytes: Vec<_> = bytes.iter().map(|byte| format!("{byte:02X}")).collect();
            format!("[{}]", bytes.join(" "))
        }
    })
}
