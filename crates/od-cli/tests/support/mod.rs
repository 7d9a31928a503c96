//! `odkit` as a process.

#![allow(dead_code)] // each test file uses what it needs

pub(crate) mod crowd;
mod patience;
pub(crate) mod quiet;
pub(crate) mod sim;

use std::fs;
use std::io::Write;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

use tempfile::TempDir;

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

/// An empty folder that is removed when the value is dropped. Its path is short enough for a socket in it.
pub(crate) fn temporary() -> TempDir {
    let folder = tempfile::Builder::new().prefix("odkit-").tempdir();
    folder.expect("a folder for temporary files")
}

/// A path among the files of this test run. What an earlier run left there is removed.
pub(crate) fn fresh(name: &str) -> PathBuf {
    let path = Path::new(env!("CARGO_TARGET_TMPDIR")).join(name);
    let _ = fs::remove_dir_all(&path);
    let _ = fs::remove_file(&path);
    path
}

/// A file of this test run, with this content.
pub(crate) fn file(name: &str, content: &str) -> PathBuf {
    let path = Path::new(env!("CARGO_TARGET_TMPDIR")).join(name);
    fs::write(&path, content).expect("a folder for test files");
    path
}

/// A folder of this test run with these files and no others.
pub(crate) fn folder(name: &str, files: &[(&str, &str)]) -> PathBuf {
    let folder = fresh(name);
    fs::create_dir_all(&folder).expect("a folder for test files");
    for (path, content) in files {
        let path = folder.join(path);
        fs::create_dir_all(path.parent().expect("a folder")).expect("a folder for test files");
        fs::write(path, content).expect("a folder for test files");
    }
    folder
}

/// The text of a file in a folder.
#[track_caller]
pub(crate) fn read(folder: &Path, name: &str) -> String {
    fs::read_to_string(folder.join(name)).unwrap_or_else(|error| panic!("{name}: {error}"))
}

/// A file of the repository.
pub(crate) fn repository(path: &str) -> String {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
    root.join(path).display().to_string()
}
