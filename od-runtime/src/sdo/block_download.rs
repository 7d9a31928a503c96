//! Block download (CiA 301, chapters 7.2.4.3.9–7.2.4.3.12). The value is in the server's buffer,
//! which each call borrows.

use core::cmp::Ordering;

use od_wire::AbortCode;
use od_wire::sdo::{Response, crc16};

/// A block download under way.
#[derive(Clone, Copy, Debug)]
pub(super) struct BlockDownload {
    /// The client makes a CRC.
    crc: bool,
    size: Option<u32>,
    /// Bytes in the buffer, with the unused ones of the last segment.
    received: usize,
    /// Segments that this block has.
    block_size: u8,
    /// The last segment of this block that came in sequence.
    ack: u8,
    /// The client said that no more segments follow.
    last: bool,
}

impl BlockDownload {
    /// Of `size` bytes, if the client announced a size.
    pub(super) fn new(buffer: &[u8], crc: bool, size: Option<u32>) -> Self {
        Self {
            crc,
            size,
            received: 0,
            block_size: room(buffer, 0),
            ack: 0,
            last: false,
        }
    }

    /// Segments of the next block.
    pub(super) const fn block_size(&self) -> u8 {
        self.block_size
    }

    /// Whether the next frame is a segment.
    pub(super) const fn wants_segments(&self) -> bool {
        !self.last
    }

    /// A segment. One that is out of sequence is ignored: the response at the end of the block
    /// tells the client where to go on.
    pub(super) fn segment(
        &mut self,
        buffer: &mut [u8],
        data: &[u8; 8],
    ) -> Result<Option<Response>, AbortCode> {
        let [head, bytes @ ..] = data;
        let (sequence, last) = (head & 0x7F, head & 0x80 != 0);
        if sequence == 0 || sequence > self.block_size {
            return Err(AbortCode::InvalidSequence);
        }
        let is_block_over = last || sequence == self.block_size;
        if sequence == self.ack + 1 {
            let tail = buffer.get_mut(self.received..).unwrap_or(&mut []);
            // The unused bytes of the last segment may be past the buffer's end.
            if tail.len() < 7 && !last {
                return Err(AbortCode::OutOfMemory);
            }
            let len = tail.len().min(7);
            tail[..len].copy_from_slice(&bytes[..len]);
            self.received += 7;
            self.ack = sequence;
            self.last = last;
        }
        if !is_block_over {
            return Ok(None);
        }
        self.block_size = room(buffer, self.received);
        Ok(Some(Response::BlockDownloadResponse {
            ack: core::mem::take(&mut self.ack),
            block_size: self.block_size,
        }))
    }

    /// The end of the transfer: returns the length of the value, if it came whole.
    pub(super) fn end(&self, buffer: &[u8], unused: u8, crc: u16) -> Result<usize, AbortCode> {
        let len = self.received.saturating_sub(unused.into());
        match self.size.map(|size| len.cmp(&(size as usize))) {
            Some(Ordering::Less) => return Err(AbortCode::TooShort),
            Some(Ordering::Greater) => return Err(AbortCode::TooLong),
            Some(Ordering::Equal) | None => {}
        }
        let data = buffer.get(..len).ok_or(AbortCode::OutOfMemory)?;
        if self.crc && crc16(data) != crc {
            return Err(AbortCode::Crc);
        }
        Ok(len)
    }
}

/// Segments that the buffer has room for, 1–127.
fn room(buffer: &[u8], received: usize) -> u8 {
    (buffer.len().saturating_sub(received) / 7).clamp(1, 127) as u8
}
