//! Block upload (CiA 301, chapters 7.2.4.3.13 to 7.2.4.3.15). The value is in the server's buffer.

use od_wire::AbortCode;
use od_wire::sdo::{Response, block_segment, block_segments, crc16_after, unused};

/// A block upload in progress.
#[derive(Clone, Copy, Debug)]
pub(super) struct BlockUpload {
    len: usize,
    /// The client requests a CRC.
    crc: bool,
    /// CRC of the first `summed` bytes of the value.
    sum: u16,
    summed: usize,
    /// Number of segments that the client accepts before it confirms.
    block_size: u8,
    /// Number of bytes that the client has confirmed.
    done: usize,
    /// Number of segments of this block that were sent.
    sent: u8,
    phase: Phase,
}

#[derive(Clone, Copy, PartialEq, Eq, Debug)]
enum Phase {
    /// The client has to start the transfer.
    Initiated,
    /// Segments are being sent.
    Sending,
    /// The block was sent; the client has to confirm it.
    Sent,
    /// The client has confirmed everything, and has to end the transfer.
    Complete,
}

/// Checks the block size of a client: 1 to 127 segments.
pub(super) fn check(block_size: u8) -> Result<(), AbortCode> {
    match block_size {
        1..=127 => Ok(()),
        _ => Err(AbortCode::InvalidBlockSize),
    }
}

impl BlockUpload {
    /// Begins an upload of a value of `len` bytes.
    pub(super) const fn new(len: usize, crc: bool, block_size: u8) -> Self {
        Self {
            len,
            crc,
            sum: 0,
            summed: 0,
            block_size,
            done: 0,
            sent: 0,
            phase: Phase::Initiated,
        }
    }

    /// Length of the value in bytes.
    pub(super) const fn len(&self) -> usize {
        self.len
    }

    /// Returns whether only the end request of the client is missing.
    pub(super) fn is_complete(&self) -> bool {
        self.phase == Phase::Complete
    }

    /// Number of segments that are left at the start of this block.
    fn segments_left(&self) -> usize {
        block_segments(self.len - self.done)
    }

    fn expect(&self, phase: Phase) -> Result<(), AbortCode> {
        if self.phase == phase {
            Ok(())
        } else {
            Err(AbortCode::InvalidCommand)
        }
    }

    /// Handles the start request of the client.
    pub(super) fn start(&mut self) -> Result<(), AbortCode> {
        self.expect(Phase::Initiated)?;
        self.phase = Phase::Sending;
        Ok(())
    }

    /// Returns where the next segment begins in the value, if one is due.
    pub(super) fn due(&self) -> Option<usize> {
        let at = self.done + usize::from(self.sent) * 7;
        (self.phase == Phase::Sending).then_some(at)
    }

    /// Returns the segment that is due, which consists of the first bytes of `rest`.
    pub(super) fn segment(&mut self, rest: &[u8]) -> [u8; 8] {
        if self.due() == Some(self.summed) {
            let bytes = rest.get(..7).unwrap_or(rest);
            self.sum = crc16_after(self.sum, bytes);
            self.summed += bytes.len();
        }
        self.sent += 1;
        let last = usize::from(self.sent) >= self.segments_left();
        if last || self.sent >= self.block_size {
            self.phase = Phase::Sent;
        }
        block_segment(self.sent, rest, last)
    }

    /// Handles the confirmation of `ack` segments of the block: the next block follows, or the end.
    pub(super) fn acknowledged(
        &mut self,
        ack: u8,
        block_size: u8,
    ) -> Result<Option<[u8; 8]>, AbortCode> {
        self.expect(Phase::Sent)?;
        if ack > self.sent {
            return Err(AbortCode::InvalidSequence);
        }
        if usize::from(ack) < self.segments_left() {
            check(block_size)?;
            self.done += usize::from(ack) * 7;
            self.block_size = block_size;
            self.sent = 0;
            self.phase = Phase::Sending;
            return Ok(None);
        }
        self.done = self.len;
        self.phase = Phase::Complete;
        let end = Response::EndBlockUpload {
            unused: unused(self.len),
            crc: if self.crc { self.sum } else { 0 },
        };
        Ok(Some(end.emit()))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const DATA: [u8; 20] = [7; 20];

    fn send(block: &mut BlockUpload) -> Option<u8> {
        let at = block.due()?;
        Some(block.segment(&DATA[at..])[0])
    }

    #[test]
    fn a_client_keeps_to_the_order_of_a_block_upload() {
        let wrong = Err(AbortCode::InvalidCommand);
        let mut block = BlockUpload::new(20, true, 2);
        assert_eq!(send(&mut block), None, "not started");
        assert_eq!(block.acknowledged(0, 2), wrong.map(|()| None));
        assert_eq!(block.start(), Ok(()));
        assert_eq!(block.start(), wrong);
        assert_eq!(send(&mut block), Some(1));
        assert_eq!(block.acknowledged(1, 2), wrong.map(|()| None));
        assert_eq!(send(&mut block), Some(2));
        assert_eq!(send(&mut block), None, "the block is out");
        let too_many = block.acknowledged(3, 2);
        assert_eq!(too_many, Err(AbortCode::InvalidSequence));
        let no_size = block.acknowledged(1, 0);
        assert_eq!(no_size, Err(AbortCode::InvalidBlockSize));
        assert_eq!(block.acknowledged(1, 127), Ok(None));
        assert_eq!(block.due(), Some(7), "the second one comes again");
        assert_eq!(send(&mut block), Some(1));
        assert!(!block.is_complete());
        assert_eq!(send(&mut block), Some(0x82));
        let sum = crc16_after(0, &DATA);
        let end = Response::EndBlockUpload {
            unused: 1,
            crc: sum,
        };
        assert_eq!(block.acknowledged(2, 127), Ok(Some(end.emit())));
        assert!(block.is_complete());
        assert_eq!(block.acknowledged(2, 127), wrong.map(|()| None));
    }

    #[test]
    fn a_block_has_1_to_127_segments() {
        for (size, answer) in [
            (0, Err(AbortCode::InvalidBlockSize)),
            (1, Ok(())),
            (127, Ok(())),
            (128, Err(AbortCode::InvalidBlockSize)),
        ] {
            assert_eq!(check(size), answer, "{size}");
        }
    }
}
