//! Block upload (CiA 301, chapters 7.2.4.3.13–7.2.4.3.15).

use od_model::Address;

use super::{Answer, Server, Transfer};
use crate::objects::Objects;
use od_wire::AbortCode;
use od_wire::sdo::{Response, crc16};

/// A block upload under way: the value stands in the buffer.
#[derive(Clone, Copy, Debug)]
pub(super) struct BlockUpload {
    len: usize,
    crc: bool,
    /// Segments that the client takes before it answers.
    block_size: u8,
    /// Bytes that the client has acknowledged.
    done: usize,
    /// Segments of this block that were sent.
    sent: u8,
    phase: Phase,
}

#[derive(Clone, Copy, PartialEq, Eq, Debug)]
enum Phase {
    /// Waits for the client's start.
    Initiated,
    /// Segments go out.
    Sending,
    /// The block is out; waits for the client's answer.
    Sent,
    /// Everything is acknowledged; waits for the client's end.
    Complete,
}

impl BlockUpload {
    pub(super) fn is_complete(&self) -> bool {
        self.phase == Phase::Complete
    }

    /// Segments that are left at the start of this block; an empty value takes one.
    fn segments_left(&self) -> usize {
        (self.len - self.done).div_ceil(7).max(1)
    }
}

impl<const N: usize> Server<N> {
    pub(super) fn begin_block_upload(
        &mut self,
        objects: &mut Objects<'_>,
        address: Address,
        crc: bool,
        block_size: u8,
    ) -> Answer {
        self.begin(address);
        if !(1..=127).contains(&block_size) {
            return Err(AbortCode::InvalidBlockSize);
        }
        let mut number = [0; 8];
        let bytes = objects.read(address, &mut number)?;
        let room = self
            .buffer
            .get_mut(..bytes.len())
            .ok_or(AbortCode::OutOfMemory)?;
        room.copy_from_slice(bytes);
        let len = bytes.len();
        let phase = Phase::Initiated;
        self.transfer = Transfer::BlockUpload(BlockUpload {
            len,
            crc,
            block_size,
            done: 0,
            sent: 0,
            phase,
        });
        Ok(Some(Response::InitiateBlockUpload {
            address,
            crc: true,
            size: Some(len as u32),
        }))
    }

    pub(super) fn start_block(&mut self, mut block: BlockUpload) -> Answer {
        if block.phase != Phase::Initiated {
            return Err(AbortCode::InvalidCommand);
        }
        block.phase = Phase::Sending;
        self.transfer = Transfer::BlockUpload(block);
        Ok(None)
    }

    pub(super) fn next_segment(&mut self, mut block: BlockUpload) -> Option<[u8; 8]> {
        if block.phase != Phase::Sending {
            return None;
        }
        let start = block.done + usize::from(block.sent) * 7;
        let rest = self.buffer.get(start..block.len).unwrap_or(&[]);
        let len = rest.len().min(7);
        let mut frame = [0; 8];
        frame[1..1 + len].copy_from_slice(&rest[..len]);
        block.sent += 1;
        let last = usize::from(block.sent) >= block.segments_left();
        frame[0] = block.sent | u8::from(last) << 7;
        if last || block.sent >= block.block_size {
            block.phase = Phase::Sent;
        }
        self.transfer = Transfer::BlockUpload(block);
        Some(frame)
    }

    pub(super) fn block_acknowledged(
        &mut self,
        mut block: BlockUpload,
        ack: u8,
        block_size: u8,
    ) -> Answer {
        if block.phase != Phase::Sent {
            return Err(AbortCode::InvalidCommand);
        }
        if ack > block.sent {
            return Err(AbortCode::InvalidSequence);
        }
        if usize::from(ack) >= block.segments_left() {
            let unused = match block.len % 7 {
                0 if block.len > 0 => 0,
                tail => 7 - tail as u8,
            };
            block.done = block.len;
            block.phase = Phase::Complete;
            self.transfer = Transfer::BlockUpload(block);
            let crc = if block.crc {
                crc16(&self.buffer[..block.len])
            } else {
                0
            };
            return Ok(Some(Response::EndBlockUpload { unused, crc }));
        }
        if !(1..=127).contains(&block_size) {
            return Err(AbortCode::InvalidBlockSize);
        }
        block.done += usize::from(ack) * 7;
        block.block_size = block_size;
        block.sent = 0;
        block.phase = Phase::Sending;
        self.transfer = Transfer::BlockUpload(block);
        Ok(None)
    }
}
