//! What a client sends.

use od_model::Address;

use super::head;

/// What a client's frame says.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Request {
    /// Initiate download; `data` where expedited.
    InitiateDownload {
        /// What is written.
        address: Address,
        /// Size of the data in bytes, where indicated.
        size: Option<u32>,
        /// The data, for an expedited transfer: up to four bytes.
        expedited: Option<[u8; 4]>,
    },
    /// Download segment.
    DownloadSegment {
        /// Toggle bit.
        toggle: bool,
        /// The bytes; `len` of them count.
        data: [u8; 7],
        /// Number of bytes, 0–7.
        len: u8,
        /// No more segments follow.
        last: bool,
    },
    /// Initiate upload.
    InitiateUpload {
        /// What is read.
        address: Address,
    },
    /// Upload segment.
    UploadSegment {
        /// Toggle bit.
        toggle: bool,
    },
    /// Abort transfer.
    Abort {
        /// What the transfer was about.
        address: Address,
        /// Abort code.
        code: u32,
    },
    /// Initiate block upload.
    InitiateBlockUpload {
        /// What is read.
        address: Address,
        /// The client can check a CRC.
        crc: bool,
        /// Segments a block, 1–127 if it is legal.
        block_size: u8,
        /// Data of up to this many bytes may come by another protocol; 0: never.
        threshold: u8,
    },
    /// Start block upload.
    StartBlockUpload,
    /// Answer to a block.
    BlockUploadResponse {
        /// Last segment in sequence.
        ack: u8,
        /// Segments of the next block.
        block_size: u8,
    },
    /// End of block upload.
    EndBlockUpload,
    /// Initiate block download.
    InitiateBlockDownload {
        /// What is written.
        address: Address,
        /// The client makes a CRC.
        crc: bool,
        /// Size of the data in bytes, where indicated.
        size: Option<u32>,
    },
    /// End of block download.
    EndBlockDownload {
        /// Bytes of the last segment that are no data, 0–7.
        unused: u8,
        /// CRC over the data, 0 if none was agreed on.
        crc: u16,
    },
    /// A command specifier that no request has.
    Unknown,
}

impl Request {
    /// The meaning of eight bytes. Block segments are not told apart here: they
    /// have no command specifier, the server's state says that they are due.
    #[inline]
    pub const fn parse(data: &[u8; 8]) -> Self {
        let [command, low, high, sub, a, b, c, d] = *data;
        let address = Address::new(u16::from_le_bytes([low, high]), sub);
        let four = u32::from_le_bytes([a, b, c, d]);
        let toggle = command & 0x10 != 0;
        match command >> 5 {
            0 => Self::DownloadSegment {
                toggle,
                data: [low, high, sub, a, b, c, d],
                len: 7 - (command >> 1 & 7),
                last: command & 1 != 0,
            },
            1 => {
                let (expedited, sized) = (command & 2 != 0, command & 1 != 0);
                let size = match (expedited, sized) {
                    (true, true) => Some(4 - (command >> 2 & 3) as u32),
                    (false, true) => Some(four),
                    _ => None,
                };
                let expedited = if expedited { Some([a, b, c, d]) } else { None };
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
                code: four,
            },
            5 => match command & 3 {
                0 => Self::InitiateBlockUpload {
                    address,
                    crc: command & 4 != 0,
                    block_size: a,
                    threshold: b,
                },
                1 => Self::EndBlockUpload,
                2 => Self::BlockUploadResponse {
                    ack: low,
                    block_size: high,
                },
                _ => Self::StartBlockUpload,
            },
            6 if command & 1 == 0 => Self::InitiateBlockDownload {
                address,
                crc: command & 4 != 0,
                size: if command & 2 != 0 { Some(four) } else { None },
            },
            6 => Self::EndBlockDownload {
                unused: command >> 2 & 7,
                crc: u16::from_le_bytes([low, high]),
            },
            _ => Self::Unknown,
        }
    }

    /// The frame's bytes, as a client sends them.
    pub fn emit(self) -> [u8; 8] {
        match self {
            Self::InitiateDownload {
                address,
                size,
                expedited: Some(data),
            } => {
                let n = size.map_or(0, |size| 4 - size.min(4) as u8);
                head(
                    0x22 | n << 2 | u8::from(size.is_some()),
                    address,
                    u32::from_le_bytes(data),
                )
            }
            Self::InitiateDownload {
                address,
                size,
                expedited: None,
            } => head(0x20 | u8::from(size.is_some()), address, size.unwrap_or(0)),
            Self::DownloadSegment {
                toggle,
                data: [a, b, c, d, e, f, g],
                len,
                last,
            } => {
                let command = u8::from(toggle) << 4 | (7 - len.min(7)) << 1 | u8::from(last);
                [command, a, b, c, d, e, f, g]
            }
            Self::InitiateUpload { address } => head(0x40, address, 0),
            Self::UploadSegment { toggle } => [0x60 | u8::from(toggle) << 4, 0, 0, 0, 0, 0, 0, 0],
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
            Self::StartBlockUpload => [0xA3, 0, 0, 0, 0, 0, 0, 0],
            Self::BlockUploadResponse { ack, block_size } => [0xA2, ack, block_size, 0, 0, 0, 0, 0],
            Self::EndBlockUpload => [0xA1, 0, 0, 0, 0, 0, 0, 0],
            Self::InitiateBlockDownload { address, crc, size } => {
                let command = 0xC0 | u8::from(crc) << 2 | u8::from(size.is_some()) << 1;
                head(command, address, size.unwrap_or(0))
            }
            Self::EndBlockDownload { unused, crc } => {
                let [low, high] = crc.to_le_bytes();
                [0xC1 | (unused & 7) << 2, low, high, 0, 0, 0, 0, 0]
            }
            Self::Unknown => [0xE0, 0, 0, 0, 0, 0, 0, 0],
        }
    }
}
