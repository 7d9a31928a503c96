//! Block upload: receives the segments block by block (CiA 301, chapters 7.2.4.3.13 to 7.2.4.3.15).

use od_wire::sdo::{Request, Response, crc16};
use od_wire::{AbortCode, Frame, Instant};

use super::buffer::Buffer;
use super::exchange::{Exchange, parse};
use crate::error::{Error, Expected};

/// A block upload after its initiation.
#[derive(Clone, Debug)]
pub(super) struct BlockUpload {
    /// The server computes a CRC.
    crc: bool,
    /// Announced length in bytes.
    size: Option<u32>,
    /// Segments in a block.
    block_size: u8,
    /// Number of the last segment of this block that came in sequence.
    ack: u8,
    /// A segment of this block has come.
    heard: bool,
    /// The last segment of the value; the end response tells how many of its bytes are data.
    tail: Option<[u8; 7]>,
    /// Number of bytes that came with the last segment.
    tail_length: u8,
    /// Number of consecutive blocks without a new segment.
    stalls: u8,
}

impl BlockUpload {
    pub(super) const fn new(crc: bool, size: Option<u32>, block_size: u8) -> Self {
        Self {
            crc,
            size,
            block_size,
            ack: 0,
            heard: false,
            tail: None,
            tail_length: 0,
            stalls: 0,
        }
    }

    pub(super) const fn wants_segments(&self) -> bool {
        self.tail.is_none()
    }

    /// Returns whether segments of the current block came. If the others are lost, the client can
    /// confirm the received part of the block.
    pub(super) const fn heard(&self) -> bool {
        self.heard
    }

    /// Handles a frame while segments are due. A segment out of sequence is ignored: the response
    /// at the end of the block tells the server where to continue.
    pub(super) fn segment(
        &mut self,
        exchange: &mut Exchange,
        buffer: &mut impl Buffer,
        now: Instant,
        frame: &Frame,
    ) {
        let [head, bytes @ ..] = *frame.bytes();
        let (sequence, last) = (head & 0x7F, head & 0x80 != 0);
        // Segments begin with 1, so 80h is an abort.
        if sequence == 0 || sequence > self.block_size {
            let got = parse(frame.bytes());
            return exchange.refuse(AbortCode::InvalidSequence, Expected::BlockSegment, got);
        }
        // How many bytes of the last segment are data, the end response says.
        let (needed, received) = (if last { 2 } else { 8 }, frame.dlc());
        if received < needed {
            return exchange.fail(AbortCode::Length, Error::Short { needed, received });
        }
        self.heard = true;
        exchange.wait(now);
        if sequence == self.ack + 1 {
            if last {
                self.tail = Some(bytes);
                self.tail_length = received - 1;
            } else if !exchange.keep(buffer, &bytes, self.size) {
                return;
            }
            self.ack = sequence;
        }
        if last || sequence == self.block_size {
            self.confirm(exchange);
        }
    }

    /// Tells the server how much of the block came.
    pub(super) fn confirm(&mut self, exchange: &mut Exchange) {
        if self.ack > 0 {
            self.stalls = 0;
        } else if self.stalls < exchange.options.repeats {
            self.stalls += 1;
        } else {
            return exchange.fail(AbortCode::InvalidSequence, Error::NoProgress);
        }
        exchange.send(Request::BlockUploadResponse {
            ack: self.ack,
            block_size: self.block_size,
        });
        self.ack = 0;
        self.heard = false;
    }

    /// The response after the last segment.
    pub(super) fn end(
        &mut self,
        exchange: &mut Exchange,
        buffer: &mut impl Buffer,
        response: Response,
    ) {
        let Response::EndBlockUpload { unused, crc } = response else {
            let expected = Expected::BlockUploadEnd;
            return exchange.refuse(AbortCode::InvalidCommand, expected, response);
        };
        let length = 7 - unused.min(7);
        if length > self.tail_length {
            let (needed, received) = (length + 1, self.tail_length + 1);
            return exchange.fail(AbortCode::Length, Error::Short { needed, received });
        }
        let tail = self.tail.unwrap_or_default();
        let tail = &tail[..usize::from(length)];
        if !exchange.keep(buffer, tail, self.size) || !exchange.check_complete(buffer, self.size) {
            return;
        }
        if self.crc && crc16(buffer.bytes()) != crc {
            return exchange.fail(AbortCode::Crc, Error::Crc);
        }
        exchange.send(Request::EndBlockUpload);
        exchange.finish();
    }
}
