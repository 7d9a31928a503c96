//! Fingerprints of inputs: a step is skipped if its inputs did not change.

use std::fs;
use std::path::{Path, PathBuf};

use crate::error::{Error, Result};

/// 64-bit FNV-1a. It detects changes, and is not for security.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Fingerprint(u64);

impl Fingerprint {
    /// The fingerprint of nothing.
    pub(crate) fn new() -> Fingerprint {
        Fingerprint(0xcbf2_9ce4_8422_2325)
    }

    /// Adds bytes and their length, so that two neighbouring inputs differ from their concatenation.
    pub(crate) fn bytes(mut self, bytes: &[u8]) -> Fingerprint {
        for byte in bytes.iter().chain(&(bytes.len() as u64).to_le_bytes()) {
            self.0 = (self.0 ^ u64::from(*byte)).wrapping_mul(0x0000_0100_0000_01b3);
        }
        self
    }

    /// Adds a text.
    pub(crate) fn text(self, text: &str) -> Fingerprint {
        self.bytes(text.as_bytes())
    }

    /// Adds a file's content; a missing file is an error.
    pub(crate) fn file(self, path: &Path) -> Result<Fingerprint> {
        let bytes = fs::read(path).map_err(|e| Error::io("read", path, &e))?;
        Ok(self.bytes(&bytes))
    }

    /// Sixteen hexadecimal digits.
    pub(crate) fn hex(self) -> String {
        format!("{:016x}", self.0)
    }
}

/// A file that records the inputs of the last completed step.
#[derive(Debug)]
pub(crate) struct Stamp {
    path: PathBuf,
    value: String,
}

impl Stamp {
    /// The stamp at `path` for these inputs.
    pub(crate) fn new(path: PathBuf, inputs: Fingerprint) -> Stamp {
        let value = inputs.hex();
        Stamp { path, value }
    }

    /// Returns whether the step was done for these inputs and its `outputs` still exist.
    pub(crate) fn is_current(&self, outputs: &[&Path]) -> bool {
        outputs.iter().all(|path| path.exists())
            && fs::read_to_string(&self.path).is_ok_and(|seen| seen == self.value)
    }

    /// Removes the record, so that a step that is interrupted counts as not done.
    pub(crate) fn clear(&self) {
        let _ = fs::remove_file(&self.path);
    }

    /// Records that the step was done.
    pub(crate) fn set(&self) -> Result<()> {
        if let Some(dir) = self.path.parent() {
            fs::create_dir_all(dir).map_err(|e| Error::io("create", dir, &e))?;
        }
        fs::write(&self.path, &self.value).map_err(|e| Error::io("write", &self.path, &e))
    }
}

#[cfg(test)]
mod tests {
    use super::{Fingerprint, Stamp};

    #[test]
    fn the_limit_between_two_inputs_counts() {
        let a = Fingerprint::new().text("ab").text("c");
        let b = Fingerprint::new().text("a").text("bc");
        assert_ne!(a.hex(), b.hex());
    }

    #[test]
    fn a_stamp_holds_for_its_inputs_and_outputs_only() {
        let dir = std::env::temp_dir().join(format!("xtask-stamp-{}", std::process::id()));
        let path = dir.join("stamp");
        let stamp = Stamp::new(path.clone(), Fingerprint::new().text("1"));
        assert!(!stamp.is_current(&[]));
        stamp.set().expect("a temporary directory is writable");
        assert!(stamp.is_current(&[&path]));
        assert!(!stamp.is_current(&[&dir.join("gone")]));
        let other = Stamp::new(path, Fingerprint::new().text("2"));
        assert!(!other.is_current(&[]));
        stamp.clear();
        assert!(!stamp.is_current(&[]));
        let _ = std::fs::remove_dir_all(&dir);
    }
}
