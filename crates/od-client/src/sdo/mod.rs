//! SDO client (CiA 301, chapter 7.2.4): expedited, segmented and block transfers, in both directions.
//!
//! [`Upload`] reads one object, [`Download`] writes one. Each is a state machine without a
//! clock, a bus or an allocator:
//!
//! ```
//! use od_client::sdo::{Channel, Options, Slice, Upload};
//! use od_client::{Frame, Instant, NodeId};
//! use od_model::Address;
//!
//! let mut room = [0; 16];
//! let channel = Channel::of(NodeId::ONE);
//! let object = Address::new(0x1018, 1);
//! let mut upload = Upload::new(channel, object, Slice::new(&mut room), Options::DEFAULT);
//! let mut now = Instant::ZERO;
//! while upload.outcome().is_none() {
//!     while let Some(frame) = upload.poll_transmit(now) {
//!         assert_eq!(frame.to_string(), "601#4018100100000000"); // here the host sends it
//!     }
//!     now = now.plus_millis(2); // here the host waits for a frame, or for `poll_timeout`
//!     let answer = [0x43, 0x18, 0x10, 0x01, 0xEC, 0, 0, 0];
//!     upload.handle_frame(now, &Frame::standard(0x581, &answer));
//!     upload.handle_timeout(now);
//! }
//! assert_eq!(upload.outcome(), Some(Ok(())));
//! assert_eq!(upload.bytes(), [0xEC, 0, 0, 0]);
//! ```
//! After the [`Upload::outcome`], `poll_transmit` may still have one frame: the abort of a
//! transfer that the client gave up, or the confirmation at the end of a block upload.

mod block_download;
mod block_upload;
mod buffer;
mod download;
mod exchange;
mod options;
mod upload;

use od_wire::{CanId, NodeId};

pub use crate::error::Expected;
pub use buffer::{Buffer, Slice};
pub use download::Download;
pub use options::Options;
pub use upload::Upload;

/// The CAN-IDs between a client and a server (CiA 301, chapter 7.2.4).
///
/// ```
/// use od_client::sdo::Channel;
/// use od_client::{CanId, NodeId};
///
/// let channel = Channel::of(NodeId::ONE);
/// assert_eq!((channel.request, channel.response), (CanId::standard(0x601), CanId::standard(0x581)));
/// ```
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug)]
pub struct Channel {
    /// From client to server: 1200h:01.
    pub request: CanId,
    /// From server to client: 1200h:02.
    pub response: CanId,
}

impl Channel {
    /// The default SDO channel of a node: 600h and 580h, plus the node ID.
    pub const fn of(node: NodeId) -> Self {
        Self {
            request: node.plus(0x600),
            response: node.plus(0x580),
        }
    }
}
