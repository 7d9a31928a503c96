//! Download: writes an object, expedited or in segments (CiA 301, chapters 7.2.4.3.3 and 7.2.4.3.4).

use od_model::Address;
use od_wire::sdo::{Request, Response, Segment};
use od_wire::{AbortCode, Frame, Instant};

use super::Channel;
use super::block_download::BlockDownload;
use super::exchange::{Exchange, parse};
use super::options::Options;
use crate::error::{Error, Expected};

#[derive(Clone, Debug)]
enum State {
    /// The initiate request was sent, with or without data.
    Initiate { expedited: bool },
    /// A segment was sent; all data before `end` was sent.
    Segment { toggle: bool, end: usize },
    /// The initiate request of a block download was sent.
    InitiateBlock,
    /// Blocks are being sent.
    Blocks(BlockDownload),
}

/// The download of one object: the client writes, the server receives.
///
/// The data must stay available until the transfer is over, because a block may have to be repeated.
///
/// ```
/// use od_client::sdo::{Channel, Download, Options};
/// use od_client::{Frame, Instant, NodeId};
/// use od_model::Address;
///
/// let (channel, address) = (Channel::of(NodeId::ONE), Address::new(0x1017, 0));
/// let mut download = Download::new(channel, address, [0xE8, 0x03], Options::DEFAULT);
/// let request = download.poll_transmit(Instant::ZERO).expect("the request");
/// assert_eq!(request.to_string(), "601#2B171000E8030000");
/// download.handle_frame(Instant::ZERO, &Frame::standard(0x581, &[0x60, 0x17, 0x10, 0, 0, 0, 0, 0]));
/// assert_eq!(download.outcome(), Some(Ok(())));
/// ```
#[derive(Clone, Debug)]
pub struct Download<D> {
    exchange: Exchange,
    data: D,
    state: State,
    refused_block: bool,
}

impl<D: AsRef<[u8]>> Download<D> {
    /// A download of `data` into `object`. Its first frame waits in
    /// [`poll_transmit`](Self::poll_transmit).
    pub fn new(channel: Channel, object: Address, data: D, options: Options) -> Self {
        let mut download = Self {
            exchange: Exchange::new(channel, object, options),
            data,
            state: State::InitiateBlock,
            refused_block: false,
        };
        if options.blocks(download.size()) {
            download.exchange.send(Request::InitiateBlockDownload {
                address: object,
                crc: true,
                size: download.size(),
            });
        } else {
            download.initiate();
        }
        download
    }

    /// Handles a frame from the bus; frames of other channels are ignored.
    pub fn handle_frame(&mut self, _now: Instant, frame: &Frame) {
        let Some(data) = self.exchange.receive(frame) else {
            return;
        };
        if !self.exchange.check_length(frame) {
            return;
        }
        let response = parse(&data);
        match &mut self.state {
            State::Initiate { expedited } => {
                let expedited = *expedited;
                self.initiated(response, expedited);
            }
            State::Segment { toggle, end } => {
                let (toggle, end) = (*toggle, *end);
                self.segment_taken(response, toggle, end);
            }
            State::InitiateBlock => self.block_initiated(response),
            State::Blocks(blocks) => {
                blocks.handle(&mut self.exchange, self.data.as_ref(), response)
            }
        }
    }

    /// Gives up if the response is overdue; does nothing before [`poll_timeout`](Self::poll_timeout).
    pub fn handle_timeout(&mut self, now: Instant) {
        if self.exchange.is_due(now) {
            self.exchange.fail(AbortCode::Timeout, Error::Silent);
        }
    }

    /// Returns the next frame to send; the time for its response starts at `now`. In a block
    /// download there are up to 127 frames at once.
    pub fn poll_transmit(&mut self, now: Instant) -> Option<Frame> {
        if let Some(frame) = self.exchange.pull(now) {
            return Some(frame);
        }
        match &mut self.state {
            State::Blocks(blocks) if self.exchange.outcome().is_none() => {
                let data = blocks.next_segment(self.data.as_ref())?;
                self.exchange.wait(now);
                Some(self.exchange.frame(data))
            }
            _ => None,
        }
    }

    /// Returns when to call [`handle_timeout`](Self::handle_timeout), if at all.
    pub fn poll_timeout(&self) -> Option<Instant> {
        self.exchange.deadline()
    }

    /// Returns the result of the download; `None` while it is in progress.
    pub const fn outcome(&self) -> Option<Result<(), Error>> {
        self.exchange.outcome()
    }

    /// Ends the download as [`Error::Cancelled`], with an abort to the server.
    pub fn cancel(&mut self) {
        self.exchange.fail(AbortCode::General, Error::Cancelled);
    }

    /// Returns whether the server aborted the block download because it does not know the command.
    pub const fn refused_block(&self) -> bool {
        self.refused_block
    }

    /// Returns the data.
    pub fn into_data(self) -> D {
        self.data
    }

    /// Length of the data; not indicated if it does not fit into 32 bits.
    fn size(&self) -> Option<u32> {
        u32::try_from(self.data.as_ref().len()).ok()
    }

    fn initiate(&mut self) {
        let bytes = self.data.as_ref();
        let mut data = [0; 4];
        // An empty value cannot be sent expedited: the protocol cannot express it.
        let expedited = match data.get_mut(..bytes.len()) {
            Some(room) if !bytes.is_empty() => {
                room.copy_from_slice(bytes);
                Some(data)
            }
            _ => None,
        };
        self.exchange.send(Request::InitiateDownload {
            address: self.exchange.address,
            size: self.size(),
            expedited,
        });
        self.state = State::Initiate {
            expedited: expedited.is_some(),
        };
    }

    fn initiated(&mut self, response: Response, expedited: bool) {
        match response {
            Response::InitiateDownload { address } if address == self.exchange.address => {
                if expedited {
                    self.exchange.finish();
                } else {
                    self.segment(false, 0);
                }
            }
            other => {
                let code = AbortCode::InvalidCommand;
                self.exchange.refuse(code, Expected::Download, other);
            }
        }
    }

    /// Sends the segment that begins at `start`.
    fn segment(&mut self, toggle: bool, start: usize) {
        let bytes = self.data.as_ref();
        let segment = Segment::first_of(bytes.get(start..).unwrap_or_default(), toggle);
        let end = start + usize::from(segment.len);
        self.exchange.send(Request::DownloadSegment(segment));
        self.state = State::Segment { toggle, end };
    }

    fn segment_taken(&mut self, response: Response, toggle: bool, end: usize) {
        let expected = Expected::DownloadSegment;
        match response {
            Response::DownloadSegment { toggle: answered } if answered != toggle => {
                self.exchange
                    .refuse(AbortCode::ToggleBit, expected, response);
            }
            Response::DownloadSegment { .. } if end == self.data.as_ref().len() => {
                self.exchange.finish();
            }
            Response::DownloadSegment { .. } => self.segment(!toggle, end),
            other => {
                let code = AbortCode::InvalidCommand;
                self.exchange.refuse(code, expected, other);
            }
        }
    }

    fn block_initiated(&mut self, response: Response) {
        match response {
            Response::InitiateBlockDownload {
                address,
                crc,
                block_size,
            } if address == self.exchange.address => {
                if let Some(blocks) = BlockDownload::new(&mut self.exchange, crc, block_size) {
                    self.state = State::Blocks(blocks);
                }
            }
            other if self.exchange.is_unknown_command(other) => {
                self.refused_block = true;
                self.initiate();
            }
            other => {
                let code = AbortCode::InvalidCommand;
                self.exchange.refuse(code, Expected::BlockDownload, other);
            }
        }
    }
}
