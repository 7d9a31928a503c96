//! The EEPROM of a device. It can be defective, and its power can fail during a write.

use std::cell::RefCell;
use std::prelude::v1::*;
use std::vec;

use od_runtime::storage::{Geometry, Memory, Storage, StorageError};

/// A storage that refuses writes while it is broken, but can be read.
///
/// A copy has the same bytes in a memory of its own.
#[derive(Clone)]
pub(crate) struct Eeprom {
    keeper: Keeper,
    geometry: Geometry,
    /// Nothing can be written.
    pub(crate) broken: bool,
    /// The power is going to fail during a write.
    pub(crate) fails: bool,
}

/// Place of the bytes.
enum Keeper {
    /// Memory of this program, whose power can be cut.
    Own(Memory<Vec<u8>>),
    Lent(RefCell<Box<dyn Storage + Send>>),
}

impl Clone for Keeper {
    fn clone(&self) -> Self {
        match self {
            Self::Own(memory) => Self::Own(memory.clone()),
            Self::Lent(storage) => {
                let mut storage = storage.borrow_mut();
                let mut bytes = vec![0xFF; storage.capacity()];
                // Bytes that cannot be read are erased in the copy.
                if storage.read(0, &mut bytes).is_err() {
                    bytes.fill(0xFF);
                }
                Self::Own(Memory::new(bytes))
            }
        }
    }
}

impl Eeprom {
    /// An EEPROM with these bytes in memory.
    pub(crate) fn own(bytes: Vec<u8>) -> Self {
        let geometry = Geometry::eeprom(bytes.len());
        Self::new(Keeper::Own(Memory::new(bytes)), geometry)
    }

    /// An EEPROM whose bytes are in a storage of the caller.
    pub(crate) fn lent(storage: Box<dyn Storage + Send>) -> Self {
        let geometry = storage.geometry();
        Self::new(Keeper::Lent(RefCell::new(storage)), geometry)
    }

    fn new(keeper: Keeper, geometry: Geometry) -> Self {
        Self {
            keeper,
            geometry,
            broken: false,
            fails: false,
        }
    }

    fn storage(&mut self) -> &mut dyn Storage {
        match &mut self.keeper {
            Keeper::Own(memory) => memory,
            Keeper::Lent(storage) => &mut **storage.get_mut(),
        }
    }

    fn sound(&mut self) -> Result<&mut dyn Storage, StorageError> {
        if self.broken {
            return Err(StorageError::Device);
        }
        Ok(self.storage())
    }

    /// The memory; `None` if the bytes are in a storage of the caller.
    pub(crate) fn memory(&mut self) -> Option<&mut Memory<Vec<u8>>> {
        match &mut self.keeper {
            Keeper::Own(memory) => Some(memory),
            Keeper::Lent(_) => None,
        }
    }

    /// Returns whether the power failed during a write.
    pub(crate) fn is_cut(&self) -> bool {
        matches!(&self.keeper, Keeper::Own(memory) if memory.is_cut())
    }
}

impl Storage for Eeprom {
    fn capacity(&self) -> usize {
        self.geometry.capacity
    }

    fn geometry(&self) -> Geometry {
        self.geometry
    }

    fn read(&mut self, offset: usize, to: &mut [u8]) -> Result<(), StorageError> {
        self.storage().read(offset, to)
    }

    fn write(&mut self, offset: usize, bytes: &[u8]) -> Result<(), StorageError> {
        self.sound()?.write(offset, bytes)
    }

    fn erase(&mut self, offset: usize) -> Result<(), StorageError> {
        let page = self.geometry.page;
        match self.memory() {
            // The copy of a flash has no erasure: it writes FFh.
            Some(_) => self.write(offset, &vec![0xFF; page]),
            None => self.sound()?.erase(offset),
        }
    }

    fn flush(&mut self) -> Result<(), StorageError> {
        self.storage().flush()
    }
}
