//! SDO server (CiA 301, chapter 7.2.4): expedited, segmented and block transfers in both
//! directions.
//!
//! The server buffers a download and writes it when it is complete, so an interrupted download
//! leaves the object unchanged. If the application streams the value, the buffer has one part of it
//! at a time.

mod block_download;
mod block_upload;
mod late;
mod request;
mod segmented;
mod streamed;
mod window;

use core::marker::PhantomData;

use od_model::Address;

use crate::application::{Halt, StreamEnd};
use crate::blank::Blank;
use crate::deadline::Deadline;
use crate::number::number_in;
use crate::objects::{Objects, Unread};
use crate::services::Services;
use crate::store::Store;
use od_wire::sdo::{Response, address, expedited_upload};
use od_wire::{AbortCode, CanId, CobId, Frame, Instant, NodeId};

use block_download::BlockDownload;
use block_upload::BlockUpload;
use late::{Held, Late};
use segmented::{Download, Upload};
use window::{Part, Window};

/// Longest time that a block transfer waits for the client, in microseconds. Segments look like
/// requests, so a transfer whose client has stopped would swallow the next request.
const BLOCK_TIMEOUT_US: u64 = 5_000_000;

/// First byte of an abort, as clients send it.
const ABORT: u8 = 0x80;

/// A transfer in progress; without one it is all zeros, which an `Option` would not ensure.
#[derive(Clone, Copy, Debug, Default)]
#[repr(u8)]
enum Transfer {
    #[default]
    None,
    /// An expedited download of this number of bytes that the stream has not accepted yet.
    Expedited(u8),
    Upload(Upload),
    Download(Download),
    BlockUpload(BlockUpload),
    BlockDownload(BlockDownload),
}

/// State of an SDO server: its channel, and one transfer at a time. The first server is the default
/// one (1200h), the others are those of 1201h to 127Fh.
#[derive(Clone, Debug)]
pub struct SdoServer {
    /// The two CAN-IDs, while both are valid.
    channel: Option<Channel>,
    /// Both COB-IDs are valid, but a CAN-ID is refused.
    refused: bool,
    state: State,
    /// Part of the value that is in the buffer.
    part: Part,
}

/// State of a transfer.
#[derive(Clone, Debug)]
struct State {
    /// The application streams the value of the transfer.
    is_streaming: bool,
    address: Address,
    transfer: Transfer,
    deadline: Deadline,
    late: Late,
}

impl State {
    const IDLE: Self = Self {
        is_streaming: false,
        address: Address::new(0, 0),
        transfer: Transfer::None,
        deadline: Deadline::NEVER,
        late: Late::BLANK,
    };

    /// Returns whether the next frame is a segment (also if it looks like a request), or has to wait.
    fn takes_anything(&self) -> bool {
        self.late.is_awaited()
            || matches!(&self.transfer, Transfer::BlockDownload(block) if block.wants_segments())
    }
}

/// CAN-IDs of an SDO: from client to server, and from server to client.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
struct Channel {
    request: CanId,
    response: CanId,
}

/// Result of [`SdoServer::configure`].
pub(crate) struct Configured {
    /// Its channel has changed, so the transfer on the old one has no client any more.
    pub(crate) has_changed: bool,
    /// It has become refused: both COB-IDs are valid, but a CAN-ID belongs to another service or is
    /// restricted.
    pub(crate) is_refused: bool,
}

impl Blank for SdoServer {
    const BLANK: Self = Self {
        channel: None,
        refused: false,
        state: State::IDLE,
        part: Part { start: 0, len: 0 },
    };
}

impl SdoServer {
    /// The CAN-ID of its requests, while it is valid.
    pub(crate) fn received_by(&self) -> Option<CanId> {
        self.channel.map(|channel| channel.request)
    }

    /// The CAN-ID of its responses, while it is valid.
    pub(crate) fn sent_by(&self) -> Option<CanId> {
        self.channel.map(|channel| channel.response)
    }

    /// Returns the frame of a response; `None` if the server has no valid COB-ID any more.
    pub(crate) fn frame(&self, data: [u8; 8]) -> Option<Frame> {
        Some(Frame::full(self.channel?.response, data))
    }

    /// Gives the default server its channel (CiA 301, chapter 7.3.3: 600h and 580h + node ID).
    pub(crate) fn configure_default(&mut self, node_id: NodeId) {
        self.channel = Some(Channel {
            request: node_id.plus(0x600),
            response: node_id.plus(0x580),
        });
    }

    /// Reads the object of a further server again. `is_taken` returns whether another service sends
    /// with a CAN-ID.
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

    /// Drops the transfer without telling client or application, as at power-off.
    pub(crate) fn forget(&mut self) {
        self.state = State::IDLE;
    }

    /// Returns whether the next frame is a segment (also if it looks like a request), or has to wait.
    pub(crate) fn takes_anything(&self) -> bool {
        self.state.takes_anything()
    }

    /// Returns whether a client waits for the end of a save.
    pub(crate) fn awaits_save(&self) -> bool {
        self.state.late.is_awaited() && !self.state.late.awaits_stream()
    }

    /// Returns whether a block upload may have a segment to send.
    pub(crate) fn is_sending(&self) -> bool {
        matches!(self.state.transfer, Transfer::BlockUpload(_))
    }

    /// The value that the application streams.
    pub(crate) fn streamed(&self) -> Option<Address> {
        self.state.is_streaming.then_some(self.state.address)
    }

    /// Takes the request that waited for a response.
    pub(crate) fn held(&mut self) -> Option<Held> {
        self.state.late.held.take()
    }

    /// Time when a block transfer times out, or when a stream is asked again.
    pub(crate) const fn deadline(&self) -> Deadline {
        self.state.deadline
    }
}

/// An SDO server with its buffer.
pub(crate) struct Server<'s, D> {
    device: PhantomData<D>,
    state: &'s mut State,
    window: Window<'s>,
}

/// Response of the server, if there is one, or the reason why there is none.
type Answer = Result<Option<[u8; 8]>, Stop>;

/// Reason why a request has no response yet, or an abort as response. Like [`Halt`], but the time
/// is in the deadline of the server.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
enum Stop {
    Abort(AbortCode),
    /// The server waits until its deadline.
    Wait,
}

impl From<AbortCode> for Stop {
    fn from(code: AbortCode) -> Self {
        Self::Abort(code)
    }
}

impl Stop {
    fn new(halt: Halt, deadline: &mut Deadline) -> Self {
        match halt {
            Halt::Abort(code) => Self::Abort(code),
            Halt::Until(at) => {
                *deadline = Deadline::at(at);
                Self::Wait
            }
        }
    }
}

impl<'s, D: Services> Server<'s, D> {
    pub(crate) fn new(server: &'s mut SdoServer, buffer: &'s mut [u8]) -> Self {
        Self {
            device: PhantomData,
            state: &mut server.state,
            window: Window {
                buffer,
                part: &mut server.part,
            },
        }
    }

    /// Ends the transfer without an abort to the client, as a change of the NMT state does.
    pub(crate) fn cut(&mut self, objects: &mut Objects<'_, D>) {
        self.close(objects, StreamEnd::Cut);
        *self.state = State::IDLE;
    }

    /// Ends the transfer.
    fn reset(&mut self) {
        self.state.transfer = Transfer::None;
        self.state.deadline = Deadline::NEVER;
    }

    /// Handles a frame of the client; the bytes of `data` beyond `dlc` are 0. The response to a
    /// [command](Objects::carry_out) waits.
    pub(crate) fn handle(
        &mut self,
        objects: &mut Objects<'_, D>,
        data: &[u8; 8],
        dlc: u8,
    ) -> Option<[u8; 8]> {
        if dlc < objects.profile.sdo.min_dlc {
            return None;
        }
        // The short way: most requests are uploads while no other transfer is in progress.
        let is_busy = self.state.takes_anything() || self.streams() || self.is_in_block();
        if data[0] >> 5 == 2 && !is_busy {
            self.handle_upload(objects, data, dlc)
        } else {
            self.handle_by_state(objects, data, dlc)
        }
    }

    /// Handles a request for an upload (CiA 301, chapter 7.2.4.3.6).
    fn handle_upload(
        &mut self,
        objects: &mut Objects<'_, D>,
        data: &[u8; 8],
        dlc: u8,
    ) -> Option<[u8; 8]> {
        let address = address(data);
        self.reset();
        self.state.address = address;
        match self.upload(objects, address) {
            Ok(answer) => Some(answer),
            Err(Unread::Abort(code)) => Some(self.abort(objects, code)),
            Err(Unread::Streamed) => self.handle_streamed(objects, data, dlc),
        }
    }

    /// Handles a frame whose meaning depends on the transfer in progress, and each request that does not begin an upload.
    fn handle_by_state(
        &mut self,
        objects: &mut Objects<'_, D>,
        data: &[u8; 8],
        dlc: u8,
    ) -> Option<[u8; 8]> {
        if (D::STORAGE || D::STREAMS) && self.state.late.is_awaited() {
            self.state.late.hold(data, dlc, D::STREAMS);
            if D::STREAMS && data[0] == ABORT && self.state.late.awaits_stream() {
                let answer = self.request(objects, data, dlc);
                self.state.late = Late::BLANK;
                self.end_request(objects, answer, data, dlc);
            }
            return None;
        }
        let answer = match self.state.transfer {
            Transfer::BlockDownload(block)
                if D::BLOCK && block.wants_segments() && data[0] != ABORT =>
            {
                self.block_segment(objects, data)
            }
            _ if (D::STREAMS || D::BLOCK) && data[0] >> 5 == 2 => {
                self.close(objects, StreamEnd::Replaced);
                return self.handle_upload(objects, data, dlc);
            }
            _ => self.request(objects, data, dlc),
        };
        self.end_request(objects, answer, data, dlc)
    }

    /// Ends the handling of a request: returns the response, and sets the next deadline.
    fn end_request(
        &mut self,
        objects: &mut Objects<'_, D>,
        answer: Answer,
        data: &[u8; 8],
        dlc: u8,
    ) -> Option<[u8; 8]> {
        let until = self.state.deadline;
        self.await_client(objects.now);
        let is_late = objects.is_commanded();
        match answer {
            Ok(Some(response)) if is_late => {
                self.state.late = Late::new(response);
                None
            }
            Ok(response) => response,
            Err(Stop::Abort(code)) => Some(self.abort(objects, code)),
            Err(Stop::Wait) => {
                if D::STREAMS {
                    self.await_stream(until, Some((*data, dlc)));
                }
                None
            }
        }
    }

    /// Restarts the time that a block transfer waits for its client.
    fn await_client(&mut self, now: Instant) {
        self.state.deadline = if self.is_in_block() {
            Deadline::at(now.plus_micros(BLOCK_TIMEOUT_US))
        } else {
            Deadline::NEVER
        };
    }

    /// Returns whether a block transfer is in progress, whose segments may look like requests.
    fn is_in_block(&self) -> bool {
        D::BLOCK
            && matches!(
                self.state.transfer,
                Transfer::BlockDownload(_) | Transfer::BlockUpload(_)
            )
    }

    /// Replaces a transfer that was not complete.
    fn replace(&mut self, objects: &mut Objects<'_, D>, address: Address) {
        self.close(objects, StreamEnd::Replaced);
        self.state.address = address;
    }

    fn upload(
        &mut self,
        objects: &mut Objects<'_, D>,
        address: Address,
    ) -> Result<[u8; 8], Unread> {
        let segmented = D::SEGMENTED && objects.profile.sdo.segmented_upload;
        let mut number = [0; 8];
        let bytes = objects.read(address, &mut number)?;
        match *bytes {
            [_] | [_, _] | [_, _, _] | [_, _, _, _] => Ok(expedited_upload(
                address,
                bytes.len() as u8,
                number_in(bytes) as u32,
            )),
            _ if !segmented => Err(Unread::Abort(AbortCode::UnsupportedAccess)),
            _ => self.begin_upload(address, bytes),
        }
    }

    /// Begins an upload. A value of more than four bytes, or of none, is sent in segments.
    fn begin_upload(&mut self, address: Address, bytes: &[u8]) -> Result<[u8; 8], Unread> {
        let len = self.window.load(bytes)?;
        self.state.transfer = Transfer::Upload(Upload::new(len));
        Ok(Response::InitiateUpload {
            address,
            size: Some(len as u32),
            expedited: None,
        }
        .emit())
    }

    /// Begins an upload of a value that the application streams.
    fn handle_streamed(
        &mut self,
        objects: &mut Objects<'_, D>,
        data: &[u8; 8],
        dlc: u8,
    ) -> Option<[u8; 8]> {
        if !D::STREAMS {
            return None;
        }
        let answer = self.stream_upload(objects);
        self.end_request(objects, answer, data, dlc)
    }

    fn abort(&mut self, objects: &mut Objects<'_, D>, code: AbortCode) -> [u8; 8] {
        self.close(objects, StreamEnd::Aborted(code));
        Response::Abort {
            address: self.state.address,
            code: code.code(),
        }
        .emit()
    }

    /// Returns the next segment of a block upload, if one is due, or an abort.
    pub(crate) fn poll(&mut self, objects: &mut Objects<'_, D>) -> Option<[u8; 8]> {
        let Transfer::BlockUpload(block) = &self.state.transfer else {
            return None;
        };
        let (at, len) = (block.due()?, block.len());
        if self.state.late.is_awaited() {
            return None;
        }
        let fetched = self.fetch(objects, at, len);
        match (fetched, &mut self.state.transfer) {
            (Ok(()), Transfer::BlockUpload(block)) => Some(block.segment(self.window.from(at))),
            (Err(Stop::Abort(code)), _) => Some(self.abort(objects, code)),
            (Err(Stop::Wait), _) if D::STREAMS => {
                self.await_stream(self.state.deadline, None);
                None
            }
            _ => None,
        }
    }

    /// Ends a save: returns the response that waited. `done`: the values are stored; otherwise an
    /// abort. The request that arrived since is [held](Self::held).
    pub(crate) fn finish(&mut self, objects: &mut Objects<'_, D>, done: bool) -> Option<[u8; 8]> {
        match self.state.late.end() {
            Some(_) if !done => Some(self.abort(objects, objects.profile.store.failed)),
            answer => answer,
        }
    }

    /// Aborts a block transfer after a time-out, or asks a stream again.
    pub(crate) fn handle_timeout(&mut self, objects: &mut Objects<'_, D>) -> Option<[u8; 8]> {
        if !self.state.deadline.is_due(objects.now) {
            return None;
        }
        if D::STREAMS && self.state.late.awaits_stream() {
            return self.ask_again(objects);
        }
        Some(self.abort(objects, AbortCode::Timeout))
    }

    /// Refuses a request that begins a transfer.
    pub(crate) fn refuse(
        &mut self,
        objects: &mut Objects<'_, D>,
        address: Address,
        code: AbortCode,
    ) -> [u8; 8] {
        self.replace(objects, address);
        self.abort(objects, code)
    }
}
