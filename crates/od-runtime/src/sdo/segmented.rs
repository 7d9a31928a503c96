//! Segmented transfers (CiA 301, chapters 7.2.4.3.4 and 7.2.4.3.7). The value is in the server's
//! buffer.

use od_wire::AbortCode;
use od_wire::sdo::segment;

/// A segmented upload in progress.
#[derive(Clone, Copy, Debug)]
pub(super) struct Upload {
    toggle: bool,
    sent: usize,
    len: usize,
}

impl Upload {
    /// Begins an upload of a value of `len` bytes.
    pub(super) const fn new(len: usize) -> Self {
        Self {
            toggle: false,
            sent: 0,
            len,
        }
    }

    /// Number of bytes that were sent.
    pub(super) const fn sent(&self) -> usize {
        self.sent
    }

    /// Length of the value in bytes.
    pub(super) const fn len(&self) -> usize {
        self.len
    }

    /// Returns whether the last segment was sent.
    pub(super) const fn is_over(&self) -> bool {
        self.sent == self.len
    }

    /// Checks the request for the next segment.
    pub(super) fn check(&self, toggle: bool) -> Result<(), AbortCode> {
        check(self.toggle, toggle)
    }

    /// Returns the next segment, which consists of the first bytes of `rest`.
    pub(super) fn segment(&mut self, rest: &[u8]) -> [u8; 8] {
        self.sent += rest.len().min(7);
        let segment = segment(self.toggle, rest, self.is_over());
        self.toggle = !self.toggle;
        segment
    }
}

/// A segmented download in progress.
#[derive(Clone, Copy, Debug)]
pub(super) struct Download {
    toggle: bool,
    size: Option<u32>,
}

impl Download {
    /// Begins a download of `size` bytes, if the client announced a size.
    pub(super) const fn new(size: Option<u32>) -> Self {
        Self {
            toggle: false,
            size,
        }
    }

    /// Checks a segment after which `end` bytes have arrived; `is_last`: it is the last one.
    pub(super) fn check(&self, toggle: bool, end: usize, is_last: bool) -> Result<(), AbortCode> {
        check(self.toggle, toggle)?;
        match self.size.map(|size| size as usize) {
            Some(size) if end > size => Err(AbortCode::TooLong),
            Some(size) if end < size && is_last => Err(AbortCode::TooShort),
            _ => Ok(()),
        }
    }

    /// Notes that a segment was accepted.
    pub(super) fn go_on(&mut self) {
        self.toggle = !self.toggle;
    }
}

fn check(expected: bool, toggle: bool) -> Result<(), AbortCode> {
    if toggle == expected {
        Ok(())
    } else {
        Err(AbortCode::ToggleBit)
    }
}
