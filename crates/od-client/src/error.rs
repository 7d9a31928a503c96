//! The error of this crate.

use core::fmt;

use od_wire::AbortReason;
use od_wire::sdo::Response;

/// Reason why an SDO transfer or an LSS service failed.
///
/// If a transfer fails for another reason than [`Abort`](Self::Abort), the client sends an abort to
/// the server.
///
/// ```
/// use od_client::{AbortCode, Error};
///
/// let error = Error::Abort(AbortCode::NoObject.code());
/// assert_eq!(error.to_string(), "SDO abort 06020000h object does not exist");
/// ```
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
#[non_exhaustive]
pub enum Error {
    /// The server aborts with this code (CiA 301, table 22); [`AbortReason`] has its text.
    Abort(u32),
    /// No response came in time.
    Silent,
    /// The node sent a boot-up message during the transfer, which it has forgotten.
    Booted,
    /// The response is for another object, has another command or the wrong toggle bit.
    OutOfTurn {
        /// The expected response.
        expected: Expected,
        /// The received response.
        got: Response,
    },
    /// The value is longer than the buffer or than [`Options::limit`](crate::sdo::Options::limit).
    TooLong,
    /// The value has another length than the server announced.
    Length {
        /// Announced number of bytes.
        announced: u32,
        /// Number of bytes up to the end, or to the point where the client gave up.
        received: usize,
    },
    /// A response is too short for what it says: a value, a size, or an abort code.
    Short {
        /// Number of bytes that the response needs.
        needed: u8,
        /// Number of its bytes.
        received: u8,
    },
    /// The checksum of a block transfer does not match.
    Crc,
    /// The server sends segments without data, or repeats a block without end.
    NoProgress,
    /// The caller cancelled the transfer.
    Cancelled,
    /// The LSS slave responded with an error code (CiA 305, chapters 6.4.2 and 6.4.3).
    Refused {
        /// Error code; 255: the code of the manufacturer follows.
        error: u8,
        /// Specific error of the manufacturer.
        specific: u8,
    },
    /// The LSS slave responded with this node ID, which is neither 1 to 127 nor 255 (CiA 305, chapter 6.5.3).
    InvalidNodeId(u8),
    /// The LSS slave that fastscan was looking for did not confirm its LSS address.
    ScanFailed,
}

impl fmt::Display for Error {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Abort(code) => write!(f, "SDO abort {}", AbortReason(*code)),
            Self::Silent => f.write_str("no response comes in time"),
            Self::Booted => f.write_str("the node booted during the transfer"),
            Self::OutOfTurn { expected, got } => {
                write!(f, "{expected} was expected, but ")?;
                match (expected, got) {
                    (Expected::UploadSegment, Response::UploadSegment(_))
                    | (Expected::DownloadSegment, Response::DownloadSegment { .. }) => {
                        f.write_str("one with the wrong toggle bit came")
                    }
                    (
                        _,
                        Response::InitiateUpload { address, .. }
                        | Response::InitiateDownload { address }
                        | Response::Abort { address, .. }
                        | Response::InitiateBlockDownload { address, .. }
                        | Response::InitiateBlockUpload { address, .. },
                    ) => write!(f, "a response for {address} came"),
                    _ => f.write_str("another SDO response came"),
                }
            }
            Self::TooLong => f.write_str("the value is longer than the client allows"),
            Self::Length {
                announced,
                received,
            } => write!(
                f,
                "the SDO server announces a length of {announced} and sends {received}"
            ),
            Self::Short { needed, received } => write!(
                f,
                "the length of a response is {received}, and its content needs {needed}; an SDO message has 8 bytes"
            ),
            Self::Crc => f.write_str("the checksum of the block transfer does not match"),
            Self::NoProgress => f.write_str("the SDO server does not continue the transfer"),
            Self::Cancelled => f.write_str("the transfer was cancelled"),
            Self::Refused {
                error: 0xFF,
                specific,
            } => write!(f, "the LSS slave responds with specific error {specific}"),
            Self::Refused { error, .. } => write!(f, "the LSS slave responds with error {error}"),
            Self::InvalidNodeId(node) => {
                write!(
                    f,
                    "the LSS slave responds with node ID {node}, which is not valid"
                )
            }
            Self::ScanFailed => {
                f.write_str("no LSS slave confirms the LSS address that fastscan found")
            }
        }
    }
}

impl core::error::Error for Error {}

/// The response that a client waits for.
///
/// ```
/// use od_client::sdo::Expected;
///
/// assert_eq!(Expected::UploadSegment.to_string(), "an upload segment");
/// ```
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug)]
#[non_exhaustive]
pub enum Expected {
    /// Response to initiate upload.
    Upload,
    /// Segment of an upload.
    UploadSegment,
    /// Response to initiate download.
    Download,
    /// Response to a segment of a download.
    DownloadSegment,
    /// Response to initiate block upload.
    BlockUpload,
    /// Segment of a block.
    BlockSegment,
    /// End of a block upload.
    BlockUploadEnd,
    /// Response to initiate block download.
    BlockDownload,
    /// Response to the segments of a block.
    BlockConfirmation,
    /// Response to the end of a block download.
    BlockDownloadEnd,
}

impl fmt::Display for Expected {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(match self {
            Self::Upload => "an upload response",
            Self::UploadSegment => "an upload segment",
            Self::Download => "a download response",
            Self::DownloadSegment => "a download segment response",
            Self::BlockUpload => "a block upload response",
            Self::BlockSegment => "a block segment",
            Self::BlockUploadEnd => "the end of a block upload",
            Self::BlockDownload => "a block download response",
            Self::BlockConfirmation => "a block response",
            Self::BlockDownloadEnd => "the end of a block download",
        })
    }
}
