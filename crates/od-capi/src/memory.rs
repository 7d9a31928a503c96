//! Non-volatile memory that callbacks of the firmware read and write.
#![allow(unsafe_code)]

use core::ffi::c_void;

use odkit::storage::{Geometry, Storage, StorageError};

use crate::types::odkit_storage;

/// Longest word that the storage of odkit supports.
const LARGEST_WORD: u32 = 32;

/// The memory of a device.
pub(crate) struct Memory {
    pub(crate) context: *mut c_void,
    pub(crate) storage: odkit_storage,
}

impl odkit_storage {
    /// Returns whether the callbacks that the sizes need exist, and the sizes are consistent.
    pub(crate) fn is_valid(&self) -> bool {
        if self.capacity == 0 {
            return true;
        }
        let has_page = match self.page {
            0 => true,
            page => {
                self.erase.is_some()
                    && self.capacity.is_multiple_of(page)
                    && page.is_multiple_of(self.word.max(1))
            }
        };
        let fits = matches!(self.word, 0) || self.word.is_power_of_two();
        self.read.is_some()
            && self.write.is_some()
            && has_page
            && fits
            && self.word <= LARGEST_WORD
            && self.capacity <= i32::MAX as u32
    }
}

/// Converts what a callback returned: 0 is success, every other number an error.
fn outcome(answer: i32) -> Result<(), StorageError> {
    match answer {
        0 => Ok(()),
        _ => Err(StorageError::Device),
    }
}

impl Memory {
    /// No memory.
    pub(crate) const NONE: Self = Self {
        context: core::ptr::null_mut(),
        storage: odkit_storage::none(),
    };

    /// Offset and length as C takes them, if they are inside the memory.
    fn part(&self, offset: usize, len: usize) -> Result<(u32, u32), StorageError> {
        let capacity = self.storage.capacity as usize;
        match offset.checked_add(len) {
            Some(end) if end <= capacity => Ok((offset as u32, len as u32)),
            _ => Err(StorageError::OutOfRange),
        }
    }
}

impl Storage for Memory {
    fn capacity(&self) -> usize {
        self.storage.capacity as usize
    }

    fn geometry(&self) -> Geometry {
        Geometry {
            capacity: self.storage.capacity as usize,
            page: self.storage.page as usize,
            word: self.storage.word.max(1) as usize,
        }
    }

    fn read(&mut self, offset: usize, to: &mut [u8]) -> Result<(), StorageError> {
        let (offset, len) = self.part(offset, to.len())?;
        let read = self.storage.read.ok_or(StorageError::Device)?;
        // SAFETY: C wrote the function for these arguments, and `to` has room for `len` bytes.
        outcome(unsafe { read(self.context, offset, to.as_mut_ptr(), len) })
    }

    fn write(&mut self, offset: usize, bytes: &[u8]) -> Result<(), StorageError> {
        let (offset, len) = self.part(offset, bytes.len())?;
        let write = self.storage.write.ok_or(StorageError::Device)?;
        // SAFETY: C wrote the function for these arguments, and `bytes` has `len` bytes.
        outcome(unsafe { write(self.context, offset, bytes.as_ptr(), len) })
    }

    fn erase(&mut self, offset: usize) -> Result<(), StorageError> {
        let (offset, _) = self.part(offset, self.storage.page as usize)?;
        let erase = self.storage.erase.ok_or(StorageError::Device)?;
        // SAFETY: C wrote the function for these arguments.
        outcome(unsafe { erase(self.context, offset) })
    }

    fn flush(&mut self) -> Result<(), StorageError> {
        match self.storage.flush {
            // SAFETY: C wrote the function for this argument.
            Some(flush) => outcome(unsafe { flush(self.context) }),
            None => Ok(()),
        }
    }
}
