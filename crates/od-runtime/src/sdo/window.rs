//! The server's buffer, which contains a whole value or one part of a streamed value.

use crate::number::copy;
use od_wire::AbortCode;

/// The part of a value that is in the buffer.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Part {
    /// Number of bytes of the value before those in the buffer; the stream has them.
    pub(super) start: usize,
    /// Number of bytes in the buffer.
    pub(super) len: usize,
}

/// The buffer, and the part of a value in it.
#[derive(Debug)]
pub(super) struct Window<'s> {
    pub(super) buffer: &'s mut [u8],
    pub(super) part: &'s mut Part,
}

impl Window<'_> {
    /// Empties the buffer; the next byte is the first of a value.
    pub(super) fn clear(&mut self) {
        self.part.start = 0;
        self.part.len = 0;
    }

    /// Copies a whole value into the buffer. Returns its length.
    pub(super) fn load(&mut self, bytes: &[u8]) -> Result<usize, AbortCode> {
        self.clear();
        self.put(bytes)?;
        self.part.len = bytes.len();
        Ok(self.part.len)
    }

    /// Number of bytes of the value so far.
    pub(super) fn end(&self) -> usize {
        self.part.start + self.part.len
    }

    /// Number of free bytes.
    pub(super) fn room(&self) -> usize {
        self.buffer.len().saturating_sub(self.part.len)
    }

    /// Writes bytes after those in the buffer. They count only after the next change of `len`.
    pub(super) fn put(&mut self, bytes: &[u8]) -> Result<(), AbortCode> {
        let room = self
            .buffer
            .get_mut(self.part.len..self.part.len + bytes.len());
        copy(room.ok_or(AbortCode::OutOfMemory)?, bytes);
        Ok(())
    }

    /// The first `len` bytes of the buffer.
    pub(super) fn first(&self, len: usize) -> &[u8] {
        self.buffer.get(..len).unwrap_or(&[])
    }

    /// Returns the bytes of the value from `at` on, as far as they are in the buffer.
    pub(super) fn from(&self, at: usize) -> &[u8] {
        let at = at.wrapping_sub(self.part.start);
        self.buffer.get(at..self.part.len).unwrap_or(&[])
    }
}
