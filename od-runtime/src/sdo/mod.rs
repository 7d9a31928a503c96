//! SDO server (CiA 301, chapter 7.2.4): expedited, segmented and block transfers, both ways.
//!
//! The server buffers a download and writes it when it is complete, so one that breaks off
//! leaves the object as it was. Of a value that the application streams it has one part at a time.

mod block_download;
mod block_upload;
mod expedited;
mod further;
mod late;
mod request;
mod segmented;
mod stop;
mod streamed;
mod under_way;
mod window;

use core::marker::PhantomData;

use od_model::Address;

use crate::application::StreamEnd;
use crate::deadline::Deadline;
use crate::device::Device;
use crate::number::number_in;
use crate::objects::{Objects, Unread};
use crate::rooms::{Blank, FullRooms, Room, Rooms};
use od_wire::sdo::{Response, address, expedited_upload};
use od_wire::{AbortCode, Frame, Instant};

use block_download::BlockDownload;
use block_upload::BlockUpload;
use late::Late;
use segmented::{Download, Upload};
use stop::Stop;
use window::Window;

pub use further::SdoServer;
pub(crate) use late::Held;

/// Longest time that a block transfer waits for the client, in microseconds: its segments look
/// like requests, so a client that died would block the next one.
const BLOCK_TIMEOUT_US: u64 = 5_000_000;

/// First byte of an abort, as clients send it.
const ABORT: u8 = 0x80;

/// Transfer under way. Without one it is all zeros, which a niche would not give.
#[derive(Clone, Copy, Debug, Default)]
#[repr(u8)]
enum Transfer {
    #[default]
    None,
    /// An expedited download of these many bytes; the stream did not take them yet.
    Expedited(u8),
    Upload(Upload),
    Download(Download),
    BlockUpload(BlockUpload),
    BlockDownload(BlockDownload),
}

impl Blank for Transfer {
    const BLANK: Self = Self::None;
}

/// The server: one transfer at a time, `N` bytes of it.
#[derive(Clone, Debug)]
pub(crate) struct Server<D, const N: usize, R: Rooms = FullRooms> {
    device: PhantomData<D>,
    transfers: R::Transfers<Transfer>,
    address: Address,
    window: Window<N>,
    /// The application streams the value of the transfer.
    is_streaming: bool,
    deadline: Deadline,
    /// A frame needs a closer look: a block transfer is under way, whose segments may look like requests,
    /// the frame has to wait, or it ends a stream.
    is_busy: bool,
    late: R::Late<Late>,
}

/// Response of the server, if there is one, or the reason why it does not come.
type Answer = Result<Option<[u8; 8]>, Stop>;

impl<D, const N: usize, R: Rooms> Server<D, N, R> {
    pub(crate) const fn idle() -> Self {
        Self {
            device: PhantomData,
            transfers: Room::BLANK,
            address: Address::new(0, 0),
            window: Window::new(),
            is_streaming: false,
            deadline: Deadline::NEVER,
            is_busy: false,
            late: Room::BLANK,
        }
    }
}

impl<D: Device, const N: usize, R: Rooms> Server<D, N, R> {
    /// Forgets everything without a word, as the end of power does.
    pub(crate) fn forget(&mut self) {
        self.reset();
        self.is_streaming = false;
        self.set_late(Late::BLANK);
        self.is_busy = false;
    }

    /// Forgets everything without a word to the client, as a change of the NMT state does.
    pub(crate) fn cut(&mut self, objects: &mut Objects<'_, D>) {
        self.close(objects, StreamEnd::Cut);
        self.forget();
    }

    /// The transfer is over.
    #[inline]
    pub(crate) fn reset(&mut self) {
        self.set_transfer(Transfer::None);
        if D::BLOCK || D::STREAMS {
            self.deadline = Deadline::NEVER;
        }
    }

    /// A client's frame; `data` beyond `dlc` is 0. The response to a [command](Objects::carry_out) waits.
    pub(crate) fn handle(
        &mut self,
        objects: &mut Objects<'_, D>,
        data: &[u8; 8],
        dlc: u8,
    ) -> Option<[u8; 8]> {
        match self.is_quick(data) {
            true => self.handle_upload(objects, data, dlc),
            false => self.handle_other(objects, data, dlc),
        }
    }

    /// Whether this is a request for an upload that can be answered at once.
    #[inline(always)]
    pub(crate) fn is_quick(&self, data: &[u8; 8]) -> bool {
        data[0] >> 5 == 2 && !self.is_busy
    }

    /// The first four bytes of such a request that is a whole frame, as a number.
    #[inline(always)]
    pub(crate) fn quick(&self, frame: &Frame) -> Option<u32> {
        let head = u64::from_le_bytes(*frame.bytes()) as u32;
        let is_whole = u16::from_le_bytes([frame.dlc(), frame.is_remote().into()]) == 8;
        (is_whole && head & 0xE0 == 0x40 && !self.is_busy).then_some(head)
    }

    /// A request for an upload.
    #[inline(never)]
    pub(crate) fn handle_upload(
        &mut self,
        objects: &mut Objects<'_, D>,
        data: &[u8; 8],
        dlc: u8,
    ) -> Option<[u8; 8]> {
        if dlc < objects.profile().sdo.min_dlc {
            return None;
        }
        let address = address(data);
        self.begin(address);
        match self.upload(objects, address) {
            Ok(answer) => Some(answer),
            Err(Unread::Abort(code)) => Some(self.abort(objects, code)),
            Err(Unread::Streamed) => self.handle_streamed(objects, data, dlc),
        }
    }

    /// Any other request.
    #[inline(never)]
    pub(crate) fn handle_other(
        &mut self,
        objects: &mut Objects<'_, D>,
        data: &[u8; 8],
        dlc: u8,
    ) -> Option<[u8; 8]> {
        if dlc < objects.profile().sdo.min_dlc {
            return None;
        }
        if (D::STORAGE || D::STREAMS) && self.late().is_awaited() {
            for late in self.late.all_mut() {
                late.hold(data, dlc, D::STREAMS);
            }
            if D::STREAMS && data[0] == ABORT && self.late().awaits_stream() {
                let answer = self.request(objects, data, dlc);
                self.set_late(Late::BLANK);
                self.settle(objects, answer, data, dlc);
            }
            return None;
        }
        let answer = match self.transfer() {
            Transfer::BlockDownload(block)
                if D::BLOCK && block.wants_segments() && data[0] != ABORT =>
            {
                self.block_segment(objects, data)
            }
            _ if (D::STREAMS || D::BLOCK) && data[0] >> 5 == 2 => {
                self.close(objects, StreamEnd::Replaced);
                self.is_busy = false;
                return self.handle(objects, data, dlc);
            }
            _ => self.request(objects, data, dlc),
        };
        self.settle(objects, answer, data, dlc)
    }

    /// The end of a request: what goes out, and when the next thing is due.
    fn settle(
        &mut self,
        objects: &mut Objects<'_, D>,
        answer: Answer,
        data: &[u8; 8],
        dlc: u8,
    ) -> Option<[u8; 8]> {
        let until = self.deadline;
        self.await_client(objects.now);
        let is_late = objects.is_commanded();
        let answer = match answer {
            Ok(Some(response)) if is_late => {
                self.set_late(Late::new(response));
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
        };
        self.look();
        answer
    }

    /// From now on a block transfer waits for its client.
    fn await_client(&mut self, now: Instant) {
        let is_block = matches!(
            self.transfer(),
            Transfer::BlockDownload(_) | Transfer::BlockUpload(_)
        );
        self.deadline = match is_block {
            true => Deadline::at(now.plus_micros(BLOCK_TIMEOUT_US)),
            false => Deadline::NEVER,
        };
    }

    /// Finds out whether the next frame needs a closer look.
    #[cfg_attr(target_os = "none", inline(never))]
    fn look(&mut self) {
        self.is_busy = self.takes_anything()
            || self.streams()
            || D::BLOCK
                && matches!(
                    self.transfer(),
                    Transfer::BlockDownload(_) | Transfer::BlockUpload(_)
                );
    }

    /// A new transfer takes the place of one that was not finished.
    #[inline]
    fn begin(&mut self, address: Address) {
        self.reset();
        self.address = address;
    }

    /// As [`begin`](Self::begin), where the one that was not finished may be a stream.
    fn replace(&mut self, objects: &mut Objects<'_, D>, address: Address) {
        self.close(objects, StreamEnd::Replaced);
        self.address = address;
    }

    fn upload(
        &mut self,
        objects: &mut Objects<'_, D>,
        address: Address,
    ) -> Result<[u8; 8], Unread> {
        let segmented = D::SEGMENTED && objects.profile().sdo.segmented_upload;
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

    /// A value of more than four bytes (or none) goes in segments.
    #[inline(never)]
    fn begin_upload(&mut self, address: Address, bytes: &[u8]) -> Result<[u8; 8], Unread> {
        let len = self.window.load(bytes)?;
        self.set_transfer(Transfer::Upload(Upload::new(len)));
        Ok(Response::InitiateUpload {
            address,
            size: Some(len as u32),
            expedited: None,
        }
        .emit())
    }

    /// An upload of a value that the application streams.
    #[cold]
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
        self.settle(objects, answer, data, dlc)
    }

    #[inline(never)]
    fn abort(&mut self, objects: &mut Objects<'_, D>, code: AbortCode) -> [u8; 8] {
        self.close(objects, StreamEnd::Aborted(code));
        Response::Abort {
            address: self.address,
            code: code.code(),
        }
        .emit()
    }

    /// Whether [`poll`](Self::poll) may have a segment.
    #[inline]
    pub(crate) fn is_sending(&self) -> bool {
        matches!(self.transfer(), Transfer::BlockUpload(_))
    }

    /// The next segment of a block upload, if one is due, or an abort.
    pub(crate) fn poll(&mut self, objects: &mut Objects<'_, D>) -> Option<[u8; 8]> {
        let Transfer::BlockUpload(block) = self.transfer() else {
            return None;
        };
        let (at, len) = (block.due()?, block.len());
        if self.late().is_awaited() {
            return None;
        }
        let fetched = self.fetch(objects, at, len);
        let answer = match (fetched, self.transfers.all_mut()) {
            (Ok(()), [Transfer::BlockUpload(block)]) => Some(block.segment(self.window.from(at))),
            (Err(Stop::Abort(code)), _) => Some(self.abort(objects, code)),
            (Err(Stop::Wait), _) if D::STREAMS => {
                self.await_stream(self.deadline, None);
                None
            }
            _ => None,
        };
        self.look();
        answer
    }

    /// Everything is stored (`done`), or could not be: the answer that waited. The request behind it is
    /// [held](Self::held).
    pub(crate) fn finish(&mut self, objects: &mut Objects<'_, D>, done: bool) -> Option<[u8; 8]> {
        let late = self.late.all_mut().first_mut();
        let answer = late.and_then(Late::end);
        self.look();
        match answer {
            Some(_) if !done => Some(self.abort(objects, objects.profile().store.failed)),
            answer => answer,
        }
    }

    /// Takes the request that waited for the answer.
    pub(crate) fn held(&mut self) -> Option<Held> {
        self.late.all_mut().first_mut()?.held.take()
    }

    /// Time when a block transfer gives up, or a stream is asked again.
    #[inline]
    pub(crate) fn deadline(&self) -> Deadline {
        self.deadline
    }

    /// Gives up a block transfer whose client is gone; asks a stream again.
    pub(crate) fn handle_timeout(&mut self, objects: &mut Objects<'_, D>) -> Option<[u8; 8]> {
        if !self.deadline.is_due(objects.now) {
            return None;
        }
        if D::STREAMS && self.late().awaits_stream() {
            return self.ask_again(objects);
        }
        let abort = self.abort(objects, AbortCode::Timeout);
        self.look();
        Some(abort)
    }
}
