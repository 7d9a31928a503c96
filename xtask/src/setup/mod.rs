//! Installs the tools that odkit's tasks need.

pub(crate) mod apt;
pub(crate) mod binaryen;
pub(crate) mod bindgen;
pub(crate) mod browser;
pub(crate) mod installed;
pub(crate) mod mdbook;
pub(crate) mod node;
pub(crate) mod python;
pub(crate) mod target;
pub(crate) mod toolchain;

use std::fs::{self, File, TryLockError};

use crate::console::Console;
use crate::error::{Error, Result};
use crate::repo::Repo;

/// One set-up at a time in one clone: held while tools are set up and the page is built; the system releases it, even
/// after a crash.
#[derive(Debug)]
pub(crate) struct SetupLock {
    _file: File,
}

impl SetupLock {
    /// Waits for another `cargo xtask` in this clone, and says so.
    pub(crate) fn acquire(repo: &Repo, console: &Console) -> Result<SetupLock> {
        let dir = repo.tools();
        fs::create_dir_all(&dir).map_err(|e| Error::io("create", &dir, &e))?;
        let path = dir.join("lock");
        let file = File::create(&path).map_err(|e| Error::io("create", &path, &e))?;
        match file.try_lock() {
            Ok(()) => {}
            Err(TryLockError::WouldBlock) => {
                console.note("waiting for another `cargo xtask` in this clone to finish its build");
                file.lock().map_err(|e| Error::io("lock", &path, &e))?;
            }
            Err(TryLockError::Error(e)) => return Err(Error::io("lock", &path, &e)),
        }
        Ok(SetupLock { _file: file })
    }
}
