//! Room for services that few devices have, so that a node without them pays nothing.

use crate::sdo::SdoServer;

/// What a node keeps for further SDO servers, as the last parameter of
/// [`Node`](crate::Node): `()` for a node without them, or an [`Extra`].
///
/// `object_dictionary!` chooses it for the type `Node` of its module. A host that has memory to
/// allocate can bring its own, with as many servers as a dictionary needs.
pub trait Extras<D, const SDO: usize>: Sized {
    /// The room before power-on.
    const NEW: Self;
    /// SDO servers past the default one that there is room for, 0–127.
    const SERVERS: usize;
    /// The further SDO servers; the first is that of 1201h.
    fn servers(&self) -> &[SdoServer<D, SDO>];
    /// As [`servers`](Self::servers).
    fn servers_mut(&mut self) -> &mut [SdoServer<D, SDO>];
}

impl<D, const SDO: usize> Extras<D, SDO> for () {
    const NEW: Self = ();
    const SERVERS: usize = 0;

    #[inline(always)]
    fn servers(&self) -> &[SdoServer<D, SDO>] {
        &[]
    }

    #[inline(always)]
    fn servers_mut(&mut self) -> &mut [SdoServer<D, SDO>] {
        &mut []
    }
}

/// Room for `SERVERS` further SDO servers with a buffer of `SDO` bytes each.
#[derive(Debug)]
pub struct Extra<D, const SDO: usize, const SERVERS: usize> {
    servers: [SdoServer<D, SDO>; SERVERS],
}

impl<D, const SDO: usize, const SERVERS: usize> Extras<D, SDO> for Extra<D, SDO, SERVERS> {
    const NEW: Self = Self {
        servers: [const { SdoServer::new() }; SERVERS],
    };
    const SERVERS: usize = SERVERS;

    #[inline]
    fn servers(&self) -> &[SdoServer<D, SDO>] {
        &self.servers
    }

    #[inline]
    fn servers_mut(&mut self) -> &mut [SdoServer<D, SDO>] {
        &mut self.servers
    }
}
