//! Storage in a file of fixed size.

use core::fmt;
use std::fs::OpenOptions;
use std::io::{self, Read, Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};
use std::vec::Vec;

use super::{Storage, StorageError};

/// The first bytes of such a file, so that no other is ever taken for one.
const SIGNATURE: &[u8; 16] = b"odkit EEPROM 1\r\n";

/// Value of an erased byte.
const ERASED: u8 = 0xFF;

/// Storage in a file: [`Storage::flush`] puts it on the disk.
#[derive(Debug)]
pub struct File {
    file: std::fs::File,
    capacity: usize,
}

/// Why a file is not used.
#[derive(Debug)]
#[non_exhaustive]
pub enum OpenError {
    /// The operating system says no.
    Io(PathBuf, io::Error),
    /// The file is something else.
    Foreign(PathBuf),
    /// The file is too small for this device.
    TooSmall {
        /// The file.
        path: PathBuf,
        /// Bytes that it holds.
        has: usize,
        /// Bytes that the device needs.
        needs: usize,
    },
}

impl fmt::Display for OpenError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Io(path, error) => write!(
                f,
                "{}: {error}; check the path and its permissions",
                path.display()
            ),
            Self::Foreign(path) => write!(
                f,
                "{}: not an EEPROM file of odkit, so it is left as it is; \
                 give another path, or remove the file to start with an empty EEPROM",
                path.display()
            ),
            Self::TooSmall { path, has, needs } => write!(
                f,
                "{}: an EEPROM of {has} bytes, and this device needs {needs}; \
                 give another path, or remove the file to start with an empty EEPROM",
                path.display()
            ),
        }
    }
}

impl std::error::Error for OpenError {}

impl File {
    /// Opens the file at `path`, or makes it, erased, with `capacity` bytes.
    ///
    /// A file that is larger keeps its size. What is in the file stays.
    ///
    /// # Errors
    /// [`OpenError`]; a file that is something else is never written to.
    pub fn open(path: impl AsRef<Path>, capacity: usize) -> Result<Self, OpenError> {
        let path = path.as_ref();
        let fail = |error| OpenError::Io(path.into(), error);
        let mut file = OpenOptions::new()
            .read(true)
            .write(true)
            .create(true)
            .truncate(false)
            .open(path)
            .map_err(fail)?;
        // Only as much of a foreign file as tells that it is one.
        let mut start = Vec::new();
        let fresh = (SIGNATURE.len() + capacity) as u64;
        (&mut file)
            .take(fresh)
            .read_to_end(&mut start)
            .map_err(fail)?;
        let metadata = file.metadata().map_err(fail)?;
        let len = metadata.len();
        let (signature, rest) = start.split_at(start.len().min(SIGNATURE.len()));
        if !SIGNATURE.starts_with(signature) || !metadata.is_file() {
            return Err(OpenError::Foreign(path.into()));
        }
        if len < fresh {
            // New, or power went while it was made: nothing but erased bytes so far.
            if rest.iter().any(|byte| *byte != ERASED) {
                return Err(OpenError::TooSmall {
                    path: path.into(),
                    has: rest.len(),
                    needs: capacity,
                });
            }
            let mut bytes = SIGNATURE.to_vec();
            bytes.resize(SIGNATURE.len() + capacity, ERASED);
            file.seek(SeekFrom::Start(0)).map_err(fail)?;
            file.write_all(&bytes).map_err(fail)?;
            file.sync_all().map_err(fail)?;
        }
        let capacity = (len.max(fresh) - SIGNATURE.len() as u64) as usize;
        Ok(Self { file, capacity })
    }

    fn seek(&mut self, offset: usize, len: usize) -> Result<(), StorageError> {
        match offset.checked_add(len) {
            Some(end) if end <= self.capacity => {}
            _ => return Err(StorageError::OutOfRange),
        }
        let at = (SIGNATURE.len() + offset) as u64;
        match self.file.seek(SeekFrom::Start(at)) {
            Ok(_) => Ok(()),
            Err(_) => Err(StorageError::Device),
        }
    }
}

impl Storage for File {
    fn capacity(&self) -> usize {
        self.capacity
    }

    fn read(&mut self, offset: usize, to: &mut [u8]) -> Result<(), StorageError> {
        self.seek(offset, to.len())?;
        self.file.read_exact(to).map_err(|_| StorageError::Device)
    }

    fn write(&mut self, offset: usize, bytes: &[u8]) -> Result<(), StorageError> {
        self.seek(offset, bytes.len())?;
        self.file.write_all(bytes).map_err(|_| StorageError::Device)
    }

    fn flush(&mut self) -> Result<(), StorageError> {
        self.file.sync_data().map_err(|_| StorageError::Device)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::string::ToString;
    use std::{env, fs, process};

    fn path(name: &str) -> PathBuf {
        env::temp_dir().join(std::format!("odkit-{}-{name}", process::id()))
    }

    #[test]
    fn what_is_written_is_there_when_it_is_opened_again() {
        let path = path("again");
        let mut file = File::open(&path, 64).unwrap();
        let mut byte = [0];
        file.read(63, &mut byte).unwrap();
        assert_eq!(byte, [ERASED]);
        file.write(60, b"last").unwrap();
        file.flush().unwrap();
        assert_eq!(file.write(61, b"last"), Err(StorageError::OutOfRange));
        assert_eq!(
            file.read(usize::MAX, &mut byte),
            Err(StorageError::OutOfRange)
        );
        drop(file);

        let mut file = File::open(&path, 32).unwrap();
        assert_eq!(file.capacity(), 64, "a larger file keeps its size");
        let mut bytes = [0; 4];
        file.read(60, &mut bytes).unwrap();
        assert_eq!(&bytes, b"last");
        let error = File::open(&path, 65).unwrap_err().to_string();
        assert!(
            error.contains("64 bytes") && error.contains("needs 65"),
            "{error}"
        );
        fs::remove_file(path).unwrap();
    }

    #[test]
    fn a_file_of_somebody_else_is_left_alone() {
        let path = path("foreign");
        for content in [
            "a letter to somebody, and longer than an EEPROM",
            "short",
            "odkit EEPROM 2\r\n",
        ] {
            fs::write(&path, content).unwrap();
            let error = File::open(&path, 16).unwrap_err().to_string();
            assert!(error.contains("left as it is"), "{error}");
            assert_eq!(fs::read_to_string(&path).unwrap(), content);
        }
        let error = File::open(env::temp_dir(), 16).unwrap_err();
        assert!(matches!(error, OpenError::Io(..)), "{error}");
        fs::remove_file(path).unwrap();
    }

    #[test]
    fn a_file_that_was_not_finished_is_new() {
        let path = path("unfinished");
        for len in 0..SIGNATURE.len() + 8 {
            let mut bytes = SIGNATURE.to_vec();
            bytes.resize(SIGNATURE.len() + 8, ERASED);
            fs::write(&path, &bytes[..len]).unwrap();
            assert_eq!(File::open(&path, 8).unwrap().capacity(), 8);
            assert_eq!(fs::read(&path).unwrap(), bytes);
        }
        fs::remove_file(path).unwrap();
    }
}
