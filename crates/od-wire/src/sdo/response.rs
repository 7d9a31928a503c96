//! Frames of an SDO server.

use od_model::Address;

use super::fields::{self, head, short};
use super::segment::Segment;

/// Frame of an SDO server.
///
/// ```
/// use od_model::Address;
/// use od_wire::AbortCode;
/// use od_wire::sdo::Response;
///
/// let response = Response::parse(&[0x80, 0x00, 0x20, 0, 0, 0, 0x02, 0x06]);
/// let (address, code) = (Address::new(0x2000, 0), AbortCode::NoObject.code());
/// assert_eq!(response, Response::Abort { address, code });
/// ```
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
#[allow(missing_docs)] // the fields are the protocol's own
pub enum Response {
    /// Upload segment.
    UploadSegment(Segment),
    /// Download segment: the segment was accepted.
    DownloadSegment { toggle: bool },
    /// Initiate upload: `size` in bytes, if it is indicated; `expedited`: up to four bytes, if the
    /// value is in the frame.
    InitiateUpload {
        address: Address,
        size: Option<u32>,
        expedited: Option<[u8; 4]>,
    },
    /// Initiate download: the value was written, or the client may send its segments.
    InitiateDownload { address: Address },
    /// Abort transfer; [`AbortCode`](crate::AbortCode) knows the codes of CiA 301.
    Abort { address: Address, code: u32 },
    /// Initiate block download: `crc`: the server checks a CRC; `block_size`: segments in a block.
    InitiateBlockDownload {
        address: Address,
        crc: bool,
        block_size: u8,
    },
    /// Response to a block: `ack` is the last segment in sequence, `block_size` the number of
    /// segments in the next block.
    BlockDownloadResponse { ack: u8, block_size: u8 },
    /// End block download: the value was written.
    EndBlockDownload,
    /// Initiate block upload: `crc`: the server makes a CRC; `size` in bytes, if it is indicated.
    InitiateBlockUpload {
        address: Address,
        crc: bool,
        size: Option<u32>,
    },
    /// End block upload: `unused` bytes of the last segment are unused, 0 to 7; `crc` is 0 if
    /// none was agreed on.
    EndBlockUpload { unused: u8, crc: u16 },
    /// A command specifier that no response has.
    Unknown,
}

impl Response {
    /// Returns the meaning of eight bytes that are not a segment of a block.
    pub const fn parse(data: &[u8; 8]) -> Self {
        let address = fields::address(data);
        let toggle = fields::toggle(data);
        match data[0] >> 5 {
            0 => Self::UploadSegment(Segment::parse(data)),
            1 => Self::DownloadSegment { toggle },
            2 => {
                let (size, expedited) = fields::value(data);
                Self::InitiateUpload {
                    address,
                    size,
                    expedited,
                }
            }
            3 => Self::InitiateDownload { address },
            4 => Self::Abort {
                address,
                code: fields::number(data),
            },
            5 => match data[0] & 3 {
                0 => Self::InitiateBlockDownload {
                    address,
                    crc: data[0] & 4 != 0,
                    block_size: data[4],
                },
                1 => Self::EndBlockDownload,
                2 => Self::BlockDownloadResponse {
                    ack: data[1],
                    block_size: data[2],
                },
                _ => Self::Unknown,
            },
            6 if data[0] & 1 == 0 => {
                let (crc, size) = fields::block(data);
                Self::InitiateBlockUpload { address, crc, size }
            }
            6 => {
                let (unused, crc) = fields::end(data);
                Self::EndBlockUpload { unused, crc }
            }
            _ => Self::Unknown,
        }
    }

    /// Returns the frame's bytes, as a server sends them.
    pub fn emit(self) -> [u8; 8] {
        match self {
            Self::UploadSegment(segment) => segment.emit(),
            Self::DownloadSegment { toggle } => short(0x20 | fields::toggled(toggle), [0, 0]),
            Self::InitiateUpload {
                address,
                size,
                expedited,
            } => fields::value_frame(0x40, address, size, expedited),
            Self::InitiateDownload { address } => head(0x60, address, 0),
            Self::Abort { address, code } => head(0x80, address, code),
            Self::InitiateBlockDownload {
                address,
                crc,
                block_size,
            } => head(0xA0 | u8::from(crc) << 2, address, block_size.into()),
            Self::BlockDownloadResponse { ack, block_size } => short(0xA2, [ack, block_size]),
            Self::EndBlockDownload => short(0xA1, [0, 0]),
            Self::InitiateBlockUpload { address, crc, size } => {
                fields::block_frame(address, crc, size)
            }
            Self::EndBlockUpload { unused, crc } => fields::end_frame(unused, crc),
            Self::Unknown => short(0xE0, [0, 0]),
        }
    }
}

impl Response {
    /// As [`emit`](Self::emit), with the address as it is in the request, which is less work.
    pub fn emit_to(self, request: &[u8; 8]) -> [u8; 8] {
        const ADDRESS: u64 = 0xFFFF_FF00;
        let [request, own] = [*request, self.emit()].map(u64::from_le_bytes);
        (request & ADDRESS | own & !ADDRESS).to_le_bytes()
    }
}

/// Returns the number of bytes of an expedited value: `size`, if the frame indicates it; otherwise
/// the length of the object's data type, at most 4; otherwise 4 (CiA 301, 7.2.4.3.6: e = 1, s = 0).
pub fn expedited_len(size: Option<u32>, type_size: Option<usize>) -> usize {
    let size = size.and_then(|size| usize::try_from(size).ok());
    size.or(type_size).unwrap_or(4).min(4)
}

/// The frame of an expedited upload with `len` bytes (1 to 4) of `value`. It equals the frame of
/// [`Response::InitiateUpload`]; this function exists because it is the most frequent response.
#[inline]
pub const fn expedited_upload(address: Address, len: u8, value: u32) -> [u8; 8] {
    let command = upload_command(4u32.wrapping_sub(len as u32) & 3) as u64;
    (command | (address.index as u64) << 8 | (address.sub as u64) << 24 | (value as u64) << 32)
        .to_le_bytes()
}

/// First byte of that frame, by the number of its unused bytes (0 to 3).
#[inline]
pub const fn upload_command(unused: u32) -> u32 {
    0x43 | unused << 2
}
