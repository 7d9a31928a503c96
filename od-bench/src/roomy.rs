//! The node of built-in devices and of files: it has every service, and room for what files have.

use core::any::Any;
use std::prelude::v1::*;

use od_model::Dictionary;
use od_runtime::{Clocks, Device, Extras, FullRooms, Node, NodeId, SdoServer};

use crate::slave::Slave;

/// A device whose dictionary is known at run time, with every service.
#[derive(Clone, Debug)]
struct Loaded;

impl Device for Loaded {
    const SERVERS: bool = true;
    const SYNC_PRODUCER: bool = true;
    const TIME: bool = true;
}

/// PDOs each way: all that CiA 301 knows.
const PDOS: usize = 512;
/// The longest value that a store can hold.
const LONGEST: usize = 0x1_0000;

/// Room for as many SDO servers as a dictionary has.
#[derive(Clone)]
struct Room {
    servers: Vec<SdoServer<Loaded, LONGEST>>,
    clocks: Clocks,
}

impl Extras<Loaded, LONGEST> for Room {
    type Rooms = FullRooms;
    const NEW: Self = Self {
        servers: Vec::new(),
        clocks: Clocks::new(),
    };
    const SERVERS: usize = 127;
    const CLOCKS: bool = true;

    fn servers(&self) -> &[SdoServer<Loaded, LONGEST>] {
        &self.servers
    }

    fn servers_mut(&mut self) -> &mut [SdoServer<Loaded, LONGEST>] {
        &mut self.servers
    }

    fn clocks(&self) -> Option<&Clocks> {
        Some(&self.clocks)
    }

    fn clocks_mut(&mut self) -> Option<&mut Clocks> {
        Some(&mut self.clocks)
    }
}

type Roomy = Node<Loaded, PDOS, LONGEST, Room>;

/// Returns a copy of a node made by [`roomy`]; `None` of another node.
pub(super) fn copy(node: &dyn Slave) -> Option<Box<dyn Slave>> {
    let node: &Roomy = (node as &dyn Any).downcast_ref()?;
    Some(Box::new(node.clone()))
}

/// Returns a node with room for what a dictionary has.
pub(super) fn roomy(node_id: NodeId, dictionary: Dictionary<'_>) -> Box<dyn Slave> {
    let mut servers = Vec::new();
    servers.resize_with(dictionary.servers(), SdoServer::new);
    let clocks = Clocks::new();
    let room = Room { servers, clocks };
    Box::new(Roomy::with_extras(node_id, room))
}
