//! Texts for the user at the terminal.

use std::io::{self, ErrorKind, Write};
use std::sync::atomic::{AtomicBool, Ordering};

use od_model::Visible;

/// [`news`] prints nothing.
static QUIET: AtomicBool = AtomicBool::new(false);

/// Makes [`news`] print nothing from now on.
pub(super) fn be_quiet() {
    QUIET.store(true, Ordering::Relaxed);
}

/// Like [`note`], but for messages that are not problems.
pub(super) fn news(line: &str) {
    if !QUIET.load(Ordering::Relaxed) {
        note(line);
    }
}

/// Writes a line to standard error. Unlike `eprintln!` it does not panic if the pipe is closed.
pub(super) fn note(line: &str) {
    let _ = io::stderr().write_all(format!("{}\n", Visible(line).lines()).as_bytes());
}

/// Writes a line to standard output; a reader that closed its end is not an error.
pub(super) fn print(line: &str) -> io::Result<()> {
    let mut output = io::stdout().lock();
    let written = writeln!(output, "{}", Visible(line).lines()).and_then(|()| output.flush());
    match written {
        Err(error) if error.kind() == ErrorKind::BrokenPipe => Ok(()),
        Err(error) => Err(io::Error::other(format!("standard output: {error}"))),
        Ok(()) => Ok(()),
    }
}
