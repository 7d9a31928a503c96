//! A network of a project or a node list.

use od_eds::network::{Master, Node};

/// A network as it was read.
#[derive(Default)]
pub(super) struct Network {
    /// Its name; empty if it has none.
    pub(super) name: String,
    /// The master of a project; one of a node list is a node.
    pub(super) master: Option<Master>,
    /// kbit/s, if the file of a node says so.
    pub(super) bit_rate: Option<u32>,
    pub(super) nodes: Vec<Node>,
}
