//! Buffer for the value of an upload.

/// Receives the bytes of a value in their order.
///
/// ```
/// use od_client::sdo::Buffer;
///
/// let mut buffer = Vec::new();
/// assert!(Buffer::push(&mut buffer, &[1, 2]));
/// assert_eq!(Buffer::bytes(&buffer), [1, 2]);
/// ```
pub trait Buffer {
    /// Returns the bytes so far.
    fn bytes(&self) -> &[u8];

    /// Returns the number of bytes that fit.
    fn capacity(&self) -> usize;

    /// Removes all bytes.
    fn clear(&mut self);

    /// Appends all `bytes`. Returns `false` and appends nothing if they do not fit.
    #[must_use]
    fn push(&mut self, bytes: &[u8]) -> bool;
}

/// A buffer in memory of the caller.
///
/// ```
/// use od_client::sdo::{Buffer, Slice};
///
/// let mut room = [0; 4];
/// let mut buffer = Slice::new(&mut room);
/// assert!(buffer.push(b"GX") && !buffer.push(b"MM5"));
/// assert_eq!(buffer.capacity(), 4);
/// ```
#[derive(Debug)]
pub struct Slice<'b> {
    room: &'b mut [u8],
    len: usize,
}

impl<'b> Slice<'b> {
    /// An empty buffer of `room.len()` bytes.
    pub const fn new(room: &'b mut [u8]) -> Self {
        Self { room, len: 0 }
    }
}

impl Buffer for Slice<'_> {
    fn bytes(&self) -> &[u8] {
        self.room.get(..self.len).unwrap_or_default()
    }

    fn capacity(&self) -> usize {
        self.room.len()
    }

    fn clear(&mut self) {
        self.len = 0;
    }

    fn push(&mut self, bytes: &[u8]) -> bool {
        let room = self.room.get_mut(self.len..).unwrap_or_default();
        let Some(room) = room.get_mut(..bytes.len()) else {
            return false;
        };
        room.copy_from_slice(bytes);
        self.len += bytes.len();
        true
    }
}

#[cfg(feature = "alloc")]
impl Buffer for alloc::vec::Vec<u8> {
    fn bytes(&self) -> &[u8] {
        self
    }

    /// No limit of its own: [`Options::limit`](super::Options::limit) applies.
    fn capacity(&self) -> usize {
        usize::MAX
    }

    fn clear(&mut self) {
        Self::clear(self);
    }

    fn push(&mut self, bytes: &[u8]) -> bool {
        self.extend_from_slice(bytes);
        true
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_slice_takes_all_bytes_or_none() {
        let mut room = [0; 5];
        let mut slice = Slice::new(&mut room);
        assert_eq!(slice.capacity(), 5);
        assert!(slice.push(&[1, 2, 3]));
        assert!(!slice.push(&[4, 5, 6]));
        assert_eq!(slice.bytes(), [1, 2, 3]);
        assert!(slice.push(&[4, 5]) && slice.push(&[]) && !slice.push(&[6]));
        assert_eq!(slice.bytes(), [1, 2, 3, 4, 5]);
        slice.clear();
        assert_eq!(slice.bytes(), []);
    }
}
