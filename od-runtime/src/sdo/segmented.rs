//! Segmented transfers (CiA 301, chapters 7.2.4.3.4–7.2.4.3.8). The value is in the server's
//! buffer, which each call borrows.

use od_wire::AbortCode;
use od_wire::sdo::{Response, Segment};

/// An upload under way.
#[derive(Clone, Copy, Debug)]
pub(super) struct Upload {
    toggle: bool,
    sent: usize,
    len: usize,
}

impl Upload {
    /// Of the first `len` bytes of the buffer.
    pub(super) const fn new(len: usize) -> Self {
        Self {
            toggle: false,
            sent: 0,
            len,
        }
    }

    /// Whether the last segment has been sent.
    pub(super) const fn is_over(&self) -> bool {
        self.sent == self.len
    }

    /// Returns the next segment.
    pub(super) fn segment(&mut self, buffer: &[u8], toggle: bool) -> Result<Response, AbortCode> {
        if toggle != self.toggle {
            return Err(AbortCode::ToggleBit);
        }
        let rest = buffer.get(self.sent..self.len).unwrap_or(&[]);
        let segment = Segment::first_of(rest, toggle);
        self.sent += usize::from(segment.len);
        self.toggle = !toggle;
        Ok(Response::UploadSegment(segment))
    }
}

/// A download under way.
#[derive(Clone, Copy, Debug)]
pub(super) struct Download {
    toggle: bool,
    received: usize,
    size: Option<u32>,
}

impl Download {
    /// Of `size` bytes, if the client announced a size.
    pub(super) const fn new(size: Option<u32>) -> Self {
        Self {
            toggle: false,
            received: 0,
            size,
        }
    }

    /// Puts a segment into the buffer. Returns the length of the value if it was the last one.
    pub(super) fn segment(
        &mut self,
        buffer: &mut [u8],
        segment: &Segment,
    ) -> Result<Option<usize>, AbortCode> {
        if segment.toggle != self.toggle {
            return Err(AbortCode::ToggleBit);
        }
        let (data, last) = (segment.bytes(), segment.last);
        let end = self.received + data.len();
        if self.size.is_some_and(|size| end > size as usize) {
            return Err(AbortCode::TooLong);
        }
        let room = buffer.get_mut(self.received..end);
        room.ok_or(AbortCode::OutOfMemory)?.copy_from_slice(data);
        self.received = end;
        self.toggle = !self.toggle;
        if last && self.size.is_some_and(|size| end < size as usize) {
            return Err(AbortCode::TooShort);
        }
        Ok(last.then_some(end))
    }
}
