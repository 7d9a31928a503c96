//! Non-volatile memory: bytes behind a small trait, and the image of the saved values.
//!
//! [`Storage`] is an EEPROM as a host provides it. [`NoStorage`] is a device without
//! one, [`Memory`] lives as long as its bytes, `File` (feature `std`) longer.
//! [`image`] is what 1010h and 1011h write there.

mod crc;
#[cfg(feature = "std")]
mod file;
pub mod image;
mod memory;

use core::fmt;

#[cfg(feature = "std")]
pub use file::{File, OpenError};
pub use memory::Memory;

/// Reason why bytes could not be read or written.
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug)]
#[non_exhaustive]
pub enum StorageError {
    /// Outside the capacity.
    OutOfRange,
    /// The values need more room than there is, or one of them is longer than
    /// [`image::MAX_VALUE`].
    Full,
    /// Power went while writing; nothing works until it is back.
    PowerCut,
    /// The memory itself failed.
    Device,
}

impl fmt::Display for StorageError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::OutOfRange => "outside the storage",
            Self::Full => "the storage is too small for the values",
            Self::PowerCut => "power went while the storage was written",
            Self::Device => "the storage device failed",
        })
    }
}

impl core::error::Error for StorageError {}

/// Bytes that survive power-off.
///
/// A byte is written wholly or not at all. Nothing else is asked of the device:
/// power may go between any two bytes.
pub trait Storage {
    /// Number of bytes.
    fn capacity(&self) -> usize;

    /// Fills `to` from `offset` on.
    ///
    /// # Errors
    /// [`StorageError::OutOfRange`], and what the device has to say.
    fn read(&mut self, offset: usize, to: &mut [u8]) -> Result<(), StorageError>;

    /// Writes `bytes` from `offset` on.
    ///
    /// # Errors
    /// [`StorageError::OutOfRange`], and what the device has to say; some of the
    /// bytes may be written then.
    fn write(&mut self, offset: usize, bytes: &[u8]) -> Result<(), StorageError>;

    /// Makes sure that everything written before this call survives a loss of power after it.
    ///
    /// # Errors
    /// Those of the device.
    fn flush(&mut self) -> Result<(), StorageError> {
        Ok(())
    }
}

/// A device that keeps nothing: capacity 0.
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
