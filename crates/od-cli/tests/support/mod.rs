//! `odkit` as a process.

#![allow(dead_code)] // each test file uses what it needs

pub(crate) mod crowd;
mod patience;
pub(crate) mod quiet;
pub(crate) mod sim;

use std::io::Write;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

/// Result of a run of `odkit`.
pub(crate) struct Done {
    /// Exit code.
    pub(crate) code: i32,
    /// Standard output.
    pub(crate) out: String,
    /// Standard error.
    pub(crate) err: String,
}

/// The binary under test, or the one that `ODKIT` names; always without colours. The test has a
/// time limit from here on.
pub(crate) fn command() -> Command {
    patience::limit();
    let built = || env!("CARGO_BIN_EXE_odkit").into();
    let mut command = Command::new(std::env::var_os("ODKIT").unwrap_or_else(built));
    command.env("NO_COLOR", "1");
    command
}

/// Runs `odkit` with these arguments and this standard input.
#[track_caller]
pub(crate) fn odkit(args: &[&str], input: &str) -> Done {
    let mut child = command()
        .args(args)
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .expect("odkit starts");
    let mut stdin = child.stdin.take().expect("a pipe");
    // A run that ends without reading its input closes the pipe.
    let _ = stdin.write_all(input.as_bytes());
    drop(stdin);
    let output = child.wait_with_output().expect("odkit ends");
    Done {
        code: output.status.code().expect("an exit code"),
        out: String::from_utf8(output.stdout).expect("UTF-8"),
        err: String::from_utf8(output.stderr).expect("UTF-8"),
    }
}

/// A file of this test run, with this content.
pub(crate) fn file(name: &str, content: &str) -> PathBuf {
    let path = Path::new(env!("CARGO_TARGET_TMPDIR")).join(name);
    std::fs::write(&path, content).expect("a folder for test files");
    path
}

/// A file of the repository.
pub(crate) fn repository(path: &str) -> String {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
    root.join(path).display().to_string()
}
