//! Settings of transfers.

use od_wire::Duration;

/// Settings of a transfer.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
#[non_exhaustive]
pub struct Options {
    /// Longest time from a request to its answer. A block upload waits that long for each segment.
    pub timeout: Duration,
    /// Most bytes that an upload accepts; a longer value is [`SdoError::TooLong`](super::SdoError::TooLong).
    pub limit: usize,
    /// Values of this many bytes and more go by block transfer; `None`: always segmented.
    ///
    /// For an upload the size that the server announces decides: the client aborts the
    /// segmented upload before its first segment and initiates a block upload. A server that
    /// aborts the block transfer with 0504 0001h gets a segmented one.
    pub block_from: Option<u32>,
    /// Segments in a block of an upload, 1 to 127; other numbers count as the nearest of these.
    pub block_size: u8,
    /// Number of blocks in a row that may bring no new segment before the transfer is
    /// [`SdoError::NoProgress`](super::SdoError::NoProgress).
    pub repeats: u8,
}

impl Options {
    /// 1 s, 1 MiB, block transfers from 64 bytes with 127 segments in a block, 3 repeats.
    pub const DEFAULT: Self = Self {
        timeout: Duration::from_secs(1),
        limit: 1 << 20,
        block_from: Some(64),
        block_size: 127,
        repeats: 3,
    };

    /// The same without block transfers.
    pub const SEGMENTED: Self = Self {
        block_from: None,
        ..Self::DEFAULT
    };

    /// Whether a value of `size` bytes goes by block transfer; `None`: the size is not known.
    pub(super) fn blocks(&self, size: Option<u32>) -> bool {
        matches!((self.block_from, size), (Some(from), Some(size)) if size >= from)
    }

    /// Segments in a block, within 1 to 127.
    pub(super) fn segments(&self) -> u8 {
        self.block_size.clamp(1, 127)
    }
}

impl Default for Options {
    fn default() -> Self {
        Self::DEFAULT
    }
}
