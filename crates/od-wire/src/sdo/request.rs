//! Frames of an SDO client.

use od_model::Address;

use super::fields::{self, head, short};
use super::segment::Segment;

/// Frame of an SDO client.
///
/// ```
/// use od_model::Address;
/// use od_wire::sdo::Request;
///
/// let request = Request::InitiateUpload { address: Address::new(0x6004, 0) };
/// assert_eq!(request.emit(), [0x40, 0x04, 0x60, 0, 0, 0, 0, 0]);
/// assert_eq!(Request::parse(&request.emit()), request);
/// ```
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
#[allow(missing_docs)] // the fields are the protocol's own
pub enum Request {
    /// Initiate download: writes to `address`. `size` in bytes, if it is indicated; `expedited`:
    /// up to four bytes, if the value is in the frame.
    InitiateDownload {
        address: Address,
        size: Option<u32>,
        expedited: Option<[u8; 4]>,
    },
    /// Download segment.
    DownloadSegment(Segment),
    /// Initiate upload: reads `address`.
    InitiateUpload { address: Address },
    /// Upload segment: asks for the next one.
    UploadSegment { toggle: bool },
    /// Abort transfer; [`AbortCode`](crate::AbortCode) knows the codes of CiA 301.
    Abort { address: Address, code: u32 },
    /// Initiate block upload: reads `address`. `crc`: the client can check a CRC. `block_size`:
    /// segments in a block, valid from 1 to 127. `threshold`: a value of up to this many bytes may
    /// be sent by another protocol; 0: never.
    InitiateBlockUpload {
        address: Address,
        crc: bool,
        block_size: u8,
        threshold: u8,
    },
    /// Start block upload.
    StartBlockUpload,
    /// Response to a block: `ack` is the last segment in sequence, `block_size` the number of
    /// segments in the next block.
    BlockUploadResponse { ack: u8, block_size: u8 },
    /// End block upload.
    EndBlockUpload,
    /// Initiate block download: writes to `address`. `crc`: the client makes a CRC; `size` in
    /// bytes, if it is indicated.
    InitiateBlockDownload {
        address: Address,
        crc: bool,
        size: Option<u32>,
    },
    /// End block download: `unused` bytes of the last segment are unused, 0 to 7; `crc` is 0 if
    /// none was agreed on.
    EndBlockDownload { unused: u8, crc: u16 },
    /// A command specifier that no request has.
    Unknown,
}

impl Request {
    /// Returns the meaning of eight bytes. Segments of a block have no command specifier: the
    /// state of the server says that they are due.
    #[inline]
    pub const fn parse(data: &[u8; 8]) -> Self {
        let address = fields::address(data);
        let toggle = fields::toggle(data);
        match data[0] >> 5 {
            0 => Self::DownloadSegment(Segment::parse(data)),
            1 => {
                let (size, expedited) = fields::value(data);
                Self::InitiateDownload {
                    address,
                    size,
                    expedited,
                }
            }
            2 => Self::InitiateUpload { address },
            3 => Self::UploadSegment { toggle },
            4 => Self::Abort {
                address,
                code: fields::number(data),
            },
            5 => match data[0] & 3 {
                0 => Self::InitiateBlockUpload {
                    address,
                    crc: fields::wants_crc(data),
                    block_size: data[4],
                    threshold: data[5],
                },
                1 => Self::EndBlockUpload,
                2 => Self::BlockUploadResponse {
                    ack: data[1],
                    block_size: data[2],
                },
                _ => Self::StartBlockUpload,
            },
            6 if data[0] & 1 == 0 => {
                let (crc, size) = fields::block(data);
                Self::InitiateBlockDownload { address, crc, size }
            }
            6 => {
                let (unused, crc) = fields::end(data);
                Self::EndBlockDownload { unused, crc }
            }
            _ => Self::Unknown,
        }
    }

    /// Returns the frame's bytes, as a client sends them.
    pub fn emit(self) -> [u8; 8] {
        match self {
            Self::InitiateDownload {
                address,
                size,
                expedited,
            } => fields::value_frame(0x20, address, size, expedited),
            Self::DownloadSegment(segment) => segment.emit(),
            Self::InitiateUpload { address } => head(0x40, address, 0),
            Self::UploadSegment { toggle } => short(0x60 | fields::toggled(toggle), [0, 0]),
            Self::Abort { address, code } => head(0x80, address, code),
            Self::InitiateBlockUpload {
                address,
                crc,
                block_size,
                threshold,
            } => {
                let rest = u32::from_le_bytes([block_size, threshold, 0, 0]);
                head(0xA0 | u8::from(crc) << 2, address, rest)
            }
            Self::StartBlockUpload => short(0xA3, [0, 0]),
            Self::BlockUploadResponse { ack, block_size } => short(0xA2, [ack, block_size]),
            Self::EndBlockUpload => short(0xA1, [0, 0]),
            Self::InitiateBlockDownload { address, crc, size } => {
                fields::block_frame(address, crc, size)
            }
            Self::EndBlockDownload { unused, crc } => fields::end_frame(unused, crc),
            Self::Unknown => short(0xE0, [0, 0]),
        }
    }
}
