//! Storage in a file: a header that names its device, and the bytes of an EEPROM.

use std::format;
use std::fs::{OpenOptions, TryLockError};
use std::io::{self, ErrorKind, Read, Seek, SeekFrom, Write};
use std::path::Path;
use std::process;
use std::string::String;
use std::vec;
use std::vec::Vec;

use od_model::Dictionary;

use self::header::{Header, LEN, SIGNATURE, Seen};
use super::image;
use super::{Storage, StorageError};

mod error;
mod header;

pub use error::OpenError;
pub use header::Owner;

/// Value of an erased byte.
const ERASED: u8 = 0xFF;

/// Value of a byte that is missing in the file: neither erased nor written.
const LOST: u8 = 0x03;

/// Storage in a file. [`Storage::flush`] writes it to the disk. While it is open, neither another
/// process nor another device of this process can open it.
#[derive(Debug)]
pub struct File {
    file: std::fs::File,
    capacity: usize,
    repaired: Option<String>,
}

impl File {
    /// Opens the file at `path`, or creates it with `capacity` erased bytes.
    ///
    /// The values in the file stay. The file belongs to the device that it was made for; another
    /// device is refused ([`OpenError::Foreign`]).
    ///
    /// # Errors
    /// [`OpenError`]; the file is unchanged then.
    pub fn open(
        path: impl AsRef<Path>,
        capacity: usize,
        owner: &Owner<'_>,
    ) -> Result<Self, OpenError> {
        Self::start(path.as_ref(), capacity, owner, false)
    }

    /// As [`open`](Self::open), for the device of a dictionary: its identity is vendor-ID and
    /// product code (1018h), and the capacity is enough for all values.
    ///
    /// # Errors
    /// [`OpenError`]; the file is unchanged then.
    pub fn of(path: impl AsRef<Path>, dictionary: &Dictionary<'_>) -> Result<Self, OpenError> {
        let number = |sub| match dictionary.entry(0x1018, sub) {
            Some(entry) => entry.default.integer(0).unwrap_or_default(),
            None => 0,
        };
        let identity = format!("vendor-ID {:X}h, product code {:X}h", number(1), number(2));
        let owner = Owner {
            name: &identity,
            identity: &identity,
            device: image::device(dictionary),
        };
        Self::open(path, image::capacity_needed(dictionary), &owner)
    }

    /// As [`open`](Self::open), but erases the file, whichever device of odkit it belonged to.
    ///
    /// # Errors
    /// [`OpenError`], if the file is not an EEPROM file of odkit or is in use; it is unchanged
    /// then.
    pub fn open_erased(
        path: impl AsRef<Path>,
        capacity: usize,
        owner: &Owner<'_>,
    ) -> Result<Self, OpenError> {
        Self::start(path.as_ref(), capacity, owner, true)
    }

    /// Returns a sentence about damage of the file that was repaired, if there was any.
    pub fn repaired(&self) -> Option<&str> {
        self.repaired.as_deref()
    }

    fn start(
        path: &Path,
        capacity: usize,
        owner: &Owner<'_>,
        erased: bool,
    ) -> Result<Self, OpenError> {
        let fail = |error| OpenError::Io(path.into(), error);
        let mut options = OpenOptions::new();
        options.read(true).write(true).create(true).truncate(false);
        let was_there = path.exists();
        let mut file = options.open(path).map_err(fail)?;
        let metadata = file.metadata().map_err(fail)?;
        if !metadata.is_file() {
            return Err(OpenError::NotEeprom(path.into()));
        }
        lock(&mut file, path)?;
        // Of another file, only the bytes that show its kind are read.
        let mut header = Vec::new();
        let read = (&mut file).take(LEN as u64).read_to_end(&mut header);
        read.map_err(fail)?;
        let seen = Header::read(&header);
        if seen == Seen::Other {
            return Err(OpenError::NotEeprom(path.into()));
        }
        let mut rest = Vec::new();
        file.read_to_end(&mut rest).map_err(fail)?;
        let mut opened = Self {
            file,
            capacity: rest.len(),
            repaired: None,
        };
        // Number of bytes of the file when it was made.
        let whole = match &seen {
            Seen::Whole(header) => LEN + header.capacity,
            Seen::Version(_) => 0,
            _ => LEN + capacity,
        };
        let has = header.len() + rest.len();
        let is_fresh = erased || !opened.find_values(path, owner, seen, &header, &rest)?;
        if is_fresh {
            opened.capacity = capacity;
            if was_there && !erased && has < whole {
                opened.repaired = Some(format!(
                    "the file has {has} of {whole} bytes, and no saved values; the device starts with its defaults"
                ));
            }
        } else if opened.capacity < capacity {
            return Err(OpenError::TooSmall {
                path: path.into(),
                has: opened.capacity,
                needs: capacity,
            });
        }
        opened.complete(owner, is_fresh, rest.len()).map_err(fail)?;
        Ok(opened)
    }

    /// Returns whether the file has saved values of this device. Then its capacity is that of its
    /// header, and a damaged header is noted as repaired.
    fn find_values(
        &mut self,
        path: &Path,
        owner: &Owner<'_>,
        seen: Seen,
        header: &[u8],
        rest: &[u8],
    ) -> Result<bool, OpenError> {
        let identity = header::line(owner.identity);
        let foreign = |of| OpenError::Foreign {
            path: path.into(),
            of,
            device: [owner.name.into(), identity.clone()],
        };
        let is_blank = |bytes: &[u8]| bytes.iter().all(|byte| *byte == ERASED);
        match seen {
            Seen::Other | Seen::Unfinished => Ok(false),
            // A file without values loses nothing.
            Seen::Version('1') if is_blank(&header[SIGNATURE.len()..]) && is_blank(rest) => {
                Ok(false)
            }
            Seen::Version(version) => Err(OpenError::Version(path.into(), version)),
            Seen::Whole(header) if header.identity != identity => {
                Err(foreign([header.name, header.identity]))
            }
            Seen::Whole(_) | Seen::Damaged if is_blank(rest) => Ok(false),
            Seen::Whole(header) => {
                self.capacity = header.capacity;
                Ok(true)
            }
            Seen::Damaged => {
                // The saved values themselves name their device.
                let writer = image::writer(self);
                if writer.is_ok_and(|writer| writer.is_some_and(|one| one != owner.device)) {
                    let why = "the header of the file is damaged".into();
                    return Err(foreign(["another device".into(), why]));
                }
                self.repaired = Some("the header was damaged; odkit wrote a new one".into());
                Ok(true)
            }
        }
    }

    /// Writes a new header, and the bytes that are missing after it. `len` is the present number of
    /// bytes after the header.
    fn complete(&mut self, owner: &Owner<'_>, is_fresh: bool, len: usize) -> io::Result<()> {
        let mut bytes = Header::write(owner, self.capacity, process::id());
        let missing = self.capacity.saturating_sub(len);
        if is_fresh {
            bytes.resize(LEN + self.capacity, ERASED);
            self.file.set_len(bytes.len() as u64)?;
        } else if missing > 0 {
            let all = LEN + self.capacity;
            let why = format!("the last {missing} of {all} bytes were missing");
            self.repaired = Some(why);
            self.put(LEN + len, &vec![LOST; missing])?;
        }
        self.put(0, &bytes)?;
        // A header that is incomplete after a power cut is damaged, but no value is lost.
        if is_fresh || missing > 0 {
            self.file.sync_all()?;
        }
        Ok(())
    }

    fn put(&mut self, at: usize, bytes: &[u8]) -> io::Result<()> {
        self.file.seek(SeekFrom::Start(at as u64))?;
        self.file.write_all(bytes)
    }

    fn seek(&mut self, offset: usize, len: usize) -> Result<(), StorageError> {
        match offset.checked_add(len) {
            Some(end) if end <= self.capacity => {}
            _ => return Err(StorageError::OutOfRange),
        }
        match self.file.seek(SeekFrom::Start((LEN + offset) as u64)) {
            Ok(_) => Ok(()),
            Err(_) => Err(StorageError::Device),
        }
    }
}

/// Locks a file until it is closed.
fn lock(file: &mut std::fs::File, path: &Path) -> Result<(), OpenError> {
    match file.try_lock() {
        Ok(()) => Ok(()),
        // The file system has no locks.
        Err(TryLockError::Error(error)) if error.kind() == ErrorKind::Unsupported => Ok(()),
        Err(TryLockError::Error(error)) => Err(OpenError::Io(path.into(), error)),
        Err(TryLockError::WouldBlock) => {
            // On Windows no other process can read a locked file.
            let mut start = [0; LEN];
            let seen = match file.read_exact(&mut start) {
                Ok(()) => Header::read(&start),
                Err(_) => Seen::Other,
            };
            Err(OpenError::InUse {
                path: path.into(),
                process: match seen {
                    Seen::Whole(header) => Some(header.process),
                    _ => None,
                },
            })
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
mod tests;
