//! Output to a terminal, a file, or a pipe that may close.

use std::io::{self, BufWriter, ErrorKind, IsTerminal, Write};
use std::path::Path;

use crate::failure::Failure;

/// Standard output, buffered. A reader that goes away is not a failure.
pub(crate) struct Output(BufWriter<io::StdoutLock<'static>>);

impl Output {
    pub(crate) fn new() -> Self {
        Self(BufWriter::new(io::stdout().lock()))
    }

    /// Writes a line. Answers whether anybody still reads.
    pub(crate) fn line(&mut self, line: &str) -> Result<bool, Failure> {
        open(writeln!(self.0, "{line}"))
    }

    /// Whatever is left goes out.
    pub(crate) fn flush(&mut self) -> Result<bool, Failure> {
        open(self.0.flush())
    }
}

/// A text and the end of its last line, to standard output.
pub(crate) fn print(text: &str) -> Result<(), Failure> {
    let mut output = Output::new();
    output.line(text.trim_end())?;
    output.flush().map(drop)
}

/// Writes a text to a file, or to standard output without a path.
pub(crate) fn save(path: Option<&Path>, text: &str) -> Result<(), Failure> {
    match path {
        Some(path) => write(path, format!("{}\n", text.trim_end()).as_bytes()),
        None => print(text),
    }
}

/// Writes a file.
pub(crate) fn write(path: &Path, bytes: &[u8]) -> Result<(), Failure> {
    std::fs::write(path, bytes).map_err(|error| {
        let shown = path.display();
        Failure::Failed(format!("{shown} cannot be written: {error}"))
    })
}

fn open(result: io::Result<()>) -> Result<bool, Failure> {
    match result {
        Ok(()) => Ok(true),
        Err(error) if error.kind() == ErrorKind::BrokenPipe => Ok(false),
        Err(error) => Err(Failure::Failed(format!("standard output: {error}"))),
    }
}

/// Prints a message of the argument parser where it belongs.
pub(crate) fn print_or_ignore(error: &clap::Error) {
    // If nobody listens there is nobody to tell.
    let _ = error.print();
}

/// One line on standard error, with our name before it.
pub(crate) fn error(message: &str) {
    note_text(&format!("odkit: {message}\n"));
}

/// A line on standard error. Unlike `eprintln!` it does not panic where nobody listens.
macro_rules! note {
    ($($argument:tt)*) => {
        $crate::output::note_text(&format!("{}\n", format_args!($($argument)*)))
    };
}
pub(crate) use note;

/// Text on standard error.
pub(crate) fn note_text(text: &str) {
    let _ = io::stderr().write_all(text.as_bytes());
}

/// May what goes to standard output be coloured?
pub(crate) fn colours() -> bool {
    io::stdout().is_terminal() && allowed()
}

/// May what goes to standard error be coloured?
pub(crate) fn error_colours() -> bool {
    io::stderr().is_terminal() && allowed()
}

fn allowed() -> bool {
    let set = |name| std::env::var_os(name).is_some_and(|value| !value.is_empty());
    !set("NO_COLOR") && std::env::var_os("TERM").is_none_or(|term| term != "dumb")
}
