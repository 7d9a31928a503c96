//! The files of this run: an output never replaces a file that the run has read or written.

use std::fs::{self, File};
use std::io::{self, Read};
use std::path::{Path, PathBuf};
use std::sync::{Mutex, MutexGuard, PoisonError};

use od_sim::serve::files::Files;

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
    let bytes = fs::read(path)?;
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
    io::stdin().lock().read_to_end(&mut bytes)?;
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

/// Makes an output, empty.
///
/// # Errors
/// The run uses this file already, or it cannot be written.
pub(crate) fn create(path: &Path) -> Result<File, Failure> {
    if !lock(&CLAIMED).iter().any(|claimed| claimed == path) {
        claim(path)?;
    }
    lock(&CLAIMED).retain(|claimed| claimed != path);
    File::create(path).map_err(|error| {
        let shown = path.display();
        Failure::Failed(format!("{shown} cannot be written: {error}"))
    })
}
