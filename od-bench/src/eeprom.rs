//! A device's EEPROM, which can break, and whose power can go while it is written.

use std::prelude::v1::*;

use od_runtime::storage::{Geometry, Memory, Storage, StorageError};

/// A storage that takes no byte while it is broken; what it holds can still be read.
pub(super) struct Eeprom {
    storage: Keeper,
    /// Nothing can be written.
    pub(super) broken: bool,
    /// Power will go while it is written.
    pub(super) fails: bool,
}

/// Memory of the bytes.
enum Keeper {
    /// A memory of its own, with a supply that can be cut.
    Own(Memory<Vec<u8>>),
    Lent(Box<dyn Storage + Send>),
}

impl Keeper {
    fn storage(&mut self) -> &mut dyn Storage {
        match self {
            Self::Own(memory) => memory,
            Self::Lent(storage) => &mut **storage,
        }
    }
}

impl Eeprom {
    /// Bytes in memory.
    pub(super) fn own(bytes: Vec<u8>) -> Self {
        Self {
            storage: Keeper::Own(Memory::new(bytes)),
            broken: false,
            fails: false,
        }
    }

    /// A storage of the caller.
    pub(super) fn lent(storage: Box<dyn Storage + Send>) -> Self {
        Self {
            storage: Keeper::Lent(storage),
            broken: false,
            fails: false,
        }
    }

    /// A copy; `None` of a storage of the caller.
    pub(super) fn copy(&self) -> Option<Self> {
        match &self.storage {
            Keeper::Own(memory) => Some(Self {
                storage: Keeper::Own(memory.clone()),
                broken: self.broken,
                fails: self.fails,
            }),
            Keeper::Lent(_) => None,
        }
    }

    /// The memory, where it is its own.
    pub(super) fn memory(&mut self) -> Option<&mut Memory<Vec<u8>>> {
        match &mut self.storage {
            Keeper::Own(memory) => Some(memory),
            Keeper::Lent(_) => None,
        }
    }

    /// Did power go while it was written?
    pub(super) fn is_cut(&self) -> bool {
        matches!(&self.storage, Keeper::Own(memory) if memory.is_cut())
    }
}

impl Storage for Eeprom {
    fn capacity(&self) -> usize {
        self.geometry().capacity
    }

    fn geometry(&self) -> Geometry {
        match &self.storage {
            Keeper::Own(memory) => memory.geometry(),
            Keeper::Lent(storage) => storage.geometry(),
        }
    }

    fn read(&mut self, offset: usize, to: &mut [u8]) -> Result<(), StorageError> {
        self.storage.storage().read(offset, to)
    }

    fn write(&mut self, offset: usize, bytes: &[u8]) -> Result<(), StorageError> {
        if self.broken {
            return Err(StorageError::Device);
        }
        self.storage.storage().write(offset, bytes)
    }

    fn erase(&mut self, offset: usize) -> Result<(), StorageError> {
        if self.broken {
            return Err(StorageError::Device);
        }
        self.storage.storage().erase(offset)
    }

    fn flush(&mut self) -> Result<(), StorageError> {
        self.storage.storage().flush()
    }
}
