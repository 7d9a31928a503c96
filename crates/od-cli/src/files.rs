//! The files of this run: an output never replaces a file that the run has read or written.

use std::fs::File;
use std::io;
use std::path::{Path, PathBuf};
use std::sync::{Mutex, MutexGuard, PoisonError};

use od_sim::serve::files::{self, Files};

use crate::failure::Failure;

/// The files that were read and written so far.
static FILES: Mutex<Files> = Mutex::new(Files::new());

/// Outputs that are reserved and not yet created.
static CLAIMED: Mutex<Vec<PathBuf>> = Mutex::new(Vec::new());

fn lock<T>(mutex: &'static Mutex<T>) -> MutexGuard<'static, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Reads an input.
///
/// # Errors
/// The file cannot be read, or the run has written it.
pub(crate) fn read(path: impl AsRef<Path>) -> io::Result<Vec<u8>> {
    let path = path.as_ref();
    let bytes = files::read(path)?;
    let title = format!("the input `{}`", path.display());
    let added = lock(&FILES).read(title, path);
    added.map_err(|refused| io::Error::other(refused.to_string()))?;
    Ok(bytes)
}

/// Reads an input, or standard input if the path is `-`.
///
/// # Errors
/// Those of [`read`].
pub(crate) fn read_or_stdin(path: impl AsRef<Path>) -> io::Result<Vec<u8>> {
    let path = path.as_ref();
    if path.as_os_str() != "-" {
        return read(path);
    }
    let mut bytes = Vec::new();
    io::Read::read_to_end(&mut io::stdin().lock(), &mut bytes)?;
    Ok(bytes)
}

/// Reserves the path of an output that is [made](create) at the end of a long run.
///
/// # Errors
/// The run uses this file already.
pub(crate) fn claim(path: &Path) -> Result<(), Failure> {
    let title = format!("the output `{}`", path.display());
    lock(&FILES).write(title, path)?;
    lock(&CLAIMED).push(path.to_owned());
    Ok(())
}

/// Makes an output that grows while the command runs, empty.
///
/// # Errors
/// The run uses this file already, or it cannot be written.
pub(crate) fn create(path: &Path) -> Result<File, Failure> {
    begin(path)?;
    File::create(path).map_err(|error| failed(path, &error))
}

/// Writes outputs, each in one step: a file has its old content or the new one. Either all are replaced, or, if one cannot
/// be written, none.
///
/// # Errors
/// The run uses a file already, or it cannot be written.
pub(crate) fn write(outputs: &[(&Path, &[u8])]) -> Result<(), Failure> {
    for (path, _) in outputs {
        begin(path)?;
    }
    files::replace(outputs).map_err(|(path, error)| failed(&path, &error))
}

/// Replaces an input that the run has corrected, in one step.
///
/// # Errors
/// It cannot be written, in words.
pub(crate) fn rewrite(path: &str, bytes: &[u8]) -> Result<(), String> {
    let replaced = files::replace(&[(Path::new(path), bytes)]);
    replaced.map_err(|(_, error)| format!("it cannot be written: {error}"))
}

/// Reserves the path of an output, unless it is reserved already.
fn begin(path: &Path) -> Result<(), Failure> {
    if !lock(&CLAIMED).iter().any(|claimed| claimed == path) {
        claim(path)?;
    }
    lock(&CLAIMED).retain(|claimed| claimed != path);
    Ok(())
}

fn failed(path: &Path, error: &io::Error) -> Failure {
    let shown = path.display();
    Failure::Failed(format!("{shown} cannot be written: {error}"))
}
