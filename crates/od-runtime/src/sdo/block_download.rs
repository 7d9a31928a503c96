//! Block download (CiA 301, chapters 7.2.4.3.9 to 7.2.4.3.11). The value is in the server's buffer.

use core::cmp::Ordering;

use od_wire::AbortCode;
use od_wire::sdo::{Response, crc16_after};

use super::window::Window;

/// A block download in progress.
#[derive(Clone, Copy, Debug)]
pub(super) struct BlockDownload {
    /// The client sends a CRC.
    crc: bool,
    /// CRC of the bytes before those in the buffer.
    pub(super) crc_before: u16,
    size: Option<u32>,
    /// Number of segments of this block.
    block_size: u8,
    /// Sequence number of the last segment that arrived in order.
    ack: u8,
    /// The client announced that no more segments follow.
    last: bool,
    /// Number of bytes of the last segment that the buffer had no room for; they have to be unused.
    cut: u8,
}

impl BlockDownload {
    /// Begins a download of `size` bytes, if the client announced a size, into a buffer with this
    /// room.
    pub(super) fn new(room: usize, crc: bool, size: Option<u32>) -> Self {
        Self {
            crc,
            crc_before: 0,
            size,
            block_size: segments(room),
            ack: 0,
            last: false,
            cut: 0,
        }
    }

    /// Number of segments of the next block.
    pub(super) const fn block_size(&self) -> u8 {
        self.block_size
    }

    /// Returns whether the next frame is a segment.
    pub(super) const fn wants_segments(&self) -> bool {
        !self.last
    }

    /// Handles a segment. A segment out of order is ignored: the response at the end of the block
    /// tells the client where to continue. Returns whether the block is complete.
    pub(super) fn segment(
        &mut self,
        window: &mut Window<'_>,
        data: &[u8; 8],
    ) -> Result<bool, AbortCode> {
        let [head, bytes @ ..] = data;
        let (sequence, last) = (head & 0x7F, head & 0x80 != 0);
        if sequence == 0 || sequence > self.block_size {
            return Err(AbortCode::InvalidSequence);
        }
        if sequence == self.ack + 1 {
            let len = window.room().min(7);
            // The unused bytes of the last segment may be beyond the end of the buffer.
            if len < 7 && !last {
                return Err(AbortCode::OutOfMemory);
            }
            window.put(&bytes[..len])?;
            window.part.len += len;
            self.cut = (7 - len) as u8;
            self.ack = sequence;
            self.last = last;
        }
        Ok(last || sequence == self.block_size)
    }

    /// Ends a block, and returns the response. The next block goes into a buffer with this room.
    pub(super) fn confirm(&mut self, room: usize) -> Response {
        self.block_size = segments(room);
        Response::BlockDownloadResponse {
            ack: core::mem::take(&mut self.ack),
            block_size: self.block_size,
        }
    }

    /// Checks that at most the announced number of bytes arrived; the last segment is still
    /// missing.
    pub(super) fn check_size(&self, window: &Window<'_>) -> Result<(), AbortCode> {
        match self.size {
            Some(size) if window.end() > size as usize => Err(AbortCode::TooLong),
            _ => Ok(()),
        }
    }

    /// Ends the transfer. Returns how many bytes of the buffer belong to the value, if it arrived
    /// completely.
    pub(super) fn end(
        &self,
        window: &Window<'_>,
        unused: u8,
        crc: u16,
    ) -> Result<usize, AbortCode> {
        let received = window.end() + usize::from(self.cut);
        let len = received.saturating_sub(unused.into());
        match self.size.map(|size| len.cmp(&(size as usize))) {
            Some(Ordering::Less) => return Err(AbortCode::TooShort),
            Some(Ordering::Greater) => return Err(AbortCode::TooLong),
            Some(Ordering::Equal) | None => {}
        }
        let len = len.saturating_sub(window.part.start);
        if len > window.part.len {
            return Err(AbortCode::OutOfMemory);
        }
        if self.crc && crc16_after(self.crc_before, window.first(len)) != crc {
            return Err(AbortCode::Crc);
        }
        Ok(len)
    }
}

/// Number of segments that fit into a buffer with this room, 1 to 127.
fn segments(room: usize) -> u8 {
    (room / 7).clamp(1, 127) as u8
}

#[cfg(test)]
mod tests {
    use super::super::window::Part;
    use super::*;

    const fn segment(head: u8) -> [u8; 8] {
        [head, 1, 2, 3, 4, 5, 6, 7]
    }

    #[test]
    fn a_block_has_as_many_segments_as_there_is_room_for() {
        for (room, segments) in [
            (0, 1),
            (13, 1),
            (14, 2),
            (888, 126),
            (889, 127),
            (9_999, 127),
        ] {
            let mut block = BlockDownload::new(room, false, None);
            assert_eq!(block.block_size(), segments, "{room}");
            block = BlockDownload::new(0, false, None);
            block.confirm(room);
            assert_eq!(block.block_size(), segments, "{room}");
        }
    }

    #[test]
    fn segments_must_arrive_in_sequence() {
        let (mut buffer, mut part) = ([0; 21], Part::default());
        let mut window = Window {
            buffer: &mut buffer,
            part: &mut part,
        };
        let mut block = BlockDownload::new(21, false, None);
        assert!(block.wants_segments());
        for wrong in [0, 4, 127] {
            let answer = block.segment(&mut window, &segment(wrong));
            assert_eq!(answer, Err(AbortCode::InvalidSequence), "{wrong}");
        }
        assert_eq!(block.segment(&mut window, &segment(2)), Ok(false));
        assert_eq!(
            (window.part.len, block.ack),
            (0, 0),
            "the first one is missing"
        );
        assert_eq!(block.segment(&mut window, &segment(1)), Ok(false));
        assert_eq!(block.segment(&mut window, &segment(3)), Ok(true));
        assert_eq!((window.part.len, block.ack), (7, 1));
        let Response::BlockDownloadResponse { ack, block_size } = block.confirm(14) else {
            panic!("a block is confirmed");
        };
        assert_eq!((ack, block_size), (1, 2));
        assert_eq!(block.segment(&mut window, &segment(1)), Ok(false));
        assert_eq!(block.segment(&mut window, &segment(0x82)), Ok(true));
        assert!(!block.wants_segments());
        assert_eq!((window.part.len, block.cut), (21, 0));
        assert_eq!(block.end(&window, 0, 0), Ok(21));
        assert_eq!(block.end(&window, 6, 0), Ok(15));
    }

    #[test]
    fn unused_bytes_of_the_last_segment_may_be_past_the_buffer() {
        let (mut buffer, mut part) = ([0; 10], Part::default());
        let mut window = Window {
            buffer: &mut buffer,
            part: &mut part,
        };
        let mut block = BlockDownload::new(10, false, None);
        assert_eq!(block.segment(&mut window, &segment(1)), Ok(true));
        block.confirm(window.room());
        let full = block.segment(&mut window, &segment(1));
        assert_eq!(full, Err(AbortCode::OutOfMemory), "more follows");
        assert_eq!(block.segment(&mut window, &segment(0x81)), Ok(true));
        assert_eq!((window.part.len, block.cut), (10, 4));
        assert_eq!(block.end(&window, 4, 0), Ok(10));
        assert_eq!(block.end(&window, 6, 0), Ok(8));
        assert_eq!(block.end(&window, 3, 0), Err(AbortCode::OutOfMemory));
    }

    #[test]
    fn a_value_has_the_announced_length_and_crc() {
        let (mut buffer, mut part) = ([0; 14], Part::default());
        let mut window = Window {
            buffer: &mut buffer,
            part: &mut part,
        };
        let mut block = BlockDownload::new(14, true, Some(7));
        assert_eq!(block.segment(&mut window, &segment(0x81)), Ok(true));
        let crc = crc16_after(0, &[1, 2, 3, 4, 5, 6, 7]);
        assert_eq!(block.end(&window, 0, crc), Ok(7));
        assert_eq!(block.end(&window, 0, crc ^ 1), Err(AbortCode::Crc));
        assert_eq!(block.end(&window, 1, crc), Err(AbortCode::TooShort));
        block.crc_before = 1;
        assert_eq!(block.end(&window, 0, crc), Err(AbortCode::Crc));
        for (size, end, so_far) in [
            (Some(6), Err(AbortCode::TooLong), Err(AbortCode::TooLong)),
            (Some(7), Ok(7), Ok(())),
            (Some(8), Err(AbortCode::TooShort), Ok(())),
            (None, Ok(7), Ok(())),
        ] {
            let block = BlockDownload {
                crc: false,
                size,
                ..block
            };
            assert_eq!(block.end(&window, 0, 0), end);
            assert_eq!(block.check_size(&window), so_far);
        }
    }

    #[test]
    fn a_stream_already_has_the_bytes_before_the_buffer() {
        let (mut buffer, mut part) = ([0; 7], Part::default());
        let mut window = Window {
            buffer: &mut buffer,
            part: &mut part,
        };
        window.part.start = 70;
        let mut block = BlockDownload::new(7, false, Some(75));
        assert_eq!(block.segment(&mut window, &segment(0x81)), Ok(true));
        assert_eq!(block.end(&window, 2, 0), Ok(5));
        assert_eq!(block.end(&window, 1, 0), Err(AbortCode::TooLong));
        assert_eq!(block.check_size(&window), Err(AbortCode::TooLong));
    }
}
