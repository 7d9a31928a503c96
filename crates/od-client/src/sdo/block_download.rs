//! Block download: sends the segments block by block (CiA 301, chapters 7.2.4.3.9 to 7.2.4.3.11).

use od_wire::AbortCode;
use od_wire::sdo::{Request, Response, block_segment, block_segments, crc16, unused};

use super::exchange::Exchange;
use crate::error::{Error, Expected};

/// A block download after its initiation.
#[derive(Clone, Debug)]
pub(super) struct BlockDownload {
    /// The server checks a CRC.
    crc: bool,
    /// Segments that the server accepts before it responds.
    block_size: u8,
    /// Bytes that the server confirmed.
    done: usize,
    /// Number of segments of this block that were sent.
    sent: u8,
    /// Number of consecutive blocks without an accepted segment.
    stalls: u8,
    /// All data is confirmed; the end request was sent.
    is_complete: bool,
}

/// Checks the block size of a server; fails unless it is 1 to 127.
fn check(exchange: &mut Exchange, block_size: u8, expected: Expected, got: Response) -> bool {
    let fits = (1..=127).contains(&block_size);
    if !fits {
        exchange.refuse(AbortCode::InvalidBlockSize, expected, got);
    }
    fits
}

impl BlockDownload {
    /// Starts after the response of the server. `None` if its block size is invalid.
    pub(super) fn new(exchange: &mut Exchange, crc: bool, block_size: u8) -> Option<Self> {
        let got = Response::InitiateBlockDownload {
            address: exchange.address,
            crc,
            block_size,
        };
        check(exchange, block_size, Expected::BlockDownload, got).then_some(Self {
            crc,
            block_size,
            done: 0,
            sent: 0,
            stalls: 0,
            is_complete: false,
        })
    }

    /// Number of segments that were left at the start of this block.
    fn segments_left(&self, data: &[u8]) -> usize {
        block_segments(data.len().saturating_sub(self.done))
    }

    /// The next segment of the block, if it has more.
    pub(super) fn next_segment(&mut self, data: &[u8]) -> Option<[u8; 8]> {
        let left = self.segments_left(data);
        if self.is_complete || self.sent >= self.block_size || usize::from(self.sent) >= left {
            return None;
        }
        let start = self.done + usize::from(self.sent) * 7;
        let rest = data.get(start..).unwrap_or_default();
        self.sent += 1;
        let last = usize::from(self.sent) == left;
        Some(block_segment(self.sent, rest, last))
    }

    /// Handles a response of the server.
    pub(super) fn handle(&mut self, exchange: &mut Exchange, data: &[u8], response: Response) {
        match response {
            Response::EndBlockDownload if self.is_complete => exchange.finish(),
            Response::BlockDownloadResponse { ack, .. } if !self.is_complete && ack > self.sent => {
                let expected = Expected::BlockConfirmation;
                exchange.refuse(AbortCode::InvalidSequence, expected, response);
            }
            Response::BlockDownloadResponse { ack, block_size } if !self.is_complete => {
                self.confirmed(exchange, data, ack, block_size);
            }
            other => {
                let expected = if self.is_complete {
                    Expected::BlockDownloadEnd
                } else {
                    Expected::BlockConfirmation
                };
                exchange.refuse(AbortCode::InvalidCommand, expected, other);
            }
        }
    }

    /// The server has the first `ack` segments of the block; the others are repeated.
    fn confirmed(&mut self, exchange: &mut Exchange, data: &[u8], ack: u8, block_size: u8) {
        if usize::from(ack) >= self.segments_left(data) {
            self.is_complete = true;
            let unused = unused(data.len());
            let crc = if self.crc { crc16(data) } else { 0 };
            return exchange.send(Request::EndBlockDownload { unused, crc });
        }
        let got = Response::BlockDownloadResponse { ack, block_size };
        if !check(exchange, block_size, Expected::BlockConfirmation, got) {
            return;
        }
        if ack > 0 {
            self.stalls = 0;
        } else if self.stalls < exchange.options.repeats {
            self.stalls += 1;
        } else {
            return exchange.fail(AbortCode::InvalidSequence, Error::NoProgress);
        }
        self.done += usize::from(ack) * 7;
        self.sent = 0;
        self.block_size = block_size;
        exchange.stop_waiting();
    }
}
