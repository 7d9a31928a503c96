//! Non-volatile memory: a small trait for its bytes, and the image of the saved values.
//!
//! [`Storage`] is an EEPROM or NOR flash as a host provides it. [`NoStorage`] is for a device
//! without one. [`Memory`] keeps its bytes in RAM, `File` (feature `std`) in a file. [`image`]
//! describes what 1010h and 1011h write there.

pub(crate) mod crc;
#[cfg(feature = "std")]
mod file;
pub mod image;
mod memory;

use core::fmt;

use od_model::Dictionary;

use crate::profile::StoreProfile;
use crate::store::Store;

#[cfg(feature = "std")]
pub use file::{File, OpenError, Owner};
pub use memory::Memory;

/// Reason why bytes could not be read or written.
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug)]
#[non_exhaustive]
pub enum StorageError {
    /// Outside the capacity.
    OutOfRange,
    /// The values need more room than there is, or one of them is longer than [`image::MAX_VALUE`].
    Full,
    /// Power failed during a write; nothing works until power returns.
    PowerCut,
    /// The memory itself failed.
    Device,
    /// The memory does not contain the bytes that were written.
    NotWritten,
    /// The saved values belong to another device, and only a master may replace them.
    Foreign,
}

impl fmt::Display for StorageError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::OutOfRange => "outside the storage",
            Self::Full => "the storage is too small for the values",
            Self::PowerCut => "power failed while the storage was written",
            Self::Device => "the storage device failed",
            Self::NotWritten => "the storage does not hold what was written to it",
            Self::Foreign => "another device wrote the saved values",
        })
    }
}

impl core::error::Error for StorageError {}

/// Sizes of a storage, in bytes.
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug)]
pub struct Geometry {
    /// Size of the whole storage; for flash, whole pages.
    pub capacity: usize,
    /// Number of bytes that [`Storage::erase`] erases at once; 0: no erasure is needed before a
    /// write (EEPROM, FRAM).
    pub page: usize,
    /// Number of bytes that are written at once, a power of two up to 32; 1 for an EEPROM.
    pub word: usize,
}

impl Geometry {
    /// An EEPROM or FRAM: every byte can be written at any time.
    pub const fn eeprom(capacity: usize) -> Self {
        Self {
            capacity,
            page: 0,
            word: 1,
        }
    }
}

/// Memory that keeps its content without power: an EEPROM, or NOR flash.
///
/// Power may fail at any moment. A byte of an EEPROM is then written completely or not at all; a
/// word of flash that was being written, or a page that was being erased, may have any content.
///
/// For flash ([`Geometry::page`] is not 0) the node writes whole words at multiples of
/// [`Geometry::word`], each once after its page was erased, so a write only clears bits. One call
/// erases at most one page, or writes at most 64 bytes.
pub trait Storage {
    /// Number of bytes.
    fn capacity(&self) -> usize;

    /// Returns the sizes of the storage; by default those of an EEPROM.
    fn geometry(&self) -> Geometry {
        Geometry::eeprom(self.capacity())
    }

    /// Fills `to` from `offset` on.
    ///
    /// # Errors
    /// [`StorageError::OutOfRange`], and errors of the device.
    fn read(&mut self, offset: usize, to: &mut [u8]) -> Result<(), StorageError>;

    /// Writes `bytes` from `offset` on.
    ///
    /// # Errors
    /// [`StorageError::OutOfRange`], and errors of the device; some of the bytes may be written
    /// then.
    fn write(&mut self, offset: usize, bytes: &[u8]) -> Result<(), StorageError>;

    /// Sets all bytes of the page at `offset` to FFh. Never called for an EEPROM.
    ///
    /// # Errors
    /// [`StorageError::OutOfRange`], and errors of the device.
    fn erase(&mut self, offset: usize) -> Result<(), StorageError> {
        let _ = offset;
        Err(StorageError::Device)
    }

    /// Takes over a save: the storage makes the image itself, in bounded steps after this call
    /// ([`image::Job`]). From now on [`is_writing`](Self::is_writing) returns `true`, and later
    /// reads and writes find the save complete. `false`: the node makes the image in this call.
    fn take(&mut self, save: &Save<'_>) -> bool {
        let _ = save;
        false
    }

    /// Returns whether written bytes have not reached the non-volatile memory yet, because they are
    /// written in the background. The node responds to 1010h and 1011h when they have, and then
    /// asks [`flush`](Self::flush) whether all writes succeeded.
    fn is_writing(&mut self) -> bool {
        false
    }

    /// Makes sure that everything written before this call survives a power failure after it. While
    /// [`is_writing`](Self::is_writing) returns `true` it does not wait, and reports failures.
    ///
    /// # Errors
    /// Errors of the device.
    fn flush(&mut self) -> Result<(), StorageError> {
        Ok(())
    }
}

/// Storage of a device that saves nothing: capacity 0.
#[derive(Clone, Copy, Debug, Default)]
pub struct NoStorage;

impl Storage for NoStorage {
    fn capacity(&self) -> usize {
        0
    }

    fn read(&mut self, _: usize, to: &mut [u8]) -> Result<(), StorageError> {
        if to.is_empty() {
            Ok(())
        } else {
            Err(StorageError::OutOfRange)
        }
    }

    fn write(&mut self, _: usize, bytes: &[u8]) -> Result<(), StorageError> {
        if bytes.is_empty() {
            Ok(())
        } else {
            Err(StorageError::OutOfRange)
        }
    }
}

/// A save or a restore, of which [`image::Job`] makes the next image.
pub struct Save<'s> {
    /// 1011h, not 1010h.
    pub(crate) restores: bool,
    /// Sub-index of 1010h or 1011h; 0: the operating records only.
    pub(crate) sub: u8,
    /// The [device](image::device).
    pub(crate) device: u32,
    pub(crate) store: &'s Store<'s>,
    pub(crate) profile: &'s StoreProfile,
}

impl Save<'_> {
    /// Returns whether it is a save of 1010h: neither a restore (1011h) nor a save of the operating
    /// records only, which the device starts itself.
    pub fn is_of_settings(&self) -> bool {
        !self.restores && self.sub != 0
    }

    /// Returns whether these are values of this [device](image::device), in the layout of
    /// this dictionary.
    pub fn is_of(&self, device: u32, dictionary: &Dictionary<'_>) -> bool {
        let own = self.store.dictionary();
        self.device == device
            && own.len() == dictionary.len()
            && own.store_len() == dictionary.store_len()
    }
}
