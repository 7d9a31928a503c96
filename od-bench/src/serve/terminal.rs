//! Texts for the person at the terminal.

use std::io::{self, ErrorKind, Write};

/// Writes a line to standard error. Unlike `eprintln!` it does not panic if nobody reads.
pub(super) fn note(line: &str) {
    let _ = io::stderr().write_all(format!("{line}\n").as_bytes());
}

/// Writes a line to standard output; a reader that left is not an error.
pub(super) fn print(line: &str) -> io::Result<()> {
    let mut output = io::stdout().lock();
    let written = writeln!(output, "{line}").and_then(|()| output.flush());
    match written {
        Err(error) if error.kind() == ErrorKind::BrokenPipe => Ok(()),
        Err(error) => Err(io::Error::other(format!("standard output: {error}"))),
        Ok(()) => Ok(()),
    }
}
