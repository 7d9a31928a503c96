//! Upload: reads an object, expedited or in segments (CiA 301, chapters 7.2.4.3.6 and 7.2.4.3.7).

use od_model::Address;
use od_wire::sdo::{self, Request, Response};
use od_wire::{AbortCode, Frame, Instant};

use super::Channel;
use super::block_upload::BlockUpload;
use super::buffer::Buffer;
use super::exchange::{Exchange, parse};
use super::options::Options;
use crate::error::{Error, Expected};

#[derive(Clone, Debug)]
enum State {
    /// The initiate request was sent.
    Initiate,
    /// The segment with this toggle bit is due.
    Segment { toggle: bool, size: Option<u32> },
    /// The initiate request of a block upload was sent.
    InitiateBlock,
    /// Segments of a block are due, or the end response.
    Blocks(BlockUpload),
}

/// The upload of one object: the client reads, the server sends.
///
/// ```
/// use od_client::sdo::{Channel, Options, Slice, Upload};
/// use od_client::{Frame, Instant, NodeId};
/// use od_model::Address;
///
/// let mut room = [0; 4];
/// let (channel, address) = (Channel::of(NodeId::ONE), Address::new(0x1000, 0));
/// let mut upload = Upload::new(channel, address, Slice::new(&mut room), Options::SEGMENTED);
/// upload.poll_transmit(Instant::ZERO).expect("the request");
/// upload.handle_frame(Instant::ZERO, &Frame::standard(0x581, &[0x43, 0, 0x10, 0, 0x96, 1, 2, 0]));
/// assert_eq!((upload.outcome(), upload.bytes()), (Some(Ok(())), &[0x96, 1, 2, 0][..]));
/// ```
#[derive(Clone, Debug)]
pub struct Upload<B> {
    exchange: Exchange,
    buffer: B,
    state: State,
    refused_block: bool,
}

impl<B: Buffer> Upload<B> {
    /// An upload of `object` into `buffer`, which is emptied first. Its first frame waits in
    /// [`poll_transmit`](Self::poll_transmit).
    pub fn new(channel: Channel, object: Address, mut buffer: B, options: Options) -> Self {
        buffer.clear();
        let mut exchange = Exchange::new(channel, object, options);
        let state = if options.block_upload {
            exchange.send(Request::InitiateBlockUpload {
                address: object,
                crc: true,
                block_size: options.segments(),
                threshold: 0,
            });
            State::InitiateBlock
        } else {
            exchange.send(Request::InitiateUpload { address: object });
            State::Initiate
        };
        Self {
            exchange,
            buffer,
            state,
            refused_block: false,
        }
    }

    /// Handles a frame from the bus; frames of other channels are ignored.
    pub fn handle_frame(&mut self, now: Instant, frame: &Frame) {
        let Some(data) = self.exchange.receive(frame) else {
            return;
        };
        if !matches!(self.state, State::Blocks(_)) && !self.exchange.check_length(frame) {
            return;
        }
        match &mut self.state {
            State::Blocks(blocks) if blocks.wants_segments() => {
                blocks.segment(&mut self.exchange, &mut self.buffer, now, frame);
            }
            State::Blocks(blocks) => {
                blocks.end(&mut self.exchange, &mut self.buffer, parse(&data));
            }
            State::Initiate => self.initiated(parse(&data), Expected::Upload),
            State::InitiateBlock => self.block_initiated(parse(&data)),
            State::Segment { toggle, size } => {
                let (toggle, size) = (*toggle, *size);
                self.segment(parse(&data), toggle, size);
            }
        }
    }

    /// Gives up if the response is overdue; does nothing before [`poll_timeout`](Self::poll_timeout).
    pub fn handle_timeout(&mut self, now: Instant) {
        if !self.exchange.is_due(now) {
            return;
        }
        match &mut self.state {
            State::Blocks(blocks) if blocks.heard() => blocks.confirm(&mut self.exchange),
            _ => self.exchange.fail(AbortCode::Timeout, Error::Silent),
        }
    }

    /// Returns the next frame to send; the time for its response starts at `now`.
    pub fn poll_transmit(&mut self, now: Instant) -> Option<Frame> {
        self.exchange.pull(now)
    }

    /// Returns when to call [`handle_timeout`](Self::handle_timeout), if at all.
    pub fn poll_timeout(&self) -> Option<Instant> {
        self.exchange.deadline()
    }

    /// Returns the result of the upload; `None` while it is in progress.
    pub const fn outcome(&self) -> Option<Result<(), Error>> {
        self.exchange.outcome()
    }

    /// Ends the upload as [`Error::Cancelled`], with an abort to the server.
    pub fn cancel(&mut self) {
        self.exchange.fail(AbortCode::General, Error::Cancelled);
    }

    /// Returns whether the server aborted the block upload because it does not know the command.
    pub const fn refused_block(&self) -> bool {
        self.refused_block
    }

    /// Returns the bytes so far: the whole value after the outcome `Ok`.
    pub fn bytes(&self) -> &[u8] {
        self.buffer.bytes()
    }

    /// Returns the buffer, with the bytes so far.
    pub fn into_buffer(self) -> B {
        self.buffer
    }

    fn initiated(&mut self, response: Response, expected: Expected) {
        let (size, expedited) = match response {
            Response::InitiateUpload {
                address,
                size,
                expedited,
            } if address == self.exchange.address => (size, expedited),
            other => {
                let code = AbortCode::InvalidCommand;
                return self.exchange.refuse(code, expected, other);
            }
        };
        if let Some(data) = expedited {
            let len = sdo::expedited_len(size, self.exchange.options.type_size);
            if self.exchange.keep(&mut self.buffer, &data[..len], None) {
                self.exchange.finish();
            }
            return;
        }
        if !self.exchange.check_size(&self.buffer, size) {
            return;
        }
        self.ask(false, size);
    }

    /// Requests the segment with this toggle bit.
    fn ask(&mut self, toggle: bool, size: Option<u32>) {
        self.exchange.send(Request::UploadSegment { toggle });
        self.state = State::Segment { toggle, size };
    }

    fn segment(&mut self, response: Response, toggle: bool, size: Option<u32>) {
        let expected = Expected::UploadSegment;
        match response {
            Response::UploadSegment(segment) if segment.toggle != toggle => {
                self.exchange
                    .refuse(AbortCode::ToggleBit, expected, response);
            }
            Response::UploadSegment(segment) if segment.len == 0 && !segment.last => {
                self.exchange.fail(AbortCode::General, Error::NoProgress);
            }
            Response::UploadSegment(segment) => {
                let (bytes, last) = (segment.bytes(), segment.last);
                if !self.exchange.keep(&mut self.buffer, bytes, size) {
                    return;
                }
                if !last {
                    self.ask(!toggle, size);
                } else if self.exchange.check_complete(&self.buffer, size) {
                    self.exchange.finish();
                }
            }
            other => {
                let code = AbortCode::InvalidCommand;
                self.exchange.refuse(code, expected, other);
            }
        }
    }

    fn block_initiated(&mut self, response: Response) {
        match response {
            Response::InitiateBlockUpload { address, crc, size }
                if address == self.exchange.address =>
            {
                if self.exchange.check_size(&self.buffer, size) {
                    let block_size = self.exchange.options.segments();
                    self.state = State::Blocks(BlockUpload::new(crc, size, block_size));
                    self.exchange.send(Request::StartBlockUpload);
                }
            }
            other if self.exchange.is_unknown_command(other) => {
                self.refused_block = true;
                let address = self.exchange.address;
                self.exchange.send(Request::InitiateUpload { address });
                self.state = State::Initiate;
            }
            // A server may change to the other protocol.
            other => self.initiated(other, Expected::BlockUpload),
        }
    }
}
