//! Storage in memory, with a power supply that can be cut.

use super::{Storage, StorageError};
use crate::number::copy;

/// Storage in memory that the caller owns: an array, a slice, a `Vec`.
///
/// Power can be cut after a number of written bytes. Tests and the bench use this to see the state
/// after an interrupted save:
///
/// ```
/// use od_runtime::storage::{Memory, Storage, StorageError};
///
/// let mut memory = Memory::new([0xFF; 64]);
/// memory.cut_after(3);
/// assert_eq!(memory.write(0, b"12345"), Err(StorageError::PowerCut));
/// assert!(memory.is_cut());
/// memory.restore_power();
/// assert_eq!(memory.bytes()[..5], *b"123\xFF\xFF");
/// ```
#[derive(Clone, Debug)]
pub struct Memory<B> {
    bytes: B,
    /// Number of bytes that can still be written before power fails.
    left: Option<usize>,
    cut: bool,
}

impl<B: AsRef<[u8]> + AsMut<[u8]>> Memory<B> {
    /// Storage that holds these bytes; a new EEPROM is all FFh or all 0.
    pub const fn new(bytes: B) -> Self {
        Self {
            bytes,
            left: None,
            cut: false,
        }
    }

    /// Power fails at the first byte after `bytes` more bytes.
    pub fn cut_after(&mut self, bytes: usize) {
        self.left = Some(bytes);
    }

    /// Returns whether power has failed; nothing can be read or written then.
    pub fn is_cut(&self) -> bool {
        self.cut
    }

    /// Restores power, and cancels a planned failure.
    pub fn restore_power(&mut self) {
        self.left = None;
        self.cut = false;
    }

    /// Returns the bytes.
    pub fn bytes(&self) -> &[u8] {
        self.bytes.as_ref()
    }

    /// Returns the bytes, for a test that damages them.
    pub fn bytes_mut(&mut self) -> &mut [u8] {
        self.bytes.as_mut()
    }

    /// Returns the owner of the bytes.
    pub fn into_inner(self) -> B {
        self.bytes
    }
}

impl<B: AsRef<[u8]> + AsMut<[u8]>> Storage for Memory<B> {
    fn capacity(&self) -> usize {
        self.bytes.as_ref().len()
    }

    fn read(&mut self, offset: usize, to: &mut [u8]) -> Result<(), StorageError> {
        if self.cut {
            return Err(StorageError::PowerCut);
        }
        let from = self.bytes.as_ref().get(offset..);
        let from = from.and_then(|from| from.get(..to.len()));
        let from = from.ok_or(StorageError::OutOfRange)?;
        // A start reads the whole storage, so this copies words.
        let ((to, to_rest), (from, rest)) = (to.as_chunks_mut::<4>(), from.as_chunks::<4>());
        to.iter_mut().zip(from).for_each(|(to, from)| *to = *from);
        copy(to_rest, rest);
        Ok(())
    }

    fn write(&mut self, offset: usize, bytes: &[u8]) -> Result<(), StorageError> {
        if self.cut {
            return Err(StorageError::PowerCut);
        }
        let to = self
            .bytes
            .as_mut()
            .get_mut(offset..offset.saturating_add(bytes.len()))
            .ok_or(StorageError::OutOfRange)?;
        let mut bytes = bytes;
        if let Some(left) = &mut self.left {
            self.cut = *left < bytes.len();
            bytes = bytes.get(..*left).unwrap_or(bytes);
            *left -= bytes.len();
        }
        copy(to, bytes);
        if self.cut {
            Err(StorageError::PowerCut)
        } else {
            Ok(())
        }
    }
}
