//! The items of `binary-install` that wasm-pack imports. They download nothing.

use std::env;
use std::path::{Path, PathBuf};

use anyhow::{Result, bail};

/// A folder for tools.
pub struct Cache(PathBuf);

impl Cache {
    /// A folder for temporary files.
    pub fn new(name: &str) -> Result<Cache> {
        Ok(Cache(env::temp_dir().join(name)))
    }

    /// The cache in a folder.
    pub fn at(path: &Path) -> Cache {
        Cache(PathBuf::from(path))
    }

    /// A path in the cache.
    pub fn join(&self, path: &Path) -> PathBuf {
        self.0.join(path)
    }

    /// Returns `None` if downloads are not allowed, otherwise an error.
    pub fn download(
        &self,
        allowed: bool,
        name: &str,
        _: &[&str],
        url: &str,
    ) -> Result<Option<Download>> {
        if allowed {
            bail!("this wasm-pack does not use the network: `{name}` is not on PATH ({url})");
        }
        Ok(None)
    }
}

/// A folder with programs.
pub struct Download(PathBuf);

impl Download {
    /// The programs of a folder.
    pub fn at(path: &Path) -> Download {
        Download(PathBuf::from(path))
    }

    /// Returns the path of a program; an error if it is missing.
    pub fn binary(&self, name: &str) -> Result<PathBuf> {
        let path = self.0.join(format!("{name}{}", env::consts::EXE_SUFFIX));
        if !path.is_file() {
            bail!("{} is not there", path.display());
        }
        Ok(path)
    }
}
