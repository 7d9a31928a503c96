//! NOR flash as the storage of a node; the calls of the node write it.

use embedded_storage::nor_flash::NorFlash;
use od_runtime::storage::{Geometry, Storage, StorageError};

/// Pages of a flash with the traits of `embedded-storage`, divided into two banks; each save erases
/// and writes the older bank.
///
/// [`image::capacity_on`](od_runtime::storage::image::capacity_on) returns the number of bytes that
/// a dictionary needs.
#[derive(Clone, Debug)]
pub struct Nor<F> {
    flash: F,
    start: u32,
    len: u32,
}

/// Number of bytes that are read at once from a flash that reads whole words.
const BUFFER: usize = 32;

impl<F: NorFlash> Nor<F> {
    /// Uses the `len` bytes from `start` on; both are whole pages.
    pub const fn new(flash: F, start: u32, len: u32) -> Self {
        const {
            assert!(F::READ_SIZE <= BUFFER && BUFFER.is_multiple_of(F::READ_SIZE));
            assert!(F::WRITE_SIZE <= 32, "a word has at most 32 bytes");
        }
        Self { flash, start, len }
    }

    /// Returns the flash.
    pub fn into_inner(self) -> F {
        self.flash
    }

    fn at(&self, offset: usize, len: usize) -> Result<u32, StorageError> {
        let end = offset.checked_add(len).ok_or(StorageError::OutOfRange)?;
        match u32::try_from(end) {
            Ok(end) if end <= self.len => Ok(self.start + offset as u32),
            _ => Err(StorageError::OutOfRange),
        }
    }
}

impl<F: NorFlash> Storage for Nor<F> {
    fn capacity(&self) -> usize {
        self.len as usize
    }

    fn geometry(&self) -> Geometry {
        Geometry {
            capacity: self.capacity(),
            page: F::ERASE_SIZE,
            word: F::WRITE_SIZE,
        }
    }

    fn read(&mut self, offset: usize, to: &mut [u8]) -> Result<(), StorageError> {
        let mut at = self.at(offset, to.len())?;
        if F::READ_SIZE == 1 {
            return self.flash.read(at, to).map_err(|_| StorageError::Device);
        }
        let mut rest = to;
        while !rest.is_empty() {
            let mut buffer = [0; BUFFER];
            let before = at as usize % F::READ_SIZE;
            let len = rest.len().min(BUFFER - before);
            let words = (before + len).next_multiple_of(F::READ_SIZE);
            self.flash
                .read(at - before as u32, &mut buffer[..words])
                .map_err(|_| StorageError::Device)?;
            let (part, others) = rest.split_at_mut(len);
            part.copy_from_slice(&buffer[before..before + len]);
            (rest, at) = (others, at + len as u32);
        }
        Ok(())
    }

    fn write(&mut self, offset: usize, bytes: &[u8]) -> Result<(), StorageError> {
        let at = self.at(offset, bytes.len())?;
        self.flash
            .write(at, bytes)
            .map_err(|_| StorageError::Device)
    }

    fn erase(&mut self, offset: usize) -> Result<(), StorageError> {
        let at = self.at(offset, F::ERASE_SIZE)?;
        self.flash
            .erase(at, at + F::ERASE_SIZE as u32)
            .map_err(|_| StorageError::Device)
    }
}
