//! What a server answers.

use od_model::Address;

use super::head;

/// What a server's frame says.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Response {
    /// Upload segment.
    UploadSegment {
        /// Toggle bit.
        toggle: bool,
        /// The bytes; `len` of them count.
        data: [u8; 7],
        /// Number of bytes, 0–7.
        len: u8,
        /// No more segments follow.
        last: bool,
    },
    /// Download segment taken.
    DownloadSegment {
        /// Toggle bit.
        toggle: bool,
    },
    /// Initiate upload; `expedited` where the data is in it.
    InitiateUpload {
        /// What is read.
        address: Address,
        /// Size of the data in bytes, where indicated.
        size: Option<u32>,
        /// The data, for an expedited transfer: up to four bytes.
        expedited: Option<[u8; 4]>,
    },
    /// Download taken, or begun.
    InitiateDownload {
        /// What is written.
        address: Address,
    },
    /// Abort transfer.
    Abort {
        /// What the transfer was about.
        address: Address,
        /// Abort code.
        code: u32,
    },
    /// Block download begun.
    InitiateBlockDownload {
        /// What is written.
        address: Address,
        /// The server checks a CRC.
        crc: bool,
        /// Segments a block.
        block_size: u8,
    },
    /// Answer to a block.
    BlockDownloadResponse {
        /// Last segment in sequence.
        ack: u8,
        /// Segments of the next block.
        block_size: u8,
    },
    /// Block download ended.
    EndBlockDownload,
    /// Block upload begun.
    InitiateBlockUpload {
        /// What is read.
        address: Address,
        /// The server makes a CRC.
        crc: bool,
        /// Size of the data in bytes, where indicated.
        size: Option<u32>,
    },
    /// Block upload ended.
    EndBlockUpload {
        /// Bytes of the last segment that are no data, 0–7.
        unused: u8,
        /// CRC over the data, 0 if none was agreed on.
        crc: u16,
    },
    /// A command specifier that no response has.
    Unknown,
}

impl Response {
    /// The meaning of eight bytes; block segments again excepted.
    pub const fn parse(data: &[u8; 8]) -> Self {
        let [command, low, high, sub, a, b, c, d] = *data;
        let address = Address::new(u16::from_le_bytes([low, high]), sub);
        let four = u32::from_le_bytes([a, b, c, d]);
        let toggle = command & 0x10 != 0;
        match command >> 5 {
            0 => Self::UploadSegment {
                toggle,
                data: [low, high, sub, a, b, c, d],
                len: 7 - (command >> 1 & 7),
                last: command & 1 != 0,
            },
            1 => Self::DownloadSegment { toggle },
            2 => {
                let (expedited, sized) = (command & 2 != 0, command & 1 != 0);
                let size = match (expedited, sized) {
                    (true, true) => Some(4 - (command >> 2 & 3) as u32),
                    (false, true) => Some(four),
                    _ => None,
                };
                let expedited = if expedited { Some([a, b, c, d]) } else { None };
                Self::InitiateUpload {
                    address,
                    size,
                    expedited,
                }
            }
            3 => Self::InitiateDownload { address },
            4 => Self::Abort {
                address,
                code: four,
            },
            5 => match command & 3 {
                0 => Self::InitiateBlockDownload {
                    address,
                    crc: command & 4 != 0,
                    block_size: a,
                },
                1 => Self::EndBlockDownload,
                2 => Self::BlockDownloadResponse {
                    ack: low,
                    block_size: high,
                },
                _ => Self::Unknown,
            },
            6 if command & 1 == 0 => Self::InitiateBlockUpload {
                address,
                crc: command & 4 != 0,
                size: if command & 2 != 0 { Some(four) } else { None },
            },
            6 => Self::EndBlockUpload {
                unused: command >> 2 & 7,
                crc: u16::from_le_bytes([low, high]),
            },
            _ => Self::Unknown,
        }
    }

    /// The frame's bytes, as a server sends them.
    #[inline]
    pub fn emit(self) -> [u8; 8] {
        match self {
            Self::UploadSegment {
                toggle,
                data: [a, b, c, d, e, f, g],
                len,
                last,
            } => {
                let command = u8::from(toggle) << 4 | (7 - len.min(7)) << 1 | u8::from(last);
                [command, a, b, c, d, e, f, g]
            }
            Self::DownloadSegment { toggle } => [0x20 | u8::from(toggle) << 4, 0, 0, 0, 0, 0, 0, 0],
            Self::InitiateUpload {
                address,
                size,
                expedited: Some(data),
            } => {
                let n = size.map_or(0, |size| 4 - size.min(4) as u8);
                head(
                    0x42 | n << 2 | u8::from(size.is_some()),
                    address,
                    u32::from_le_bytes(data),
                )
            }
            Self::InitiateUpload {
                address,
                size,
                expedited: None,
            } => head(0x40 | u8::from(size.is_some()), address, size.unwrap_or(0)),
            Self::InitiateDownload { address } => head(0x60, address, 0),
            Self::Abort { address, code } => head(0x80, address, code),
            Self::InitiateBlockDownload {
                address,
                crc,
                block_size,
            } => head(0xA0 | u8::from(crc) << 2, address, block_size.into()),
            Self::BlockDownloadResponse { ack, block_size } => {
                [0xA2, ack, block_size, 0, 0, 0, 0, 0]
            }
            Self::EndBlockDownload => [0xA1, 0, 0, 0, 0, 0, 0, 0],
            Self::InitiateBlockUpload { address, crc, size } => {
                let command = 0xC0 | u8::from(crc) << 2 | u8::from(size.is_some()) << 1;
                head(command, address, size.unwrap_or(0))
            }
            Self::EndBlockUpload { unused, crc } => {
                let [low, high] = crc.to_le_bytes();
                [0xC1 | (unused & 7) << 2, low, high, 0, 0, 0, 0, 0]
            }
            Self::Unknown => [0xE0, 0, 0, 0, 0, 0, 0, 0],
        }
    }
}

/// The frame of an expedited upload: `len` bytes, 1–4, of `value`. It is what
/// [`Response::InitiateUpload`] emits, for the one answer that masters ask for all day.
#[inline]
pub const fn expedited_upload(address: Address, len: u8, value: u32) -> [u8; 8] {
    let command = 0x43 | ((4 - len as u64) & 3) << 2;
    (command | (address.index as u64) << 8 | (address.sub as u64) << 24 | (value as u64) << 32)
        .to_le_bytes()
}
