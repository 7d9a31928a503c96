//! Block download (CiA 301, chapters 7.2.4.3.9–7.2.4.3.12).

use od_model::Address;

use super::{Answer, Server, Transfer};
use crate::objects::Objects;
use od_wire::AbortCode;
use od_wire::sdo::{Response, crc16};

/// A block download under way.
#[derive(Clone, Copy, Debug)]
pub(super) struct BlockDownload {
    /// The client makes a CRC.
    crc: bool,
    size: Option<u32>,
    /// Bytes in the buffer, those of the last segment that are no data included.
    received: usize,
    /// Segments that this block has.
    block_size: u8,
    /// The last segment of this block that came in sequence.
    ack: u8,
    /// The client said that no more segments follow.
    last: bool,
}

impl BlockDownload {
    pub(super) fn wants_segments(&self) -> bool {
        !self.last
    }
}

impl<const N: usize> Server<N> {
    /// Segments that the buffer has room for, 1–127.
    fn room(received: usize) -> u8 {
        ((N.saturating_sub(received)) / 7).clamp(1, 127) as u8
    }

    pub(super) fn begin_block_download(
        &mut self,
        objects: &mut Objects<'_>,
        address: Address,
        crc: bool,
        size: Option<u32>,
    ) -> Answer {
        self.begin(address);
        objects.writable(address, size.map(|size| size as usize))?;
        if size.is_some_and(|size| size as usize > N) {
            return Err(AbortCode::OutOfMemory);
        }
        let block_size = Self::room(0);
        self.transfer = Transfer::BlockDownload(BlockDownload {
            crc,
            size,
            received: 0,
            block_size,
            ack: 0,
            last: false,
        });
        Ok(Some(Response::InitiateBlockDownload {
            address,
            crc: true,
            block_size,
        }))
    }

    /// A segment. One that is out of sequence is passed over: the answer at the block's
    /// end tells the client where to go on.
    pub(super) fn block_segment(&mut self, mut block: BlockDownload, data: &[u8; 8]) -> Answer {
        let [head, bytes @ ..] = data;
        let (sequence, last) = (head & 0x7F, head & 0x80 != 0);
        if sequence == 0 || sequence > block.block_size {
            return Err(AbortCode::InvalidSequence);
        }
        if sequence == block.ack + 1 {
            let tail = self.buffer.get_mut(block.received..).unwrap_or(&mut []);
            // The last segment may carry bytes that are no data past the buffer's end.
            if tail.len() < 7 && !last {
                return Err(AbortCode::OutOfMemory);
            }
            let len = tail.len().min(7);
            tail[..len].copy_from_slice(&bytes[..len]);
            block.received += 7;
            block.ack = sequence;
            block.last = last;
        }
        let end = last || sequence == block.block_size;
        let ack = block.ack;
        if end {
            block.ack = 0;
            block.block_size = Self::room(block.received);
        }
        self.transfer = Transfer::BlockDownload(block);
        let block_size = block.block_size;
        Ok(end.then_some(Response::BlockDownloadResponse { ack, block_size }))
    }

    pub(super) fn end_block_download(
        &mut self,
        objects: &mut Objects<'_>,
        block: BlockDownload,
        unused: u8,
        crc: u16,
    ) -> Answer {
        let len = block.received.saturating_sub(unused.into());
        if let Some(size) = block.size {
            match len.cmp(&(size as usize)) {
                core::cmp::Ordering::Less => return Err(AbortCode::TooShort),
                core::cmp::Ordering::Greater => return Err(AbortCode::TooLong),
                core::cmp::Ordering::Equal => {}
            }
        }
        let data = self.buffer.get(..len).ok_or(AbortCode::OutOfMemory)?;
        if block.crc && crc16(data) != crc {
            return Err(AbortCode::Crc);
        }
        objects.write(self.address, data)?;
        self.reset();
        Ok(Some(Response::EndBlockDownload))
    }
}
