//! CAN-IDs that a node may send by.

use od_runtime::{Frame, NodeId};

/// The service of a node with this node ID that owns the CAN-ID of a frame by CiA 301 or CiA 305, if there is
/// one: error control, the default SDO server, LSS.
///
/// # Panics
/// The CAN-ID is restricted (CiA 301, table 40), and the node does not own it.
pub fn owner(node: NodeId, frame: &Frame) -> Option<&'static str> {
    let id = u32::from(frame.id().as_standard()?);
    let own = u32::from(node.raw());
    match id {
        0x7E4 => Some("LSS"),
        _ if id == 0x700 + own => Some("error control"),
        _ if id == 0x580 + own => Some("default SDO server"),
        _ => {
            assert!(!od_model::is_restricted(id), "node {own} sends {frame}");
            None
        }
    }
}
