//! The node of built-in devices and of files: it has every service, and room for what files have.

use std::prelude::v1::*;

use od_model::Dictionary;
use od_runtime::{Device, Extras, Node, NodeId, SdoServer};

use crate::slave::Slave;

/// A device whose dictionary is known at run time, with every service.
#[derive(Debug)]
struct Loaded;

impl Device for Loaded {
    const SERVERS: bool = true;
}

/// PDOs each way: all that CiA 301 knows.
const PDOS: usize = 512;
/// The longest value that a store can hold.
const LONGEST: usize = 0x1_0000;

/// Room for as many SDO servers as a dictionary has.
struct Room {
    servers: Vec<SdoServer<Loaded, LONGEST>>,
}

impl Extras<Loaded, LONGEST> for Room {
    const NEW: Self = Self {
        servers: Vec::new(),
    };
    const SERVERS: usize = 127;

    fn servers(&self) -> &[SdoServer<Loaded, LONGEST>] {
        &self.servers
    }

    fn servers_mut(&mut self) -> &mut [SdoServer<Loaded, LONGEST>] {
        &mut self.servers
    }
}

/// Returns a node with room for what a dictionary has.
pub(super) fn roomy(node_id: NodeId, dictionary: Dictionary<'_>) -> Box<dyn Slave> {
    let mut servers = Vec::new();
    servers.resize_with(dictionary.servers(), SdoServer::new);
    let room = Room { servers };
    Box::new(Node::<Loaded, PDOS, LONGEST, Room>::with_extras(
        node_id, room,
    ))
}
