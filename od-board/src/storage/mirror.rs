//! Saved values in RAM, on their way to flash.

use core::task::{Context, Poll, Waker};

use od_runtime::storage::{Storage, StorageError, image};

/// The storage of a node whose saves go to flash in the background: the node writes here, and
/// a task of lower priority carries the newest set on ([`Log`](super::Log), or your own by
/// [`poll_changed`](Self::poll_changed), [`newest`](Self::newest) and [`stored`](Self::stored)).
///
/// `N`: [`image::capacity_needed`] of the dictionary, and [`image::OWN_CAPACITY`] more where LSS stores
/// the node ID. Without such a task, 1010h is never answered.
#[derive(Debug)]
pub struct Mirror<const N: usize> {
    bytes: [u8; N],
    /// Number of writes, and what it was for the set that is kept.
    changes: u32,
    kept: u32,
    failed: bool,
    waker: Option<Waker>,
}

impl<const N: usize> Default for Mirror<N> {
    fn default() -> Self {
        Self::new()
    }
}

impl<const N: usize> Mirror<N> {
    /// A mirror without saved values.
    pub const fn new() -> Self {
        Self {
            bytes: [0xFF; N],
            changes: 0,
            kept: 0,
            failed: false,
            waker: None,
        }
    }

    /// Takes over the set that [`newest`](Self::newest) returned once; before the node has power.
    pub fn load(&mut self, set: &[u8]) {
        self.bytes.fill(0xFF);
        if let Some(to) = self.bytes.get_mut(..set.len()) {
            to.copy_from_slice(set);
        }
        self.kept = self.changes;
    }

    /// Waits until there is something to keep.
    pub fn poll_changed(&mut self, cx: &mut Context<'_>) -> Poll<()> {
        if self.changes != self.kept {
            return Poll::Ready(());
        }
        self.waker = Some(cx.waker().clone());
        Poll::Pending
    }

    /// Returns the newest set, `N / 2` bytes at most, and the number to call [`stored`](Self::stored)
    /// with; no bytes if nothing was ever saved.
    pub fn newest(&mut self) -> (&[u8], u32) {
        let place = image::newest(self).ok().flatten().unwrap_or(0..0);
        (self.bytes.get(place).unwrap_or_default(), self.changes)
    }

    /// The set with this number is kept, or cannot be; the node answers its master.
    pub fn stored(&mut self, number: u32, result: Result<(), StorageError>) {
        if result.is_err() {
            // The next change is the next attempt.
            self.failed = true;
            self.kept = self.changes;
        } else {
            self.kept = number;
        }
    }

    fn range(&self, offset: usize, len: usize) -> Result<core::ops::Range<usize>, StorageError> {
        let end = offset.checked_add(len).filter(|end| *end <= N);
        end.map(|end| offset..end).ok_or(StorageError::OutOfRange)
    }
}

impl<const N: usize> Storage for Mirror<N> {
    fn capacity(&self) -> usize {
        N
    }

    fn read(&mut self, offset: usize, to: &mut [u8]) -> Result<(), StorageError> {
        let range = self.range(offset, to.len())?;
        to.copy_from_slice(&self.bytes[range]);
        Ok(())
    }

    fn write(&mut self, offset: usize, bytes: &[u8]) -> Result<(), StorageError> {
        let range = self.range(offset, bytes.len())?;
        self.bytes[range].copy_from_slice(bytes);
        self.changes = self.changes.wrapping_add(1);
        if let Some(waker) = self.waker.take() {
            waker.wake();
        }
        Ok(())
    }

    fn is_writing(&mut self) -> bool {
        self.changes != self.kept
    }

    fn flush(&mut self) -> Result<(), StorageError> {
        if self.is_writing() {
            return Ok(());
        }
        match core::mem::take(&mut self.failed) {
            true => Err(StorageError::Device),
            false => Ok(()),
        }
    }
}
