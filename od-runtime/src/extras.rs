//! Room for services that few devices have, so that a node without them pays nothing.

use core::marker::PhantomData;

use od_wire::CanId;

use crate::rooms::{FullRooms, Rooms};
use crate::sdo::SdoServer;
use crate::sync;

/// State of a node's further SDO servers, SYNC producer and TIME: the last parameter of
/// [`Node`](crate::Node): `()` for a node without them, or an [`Extra`].
///
/// `object_dictionary!` chooses it for the type `Node` of its module. A host that has memory to
/// allocate can bring its own, with as many servers as a dictionary needs.
pub trait Extras<D, const SDO: usize>: Sized {
    /// Room for what every node has. What a device has no use for takes none.
    type Rooms: Rooms;
    /// The room before power-on.
    const NEW: Self;
    /// SDO servers past the default one that there is room for, 0–127.
    const SERVERS: usize;
    /// Whether there is room for SYNC producer and TIME.
    const CLOCKS: bool;
    /// The further SDO servers; the first is that of 1201h.
    fn servers(&self) -> &[SdoServer<D, SDO, Self::Rooms>];
    /// As [`servers`](Self::servers).
    fn servers_mut(&mut self) -> &mut [SdoServer<D, SDO, Self::Rooms>];
    /// SYNC producer and TIME.
    fn clocks(&self) -> Option<&Clocks>;
    /// As [`clocks`](Self::clocks).
    fn clocks_mut(&mut self) -> Option<&mut Clocks>;
}

/// State of SYNC producer and TIME.
#[derive(Clone, Debug)]
pub struct Clocks {
    pub(crate) sync: sync::Producer,
    /// CAN-ID of the TIME messages that the device consumes.
    pub(crate) time_id: Option<CanId>,
}

impl Clocks {
    /// State before power-on.
    pub const fn new() -> Self {
        Self {
            sync: sync::Producer::IDLE,
            time_id: None,
        }
    }
}

impl Default for Clocks {
    fn default() -> Self {
        Self::new()
    }
}

/// A node without further SDO servers, SYNC producer and TIME, whose rooms are `R`.
#[derive(Clone, Debug)]
pub struct Only<R>(PhantomData<R>);

/// A node as [`Only`], with room for all else.
impl<D, const SDO: usize> Extras<D, SDO> for () {
    type Rooms = FullRooms;
    const NEW: Self = ();
    const SERVERS: usize = 0;
    const CLOCKS: bool = false;

    #[inline(always)]
    fn servers(&self) -> &[SdoServer<D, SDO>] {
        &[]
    }

    #[inline(always)]
    fn servers_mut(&mut self) -> &mut [SdoServer<D, SDO>] {
        &mut []
    }

    #[inline(always)]
    fn clocks(&self) -> Option<&Clocks> {
        None
    }

    #[inline(always)]
    fn clocks_mut(&mut self) -> Option<&mut Clocks> {
        None
    }
}

impl<D, R: Rooms, const SDO: usize> Extras<D, SDO> for Only<R> {
    type Rooms = R;
    const NEW: Self = Self(PhantomData);
    const SERVERS: usize = 0;
    const CLOCKS: bool = false;

    #[inline(always)]
    fn servers(&self) -> &[SdoServer<D, SDO, R>] {
        &[]
    }

    #[inline(always)]
    fn servers_mut(&mut self) -> &mut [SdoServer<D, SDO, R>] {
        &mut []
    }

    #[inline(always)]
    fn clocks(&self) -> Option<&Clocks> {
        None
    }

    #[inline(always)]
    fn clocks_mut(&mut self) -> Option<&mut Clocks> {
        None
    }
}

/// Room for SYNC producer and TIME, and for `SERVERS` further SDO servers with a buffer of `SDO` bytes
/// each; all other rooms are `R`.
#[derive(Clone, Debug)]
pub struct Extra<D, const SDO: usize, const SERVERS: usize, R: Rooms = FullRooms> {
    servers: [SdoServer<D, SDO, R>; SERVERS],
    clocks: Clocks,
}

impl<D, R: Rooms, const SDO: usize, const SERVERS: usize> Extras<D, SDO>
    for Extra<D, SDO, SERVERS, R>
{
    type Rooms = R;
    const NEW: Self = Self {
        servers: [const { SdoServer::new() }; SERVERS],
        clocks: Clocks::new(),
    };
    const SERVERS: usize = SERVERS;
    const CLOCKS: bool = true;

    #[inline]
    fn servers(&self) -> &[SdoServer<D, SDO, R>] {
        &self.servers
    }

    #[inline]
    fn servers_mut(&mut self) -> &mut [SdoServer<D, SDO, R>] {
        &mut self.servers
    }

    #[inline]
    fn clocks(&self) -> Option<&Clocks> {
        Some(&self.clocks)
    }

    #[inline]
    fn clocks_mut(&mut self) -> Option<&mut Clocks> {
        Some(&mut self.clocks)
    }
}
