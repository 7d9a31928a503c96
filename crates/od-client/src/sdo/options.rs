//! Settings of transfers.

use od_wire::Duration;

/// Settings of a transfer.
///
/// ```
/// use od_client::sdo::Options;
/// use od_client::{Client, Duration, lss};
///
/// let mut options = Options::DEFAULT;
/// options.timeout = Duration::from_millis(200);
/// let client = Client::with(options, lss::Options::DEFAULT);
/// assert_eq!(client.poll_timeout(), None);
/// ```
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
#[non_exhaustive]
pub struct Options {
    /// Longest time from a request to its response. A block upload waits for each segment this long.
    pub timeout: Duration,
    /// Limit of bytes of an upload; a longer value is [`Error::TooLong`](crate::Error::TooLong).
    pub limit: usize,
    /// Downloads of this many bytes or more use block transfer; `None`: always segmented. If the server
    /// aborts the block transfer with 0504 0001h, the client repeats it segmented.
    pub block_from: Option<u32>,
    /// Uploads begin as block transfers, which suits long values such as a DOMAIN. If the server aborts with
    /// 0504 0001h, the client repeats it segmented. Otherwise an upload is one expedited or segmented transfer,
    /// whatever the length of the value.
    pub block_upload: bool,
    /// Length of the object's data type, for an expedited response without a size (42h; CiA 301,
    /// 7.2.4.3.6: the number of bytes is not specified). `None`: all four.
    pub type_size: Option<usize>,
    /// Segments in a block of an upload, 1 to 127; other numbers are changed to the nearest of these.
    pub block_size: u8,
    /// Number of consecutive blocks that may bring no new segment before the transfer is
    /// [`Error::NoProgress`](crate::Error::NoProgress).
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

    /// Returns whether a download of `size` bytes uses block transfer; `None`: the size is unknown.
    pub(super) fn blocks(&self, size: Option<u32>) -> bool {
        matches!((self.block_from, size), (Some(from), Some(size)) if size >= from)
    }

    /// Segments in a block, limited to 1 to 127.
    pub(super) fn segments(&self) -> u8 {
        self.block_size.clamp(1, 127)
    }
}

impl Default for Options {
    fn default() -> Self {
        Self::DEFAULT
    }
}
