//! The common part of uploads and downloads: the frame to send, the deadline, the result.

use od_model::Address;
use od_wire::sdo::{Request, Response};
use od_wire::{AbortCode, Frame, Instant};

use super::Channel;
use super::buffer::Buffer;
use super::options::Options;
use crate::error::{Error, Expected};

/// First byte of an abort.
const ABORT: u8 = 0x80;

/// The meaning of a response. The command of an abort has no other bits set: a similar
/// byte may be that of the last segment of a block.
pub(super) const fn parse(data: &[u8; 8]) -> Response {
    match data[0] {
        0x81..=0x9F => Response::Unknown,
        _ => Response::parse(data),
    }
}

/// The number of bytes that a response needs for what it says; the missing ones of a shorter frame are not 0.
const fn needed(data: &[u8; 8]) -> u8 {
    match data[0] {
        // A segment.
        command @ 0x00..=0x1F => 8 - (command >> 1 & 7),
        // The value, or its size.
        0x41 | 0x45 | 0x49 | 0x4D => 8,
        // The size of a block upload, or the code of an abort.
        ABORT => 8,
        command if command & 0xE3 == 0xC2 => 8,
        // The number of segments in a block of a download, after the object or the last number.
        command if command & 0xE3 == 0xA0 => 5,
        command if command & 0xE3 == 0xA2 => 3,
        command @ 0x40..=0x5F if command & 3 == 3 => 8 - (command >> 2 & 3),
        // The value without a size has one byte at least.
        command @ 0x40..=0x5F if command & 2 != 0 => 5,
        _ => 1,
    }
}

/// Requests and responses of one transfer on its channel, as the client sees them.
#[derive(Clone, Debug)]
pub(super) struct Exchange {
    channel: Channel,
    pub(super) address: Address,
    pub(super) options: Options,
    /// The waiting frame.
    out: Option<[u8; 8]>,
    deadline: Option<Instant>,
    outcome: Option<Result<(), Error>>,
    /// A request waits to be sent. A frame that comes before is not a response to it.
    is_open: bool,
}

impl Exchange {
    pub(super) const fn new(channel: Channel, address: Address, options: Options) -> Self {
        Self {
            channel,
            address,
            options,
            out: None,
            deadline: None,
            outcome: None,
            is_open: false,
        }
    }

    pub(super) const fn outcome(&self) -> Option<Result<(), Error>> {
        self.outcome
    }

    pub(super) const fn deadline(&self) -> Option<Instant> {
        self.deadline
    }

    pub(super) fn is_due(&self, now: Instant) -> bool {
        self.deadline.is_some_and(|at| at <= now)
    }

    /// Waits for the response from `now` on.
    pub(super) fn wait(&mut self, now: Instant) {
        self.deadline = Some(now + self.options.timeout);
    }

    /// No deadline until the host takes the next frame.
    pub(super) fn stop_waiting(&mut self) {
        self.deadline = None;
    }

    /// Queues a request; the time for its response starts when the host takes it.
    pub(super) fn send(&mut self, request: Request) {
        self.deadline = None;
        self.out = Some(request.emit());
    }

    /// The next queued frame.
    pub(super) fn pull(&mut self, now: Instant) -> Option<Frame> {
        let data = self.out.take()?;
        self.is_open = true;
        if self.outcome.is_none() {
            self.wait(now);
        }
        Some(self.frame(data))
    }

    /// A frame of the client.
    pub(super) const fn frame(&self, data: [u8; 8]) -> Frame {
        Frame::full(self.channel.request, data)
    }

    /// The bytes of a frame of this channel's server, with missing ones as 0, if it can be a response.
    /// While a request waits, only an abort can be one.
    pub(super) fn receive(&self, frame: &Frame) -> Option<[u8; 8]> {
        let data = *frame.bytes();
        let is_ours = frame.id() == self.channel.response && !frame.data().is_empty();
        let is_due = self.out.is_none() || data[0] == ABORT;
        (self.outcome.is_none() && self.is_open && is_ours && is_due).then_some(data)
    }

    /// Fails if a response is too short for what it says.
    pub(super) fn check_length(&mut self, frame: &Frame) -> bool {
        let (needed, received) = (needed(frame.bytes()), frame.dlc());
        let is_whole = received >= needed;
        if !is_whole {
            self.fail(AbortCode::Length, Error::Short { needed, received });
        }
        is_whole
    }

    pub(super) fn finish(&mut self) {
        self.deadline = None;
        self.outcome = Some(Ok(()));
    }

    /// Gives up, and aborts at the server unless no frame was sent yet.
    pub(super) fn fail(&mut self, code: AbortCode, error: Error) {
        if self.outcome.is_some() {
            return;
        }
        self.out = None;
        if self.is_open {
            self.send(Request::Abort {
                address: self.address,
                code: code.code(),
            });
        }
        self.deadline = None;
        self.outcome = Some(Err(error));
    }

    /// Handles an unexpected response, or an abort. An abort for another object belongs to
    /// another transfer; servers send 0000h:00 if they do not know which one they abort.
    pub(super) fn refuse(&mut self, code: AbortCode, expected: Expected, got: Response) {
        match got {
            Response::Abort { address, code } if self.is_about(address) => {
                self.out = None;
                self.deadline = None;
                self.outcome = Some(Err(Error::Abort(code)));
            }
            got => self.fail(code, Error::OutOfTurn { expected, got }),
        }
    }

    fn is_about(&self, address: Address) -> bool {
        address == self.address || address == Address::new(0, 0)
    }

    /// Returns whether the server aborts because it does not know the command.
    pub(super) fn is_unknown_command(&self, response: Response) -> bool {
        matches!(response, Response::Abort { address, code }
            if code == AbortCode::InvalidCommand.code() && self.is_about(address))
    }

    /// Limit of the bytes of an upload into `buffer`.
    fn limit(&self, buffer: &impl Buffer) -> usize {
        self.options.limit.min(buffer.capacity())
    }

    /// Fails if the announced size is above the limit.
    pub(super) fn check_size(&mut self, buffer: &impl Buffer, size: Option<u32>) -> bool {
        let limit = self.limit(buffer) as u64;
        let fits = size.is_none_or(|size| u64::from(size) <= limit);
        if !fits {
            self.fail(AbortCode::OutOfMemory, Error::TooLong);
        }
        fits
    }

    /// Appends bytes to the buffer; fails if they are above the limit or the announced size.
    pub(super) fn keep(
        &mut self,
        buffer: &mut impl Buffer,
        bytes: &[u8],
        size: Option<u32>,
    ) -> bool {
        let received = buffer.bytes().len().saturating_add(bytes.len());
        if let Some(announced) = size.filter(|size| received as u64 > u64::from(*size)) {
            self.fail_length(announced, received);
            return false;
        }
        if received > self.limit(buffer) || !buffer.push(bytes) {
            self.fail(AbortCode::OutOfMemory, Error::TooLong);
            return false;
        }
        true
    }

    /// Fails if fewer bytes came than announced.
    pub(super) fn check_complete(&mut self, buffer: &impl Buffer, size: Option<u32>) -> bool {
        let received = buffer.bytes().len();
        match size {
            Some(announced) if received as u64 != u64::from(announced) => {
                self.fail_length(announced, received);
                false
            }
            _ => true,
        }
    }

    fn fail_length(&mut self, announced: u32, received: usize) {
        let error = Error::Length {
            announced,
            received,
        };
        self.fail(AbortCode::Length, error);
    }
}
