//! Output to a terminal, a file, or a pipe that may close.

use std::borrow::Cow;
use std::fmt::Display;
use std::io::{self, BufWriter, ErrorKind, IsTerminal, Write};
use std::path::Path;

use od_model::Visible;

use crate::failure::Failure;
use crate::files;

/// The form of a text that is safe for a terminal: hidden characters, which names of files and devices may
/// contain, are escaped. JSON stays JSON with the same strings.
fn shown(text: &str) -> Cow<'_, str> {
    let lines = Visible(text).lines();
    let is_json = |text| serde_json::from_str::<serde::de::IgnoredAny>(text).is_ok();
    match lines {
        Cow::Owned(_) if text.starts_with(['{', '[']) && is_json(text) => Visible(text).json(),
        lines => lines,
    }
}

/// As [`shown`], with the colours of a report: `ESC [ 1 ; 3 1 m`.
fn coloured(text: &str) -> String {
    let mut pieces = text.split("\x1b[");
    let mut out = shown(pieces.next().unwrap_or_default()).into_owned();
    for piece in pieces {
        let end = piece.find(|c: char| !c.is_ascii_digit() && c != ';');
        let begin = match end {
            Some(end) if piece[end..].starts_with('m') => "\x1b[",
            _ => "\\u{1b}[",
        };
        out.push_str(begin);
        out.push_str(&shown(piece));
    }
    out
}

/// Standard output, buffered. A reader that goes away is not a failure.
pub(crate) struct Output(BufWriter<io::StdoutLock<'static>>);

impl Output {
    pub(crate) fn new() -> Self {
        Self(BufWriter::new(io::stdout().lock()))
    }

    /// Writes a line. Returns whether the reader is still there.
    pub(crate) fn line(&mut self, line: &str) -> Result<bool, Failure> {
        open(writeln!(self.0, "{}", shown(line)))
    }

    /// As [`line`](Self::line), for a text with colours.
    pub(crate) fn coloured(&mut self, text: &str) -> Result<bool, Failure> {
        if colours() {
            open(writeln!(self.0, "{}", coloured(text)))
        } else {
            self.line(text)
        }
    }

    /// Writes the rest of the buffer.
    pub(crate) fn flush(&mut self) -> Result<bool, Failure> {
        open(self.0.flush())
    }
}

/// Writes a text to standard output, with the end of its last line.
pub(crate) fn print(text: &str) -> Result<(), Failure> {
    let mut output = Output::new();
    output.line(text.trim_end())?;
    output.flush().map(drop)
}

/// Writes a text to standard output unchanged and at once.
pub(crate) fn print_raw(text: &str) -> io::Result<()> {
    let mut output = io::stdout().lock();
    output.write_all(text.as_bytes())?;
    output.flush()
}

/// Writes a text to a file, or to standard output without a path.
pub(crate) fn save(path: Option<&Path>, text: &str) -> Result<(), Failure> {
    match path {
        Some(path) => write(path, format!("{}\n", text.trim_end()).as_bytes()),
        None => print(text),
    }
}

/// Writes a file.
///
/// # Errors
/// The run uses this file already, or it cannot be written.
pub(crate) fn write(path: &Path, bytes: &[u8]) -> Result<(), Failure> {
    files::write(&[(path, bytes)])
}

fn open(result: io::Result<()>) -> Result<bool, Failure> {
    match result {
        Ok(()) => Ok(true),
        Err(error) if error.kind() == ErrorKind::BrokenPipe => Ok(false),
        Err(error) => Err(Failure::Failed(format!("standard output: {error}"))),
    }
}

/// Prints a message of the argument parser where it belongs: the help on standard output, an error, which quotes the
/// arguments, on standard error.
pub(crate) fn print_or_ignore(error: &clap::Error) {
    if error.use_stderr() {
        note_text(&error.render().to_string());
    } else {
        // Without a listener the help cannot be shown.
        let _ = error.print();
    }
}

/// Prints a line on standard error that begins with `odkit:`.
pub(crate) fn error(message: &str) {
    note_text(&format!("odkit: {message}\n"));
}

/// Prints a line on standard error. Unlike `eprintln!` it does not panic without a listener.
macro_rules! note {
    ($($argument:tt)*) => {
        $crate::output::note_text(&format!("{}\n", format_args!($($argument)*)))
    };
}
pub(crate) use note;

/// Number of the problems of one file that are shown.
const PROBLEMS: usize = 10;

/// Prints the first problems of a file on standard error, each on a line, and the number of the others.
pub(crate) fn problems(path: impl Display, mut lines: impl ExactSizeIterator<Item = String>) {
    for line in lines.by_ref().take(PROBLEMS) {
        note!("{line}");
    }
    match lines.len() {
        0 => {}
        others => note!("{path}: {others} more"),
    }
}

/// Prints a text on standard error.
pub(crate) fn note_text(text: &str) {
    let _ = io::stderr().write_all(shown(text).as_bytes());
}

/// As [`note_text`], for a text with colours.
pub(crate) fn note_coloured(text: &str) {
    if error_colours() {
        drop(io::stderr().write_all(coloured(text).as_bytes()))
    } else {
        note_text(text)
    }
}

/// Returns whether a text on standard output may have colours.
pub(crate) fn colours() -> bool {
    io::stdout().is_terminal() && allowed()
}

/// Returns whether a text on standard error may have colours.
pub(crate) fn error_colours() -> bool {
    io::stderr().is_terminal() && allowed()
}

fn allowed() -> bool {
    let set = |name| std::env::var_os(name).is_some_and(|value| !value.is_empty());
    !set("NO_COLOR") && std::env::var_os("TERM").is_none_or(|term| term != "dumb")
}

/// Progress bar on a terminal; without a terminal it prints nothing.
pub(crate) struct Bar {
    what: &'static str,
    /// The percentage that is shown; `None`: the bar is not visible.
    shown: Option<u8>,
    is_terminal: bool,
    /// Number of transferred bytes, estimated from the frames.
    bytes: usize,
    /// Size of the value in bytes; 0: not known.
    total: usize,
}

impl Bar {
    pub(crate) fn new(what: &'static str) -> Self {
        Self {
            what,
            shown: None,
            is_terminal: io::stderr().is_terminal(),
            bytes: 0,
            total: 0,
        }
    }

    /// Shows a percentage, 0 to 100.
    pub(crate) fn show(&mut self, percent: u8) {
        if self.is_terminal && self.shown != Some(percent) {
            self.shown = Some(percent);
            let done = usize::from(percent.min(100)) * 40 / 100;
            let (what, bar) = (self.what, "#".repeat(done));
            note_text(&format!("\r{what} [{bar:<40}] {percent:>3} %"));
        }
    }

    /// Counts a frame of an upload; the first response may contain the size.
    pub(crate) fn transfer(&mut self, frame: &od_wire::Frame) {
        let id = frame.id().as_standard().unwrap_or(0);
        if !(0x581..=0x5FF).contains(&id) {
            return;
        }
        let [first, _, _, _, size @ ..] = *frame.bytes();
        // The responses to initiate upload and block upload that contain a size.
        let is_first = self.bytes == 0 && (first & 0xE3 == 0x41 || first & 0xE3 == 0xC2);
        if is_first {
            self.total = u32::from_le_bytes(size) as usize;
        } else {
            self.count();
        }
    }

    /// Counts a frame of a download of `total` bytes.
    pub(crate) fn transfer_of(&mut self, frame: &od_wire::Frame, total: usize) {
        self.total = total;
        if matches!(frame.id().as_standard(), Some(0x601..=0x67F)) {
            self.count();
        }
    }

    /// Adds the seven bytes of a segment.
    fn count(&mut self) {
        self.bytes += 7;
        let percent = (100 * self.bytes).checked_div(self.total).unwrap_or(0);
        self.show(percent.min(100) as u8);
    }

    /// Removes the bar.
    pub(crate) fn clear(&mut self) {
        if self.shown.take().is_some() {
            note_text(&format!("\r{:60}\r", ""));
        }
    }
}

impl Drop for Bar {
    fn drop(&mut self) {
        self.clear();
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn json_stays_json_and_colours_stay() {
        assert_eq!(shown("a\x1b\nb"), "a\\u{1b}\nb");
        assert_eq!(shown("{\"a\": \"\u{9b}\"}"), "{\"a\": \"\\u009b\"}");
        assert_eq!(shown("{\u{9b}"), "{\\u{9b}");
        assert_eq!(coloured("\x1b[1;31mred\x1b[0m"), "\x1b[1;31mred\x1b[0m");
        assert_eq!(
            coloured("\x1b[2J\x1b]0;x\x07"),
            "\\u{1b}[2J\\u{1b}]0;x\\u{7}"
        );
    }
}
