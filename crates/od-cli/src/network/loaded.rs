//! A network, whatever kind of file describes it.

use od_eds::network::{Master, Node};

/// A network that was read from a project or a node list.
#[derive(Default)]
pub(super) struct Network {
    /// Name; empty if it has none.
    pub(super) name: String,
    /// The master of a project; in a node list the master is a node.
    pub(super) master: Option<Master>,
    /// Bit rate in kbit/s, if the file of a node has one.
    pub(super) bit_rate: Option<u32>,
    pub(super) nodes: Vec<Node>,
}
