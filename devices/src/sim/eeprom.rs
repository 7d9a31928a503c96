//! A device's EEPROM, which can break.

use std::prelude::v1::*;

use od_runtime::storage::{Storage, StorageError};

/// A storage that takes no byte while it is broken; what it holds can still be read.
pub(super) struct Eeprom {
    storage: Box<dyn Storage>,
    /// Nothing can be written.
    pub(super) broken: bool,
}

impl Eeprom {
    pub(super) fn new(storage: Box<dyn Storage>) -> Self {
        Self {
            storage,
            broken: false,
        }
    }
}

impl Storage for Eeprom {
    fn capacity(&self) -> usize {
        self.storage.capacity()
    }

    fn read(&mut self, offset: usize, to: &mut [u8]) -> Result<(), StorageError> {
        self.storage.read(offset, to)
    }

    fn write(&mut self, offset: usize, bytes: &[u8]) -> Result<(), StorageError> {
        if self.broken {
            return Err(StorageError::Device);
        }
        self.storage.write(offset, bytes)
    }

    fn flush(&mut self) -> Result<(), StorageError> {
        self.storage.flush()
    }
}
