//! An SDO server past the default one: a server and its two COB-IDs (1201h to 127Fh).

use od_model::Address;
use od_wire::{AbortCode, CanId, CobId, Frame};

use super::{Server, Transfer};
use crate::device::Device;
use crate::objects::Objects;
use crate::rooms::{FullRooms, Rooms};
use crate::store::Store;

/// SDO server of one of the objects 1201h to 127Fh, with a transfer of its own. `N` is the room for
/// its buffer in bytes, as that of the default server.
#[derive(Clone, Debug)]
pub struct SdoServer<D, const N: usize, R: Rooms = FullRooms> {
    pub(crate) server: Server<D, N, R>,
    /// The two COB-IDs, while both are valid.
    channel: Option<Channel>,
    /// Both COB-IDs are valid, and their CAN-IDs are not.
    refused: bool,
}

/// Result of [`SdoServer::configure`].
pub(crate) struct Configured {
    /// Its channel is another one than before: the transfer on the old one has lost its client.
    pub(crate) has_changed: bool,
    /// It was not refused before: both COB-IDs are valid, and a CAN-ID is not.
    pub(crate) is_refused: bool,
}

/// The COB-IDs of an SDO: from client to server, and back.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
struct Channel {
    request: CanId,
    response: CanId,
}

impl<D, const N: usize, R: Rooms> SdoServer<D, N, R> {
    /// A server before power-on.
    pub const fn new() -> Self {
        Self {
            server: Server::idle(),
            channel: None,
            refused: false,
        }
    }

    /// Whether it receives frames with this CAN-ID.
    pub(crate) fn takes(&self, id: CanId) -> bool {
        self.received_by() == Some(id)
    }

    /// The CAN-ID of its requests, while it is valid.
    pub(crate) fn received_by(&self) -> Option<CanId> {
        self.channel.map(|channel| channel.request)
    }

    /// The frame of a response; `None` where it has no COB-ID any more.
    pub(crate) fn frame(&self, data: [u8; 8]) -> Option<Frame> {
        let channel = self.channel?;
        Some(Frame::full(channel.response, data))
    }

    /// The CAN-ID of its responses, while it is valid.
    pub(crate) fn sent_by(&self) -> Option<CanId> {
        self.channel.map(|channel| channel.response)
    }

    /// Reads its object again. `is_taken` knows the CAN-IDs by which other services send.
    pub(crate) fn configure(
        &mut self,
        store: &Store<'_>,
        index: u16,
        is_taken: &dyn Fn(CanId) -> bool,
    ) -> Configured {
        let cob_id = |sub| {
            let cob_id = CobId::new(store.try_word(index, sub)?);
            cob_id.is_valid().then(|| cob_id.usable_id())
        };
        let (both, channel) = match (cob_id(1), cob_id(2)) {
            (Some(request), Some(response)) => {
                let response = response.filter(|id| !is_taken(*id));
                let channel = request.zip(response);
                (
                    true,
                    channel.map(|(request, response)| Channel { request, response }),
                )
            }
            _ => (false, None),
        };
        let refused = both && channel.is_none();
        Configured {
            has_changed: core::mem::replace(&mut self.channel, channel) != channel,
            is_refused: !core::mem::replace(&mut self.refused, refused) && refused,
        }
    }
}

impl<D, const N: usize, R: Rooms> Default for SdoServer<D, N, R> {
    fn default() -> Self {
        Self::new()
    }
}

/// Notices from one of several servers to the others.
impl<D: Device, const N: usize, R: Rooms> Server<D, N, R> {
    /// As [`handle`](Self::handle), and what the frame commands is carried out.
    pub(crate) fn ask(
        &mut self,
        objects: &mut Objects<'_, D>,
        data: &[u8; 8],
        dlc: u8,
    ) -> Option<[u8; 8]> {
        let answer = self.handle(objects, data, dlc);
        match objects.carry_out() {
            Some(done) => self.finish(objects, done),
            None => answer,
        }
    }

    /// Refuses a request that begins a transfer.
    #[cold]
    pub(crate) fn refuse(
        &mut self,
        objects: &mut Objects<'_, D>,
        address: Address,
        code: AbortCode,
    ) -> [u8; 8] {
        self.replace(objects, address);
        let abort = self.abort(objects, code);
        self.look();
        abort
    }

    /// The value that the application streams.
    pub(crate) fn streamed(&self) -> Option<Address> {
        self.streams().then_some(self.address)
    }

    /// Whether the next frame is data, whatever it looks like, or waits.
    pub(crate) fn takes_anything(&self) -> bool {
        self.late().is_awaited()
            || matches!(self.transfer(), Transfer::BlockDownload(block) if block.wants_segments())
    }

    /// Whether a client waits for the end of a save.
    pub(crate) fn awaits_save(&self) -> bool {
        self.late().is_awaited() && !self.late().awaits_stream()
    }
}
