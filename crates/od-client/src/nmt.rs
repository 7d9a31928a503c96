//! NMT master: commands to one node or to all (CiA 301, chapter 7.2.8).

use od_wire::nmt::Repr;
use od_wire::{CanId, Frame, NodeId};

pub use od_wire::nmt::{Command, State};

/// Returns the frame of a command; `None` addresses all nodes.
pub fn frame(node: Option<NodeId>, command: Command) -> Frame {
    let node = node.map_or(0, NodeId::raw);
    Frame::of(CanId::standard(0x000), &Repr { command, node }.emit())
}

#[cfg(test)]
mod tests {
    use std::string::ToString;

    use super::*;

    #[test]
    fn a_command_addresses_one_node_or_all() {
        let start = frame(NodeId::new(5), Command::Start);
        assert_eq!(start.to_string(), "000#0105");
        assert_eq!(frame(None, Command::ResetNode).to_string(), "000#8100");
    }
}
