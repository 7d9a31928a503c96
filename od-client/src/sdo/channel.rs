//! The two CAN-IDs of an SDO channel.

use od_wire::{CanId, NodeId};

/// The CAN-IDs between a client and a server (CiA 301, chapter 7.2.4).
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
