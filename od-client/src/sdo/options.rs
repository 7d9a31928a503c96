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
    /// Downloads of this many bytes and more go by block transfer; `None`: always segmented. A server
    /// that aborts the block transfer with 0504 0001h gets a segmented one.
    pub block_from: Option<u32>,
    /// Uploads begin as block transfers: for long values, such as a DOMAIN. A server that aborts with
    /// 0504 0001h gets a segmented one. Without it an upload is one expedited or segmented transfer,
    /// however long the value is.
    pub block_upload: bool,
    /// Bytes of the object's data type, for an expedited answer that does not name its size (42h; CiA 301,
    /// 7.2.4.3.6: the number of bytes is not specified). `None`: all four.
    pub type_size: Option<usize>,
    /// Segments in a block of an upload, 1 to 127; other numbers count as the nearest of these.
    pub block_size: u8,
    /// Number of blocks in a row that may bring no new segment before the transfer is
    /// [`SdoError::NoProgress`](super::SdoError::NoProgress).
    pub repeats: u8,
}

impl Options {
    /// 1 s, 1 MiB, block downloads from 64 bytes, no block uploads, 127 segments in a block, 3 repeats.
    pub const DEFAULT: Self = Self {
        timeout: Duration::from_secs(1),
        limit: 1 << 20,
        block_from: Some(64),
        block_upload: false,
        type_size: None,
        block_size: 127,
        repeats: 3,
    };

    /// The same without block transfers.
    pub const SEGMENTED: Self = Self {
        block_from: None,
        ..Self::DEFAULT
    };

    /// Whether a download of `size` bytes goes by block transfer; `None`: the size is not known.
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
