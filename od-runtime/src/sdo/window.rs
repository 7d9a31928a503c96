//! The server's buffer: all of a value, or the part of a streamed one that is on its way.

use crate::number::copy;
use od_wire::AbortCode;

/// A part of a value.
#[derive(Clone, Debug)]
pub(super) struct Window<const N: usize> {
    pub(super) buffer: [u8; N],
    /// Bytes of the value before those in the buffer: the stream has them.
    pub(super) start: usize,
    /// Bytes in the buffer.
    pub(super) len: usize,
}

impl<const N: usize> Window<N> {
    pub(super) const fn new() -> Self {
        Self {
            buffer: [0; N],
            start: 0,
            len: 0,
        }
    }

    /// Empties the buffer; the next byte is the first of a value.
    pub(super) fn clear(&mut self) {
        self.start = 0;
        self.len = 0;
    }

    /// Copies a whole value into the buffer. Returns its length.
    pub(super) fn load(&mut self, bytes: &[u8]) -> Result<usize, AbortCode> {
        self.clear();
        self.put(bytes)?;
        self.len = bytes.len();
        Ok(self.len)
    }

    /// Bytes of the value so far.
    pub(super) const fn end(&self) -> usize {
        self.start + self.len
    }

    /// Bytes that there is room for.
    pub(super) const fn room(&self) -> usize {
        N - self.len
    }

    /// Puts bytes behind those in the buffer. They count with the next change of `len`.
    pub(super) fn put(&mut self, bytes: &[u8]) -> Result<(), AbortCode> {
        let room = self.buffer.get_mut(self.len..self.len + bytes.len());
        copy(room.ok_or(AbortCode::OutOfMemory)?, bytes);
        Ok(())
    }

    /// The first `len` bytes of the buffer.
    pub(super) fn first(&self, len: usize) -> &[u8] {
        self.buffer.get(..len).unwrap_or(&[])
    }

    /// The bytes of the value from `at` on, as far as they are in the buffer.
    pub(super) fn from(&self, at: usize) -> &[u8] {
        let at = at.wrapping_sub(self.start);
        self.buffer.get(at..self.len).unwrap_or(&[])
    }
}
