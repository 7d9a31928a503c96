//! Follows the SDO transfers of a server without taking part (CiA 301, chapter 7.2.4).

use od_model::Address;
use od_runtime::Frame;
use od_wire::AbortCode;
use od_wire::sdo::{Request, Response};

/// The node ID of a frame of a default SDO, and whether the server sends it. `None`: another frame.
pub(crate) fn default_sdo(frame: &Frame) -> Option<(u8, bool)> {
    let id = frame.id().as_standard()?;
    let is_response = match id {
        0x581..=0x5FF => true,
        0x601..=0x67F => false,
        _ => return None,
    };
    Some(((id & 0x7F) as u8, is_response))
}

/// Returns whether a client sends this frame only to abort a transfer to a node that did not respond. No node would
/// acknowledge it.
pub(crate) fn is_timeout(frame: &Frame) -> bool {
    let request = frame.data().try_into().map(Request::parse);
    matches!(request, Ok(Request::Abort { code, .. }) if code == AbortCode::Timeout.code())
}

/// A frame of an SDO.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(crate) enum Message<'f> {
    Request(Request),
    Response(Response),
    /// A segment of a block has no command.
    Segment {
        /// Counted from 1 in its block.
        number: u8,
        /// The last one of the transfer.
        is_last: bool,
        data: &'f [u8],
    },
}

#[derive(Clone, Copy, PartialEq, Eq, Debug)]
enum Block {
    Upload,
    Download,
}

/// The transfer of one server, from the frames so far.
#[derive(Clone, Debug, Default)]
pub(crate) struct Observer {
    /// The object of the transfer; `None`: no frame named it.
    pub(crate) object: Option<Address>,
    /// The segments of a block follow.
    block: Option<Block>,
    block_size: u8,
    /// The number of the last segment of the transfer, once it was seen.
    last: Option<u8>,
}

impl Observer {
    /// Reads the next frame; `None`: it is not an SDO message, and changes nothing.
    pub(crate) fn read<'f>(&mut self, is_response: bool, frame: &'f Frame) -> Option<Message<'f>> {
        if frame.is_remote() || frame.dlc() == 0 {
            return None;
        }
        let [command, data @ ..] = frame.bytes();
        let number = command & 0x7F;
        let is_block = self
            .block
            .is_some_and(|block| (block == Block::Upload) == is_response);
        // No segment has number 0, so such a frame is a command; 80h is an abort.
        if is_block && number != 0 {
            let is_last = command & 0x80 != 0;
            if is_last || number == self.block_size {
                self.block = None;
            }
            self.last = is_last.then_some(number);
            return Some(Message::Segment {
                number,
                is_last,
                data,
            });
        }
        // A frame without index and sub-index names no object.
        if frame.dlc() < 4 {
            return None;
        }
        Some(if is_response {
            let response = Response::parse(frame.bytes());
            self.response(response);
            Message::Response(response)
        } else {
            let request = Request::parse(frame.bytes());
            self.request(request);
            Message::Request(request)
        })
    }

    fn request(&mut self, request: Request) {
        match request {
            Request::InitiateUpload { address }
            | Request::InitiateDownload { address, .. }
            | Request::InitiateBlockDownload { address, .. } => self.begin(address, 0),
            Request::InitiateBlockUpload {
                address,
                block_size,
                ..
            } => self.begin(address, block_size),
            Request::StartBlockUpload => self.block = Some(Block::Upload),
            Request::BlockUploadResponse { ack, block_size } => {
                self.taken(Block::Upload, ack, block_size);
            }
            Request::EndBlockDownload { .. } => self.block = None,
            Request::Abort { .. } => *self = Self::default(),
            Request::DownloadSegment(_)
            | Request::UploadSegment { .. }
            | Request::EndBlockUpload
            | Request::Unknown => {}
        }
    }

    fn response(&mut self, response: Response) {
        match response {
            Response::InitiateUpload { address, .. } | Response::InitiateDownload { address } => {
                self.begin(address, 0);
            }
            Response::InitiateBlockUpload { address, .. } => self.begin(address, self.block_size),
            Response::InitiateBlockDownload {
                address,
                block_size,
                ..
            } => {
                self.begin(address, block_size);
                self.block = Some(Block::Download);
            }
            Response::BlockDownloadResponse { ack, block_size } => {
                self.taken(Block::Download, ack, block_size);
            }
            Response::EndBlockUpload { .. } | Response::EndBlockDownload => self.block = None,
            Response::Abort { .. } => *self = Self::default(),
            Response::UploadSegment(_) | Response::DownloadSegment { .. } | Response::Unknown => {}
        }
    }

    fn begin(&mut self, object: Address, block_size: u8) {
        *self = Self {
            object: Some(object),
            block_size,
            ..Self::default()
        };
    }

    /// Ends a confirmed block. More segments follow, unless the last one of the transfer was
    /// accepted.
    fn taken(&mut self, block: Block, ack: u8, block_size: u8) {
        self.block = (self.last != Some(ack)).then_some(block);
        self.block_size = block_size;
    }
}
