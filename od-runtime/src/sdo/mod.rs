//! SDO server (CiA 301, chapter 7.2.4): expedited, segmented and block transfers, both ways.
//!
//! A transfer is taken down into the server's buffer first and written when it is
//! complete, so one that breaks off leaves the object as it was.

mod block_download;
mod block_upload;
mod late;
mod segmented;

use od_model::Address;

use crate::objects::Objects;
use crate::store::little_endian;
use od_wire::sdo::{Request, Response, expedited_upload};
use od_wire::{AbortCode, Instant};

/// How long a block transfer waits for the client, in microseconds: its segments cannot
/// be told from requests, so a client that died would block the next one.
const BLOCK_TIMEOUT_US: u64 = 5_000_000;

/// Where a transfer stands.
#[derive(Clone, Copy, Debug, Default)]
enum Transfer {
    #[default]
    None,
    Upload(segmented::Upload),
    Download(segmented::Download),
    BlockUpload(block_upload::BlockUpload),
    BlockDownload(block_download::BlockDownload),
}

/// The server: one transfer at a time, `N` bytes of it.
#[derive(Debug)]
pub(crate) struct Server<const N: usize> {
    transfer: Transfer,
    address: Address,
    buffer: [u8; N],
    deadline: Option<Instant>,
    /// A frame would be the next segment of a block, whatever it says, or has to wait.
    is_deaf: bool,
    late: late::Late,
}

/// What the server answers.
type Answer = Result<Option<Response>, AbortCode>;

impl<const N: usize> Server<N> {
    pub(crate) const fn new() -> Self {
        Self {
            transfer: Transfer::None,
            address: Address::new(0, 0),
            buffer: [0; N],
            deadline: None,
            is_deaf: false,
            late: late::Late::NONE,
        }
    }

    /// Forgets everything without a word, as a change of the NMT state does.
    pub(crate) fn forget(&mut self) {
        self.reset();
        self.late = late::Late::NONE;
        self.is_deaf = false;
    }

    /// The transfer is over.
    #[inline]
    fn reset(&mut self) {
        self.transfer = Transfer::None;
        self.deadline = None;
    }

    /// A client's frame; `data` beyond `dlc` is 0.
    #[inline(always)]
    pub(crate) fn handle(
        &mut self,
        objects: &mut Objects<'_>,
        data: &[u8; 8],
        dlc: u8,
    ) -> Option<[u8; 8]> {
        if dlc < objects.profile.sdo.min_dlc {
            return None;
        }
        let address = Address::new(u16::from_le_bytes([data[1], data[2]]), data[3]);
        match data[0] {
            // What masters ask for all day comes first.
            0x40..=0x5F if !self.is_deaf => {
                self.begin(address);
                Some(match self.upload(objects, address) {
                    Ok(answer) => answer,
                    Err(code) => self.abort(code),
                })
            }
            _ => self.handle_other(objects, data, dlc),
        }
    }

    #[inline(never)]
    fn handle_other(
        &mut self,
        objects: &mut Objects<'_>,
        data: &[u8; 8],
        dlc: u8,
    ) -> Option<[u8; 8]> {
        if self.late.is_awaited() {
            self.late.hold(data, dlc);
            return None;
        }
        let answer = match self.transfer {
            Transfer::BlockDownload(block) if block.wants_segments() && data[0] != 0x80 => {
                self.block_segment(block, data)
            }
            _ => self.request(objects, Request::parse(data), data, dlc),
        };
        self.deadline = matches!(
            self.transfer,
            Transfer::BlockDownload(_) | Transfer::BlockUpload(_)
        )
        .then(|| objects.now.plus_micros(BLOCK_TIMEOUT_US));
        let is_late = core::mem::take(&mut objects.outbox.answer_later);
        let answer = match answer {
            Ok(Some(response)) if is_late => {
                self.late = late::Late::new(response.emit());
                None
            }
            Ok(response) => response.map(Response::emit),
            Err(code) => Some(self.abort(code)),
        };
        self.is_deaf = self.late.is_awaited()
            || matches!(self.transfer, Transfer::BlockDownload(block) if block.wants_segments());
        answer
    }

    fn request(
        &mut self,
        objects: &mut Objects<'_>,
        request: Request,
        data: &[u8; 8],
        dlc: u8,
    ) -> Answer {
        let profile = objects.profile.sdo;
        match (request, self.transfer) {
            (
                Request::InitiateDownload {
                    address,
                    size,
                    expedited,
                },
                _,
            ) => {
                self.begin(address);
                match expedited {
                    Some(bytes) => expedited_download(objects, address, size, &bytes, dlc),
                    None if !profile.segmented_download => Err(AbortCode::InvalidCommand),
                    None => self.begin_download(objects, address, size),
                }
            }
            (Request::UploadSegment { toggle }, Transfer::Upload(upload)) => {
                self.upload_segment(upload, toggle)
            }
            (
                Request::DownloadSegment {
                    toggle,
                    data,
                    len,
                    last,
                },
                Transfer::Download(download),
            ) => self.download_segment(
                objects,
                download,
                toggle,
                &data[..usize::from(len.min(7))],
                last,
            ),
            (Request::Abort { .. }, _) => {
                self.reset();
                Ok(None)
            }
            (
                Request::InitiateBlockUpload {
                    address,
                    crc,
                    block_size,
                    ..
                },
                _,
            ) if profile.block => self.begin_block_upload(objects, address, crc, block_size),
            (Request::StartBlockUpload, Transfer::BlockUpload(block)) => self.start_block(block),
            (Request::BlockUploadResponse { ack, block_size }, Transfer::BlockUpload(block)) => {
                self.block_acknowledged(block, ack, block_size)
            }
            (Request::EndBlockUpload, Transfer::BlockUpload(block)) if block.is_complete() => {
                self.reset();
                Ok(None)
            }
            (Request::InitiateBlockDownload { address, crc, size }, _) if profile.block => {
                self.begin_block_download(objects, address, crc, size)
            }
            (Request::EndBlockDownload { unused, crc }, Transfer::BlockDownload(block)) => {
                self.end_block_download(objects, block, unused, crc)
            }
            _ => {
                if matches!(self.transfer, Transfer::None) {
                    let [_, low, high, sub, ..] = *data;
                    self.address = Address::new(u16::from_le_bytes([low, high]), sub);
                }
                Err(AbortCode::InvalidCommand)
            }
        }
    }

    /// A new transfer takes the place of one that was not finished.
    #[inline]
    fn begin(&mut self, address: Address) {
        self.reset();
        self.address = address;
    }

    #[inline(always)]
    fn upload(
        &mut self,
        objects: &mut Objects<'_>,
        address: Address,
    ) -> Result<[u8; 8], AbortCode> {
        let segmented = objects.profile.sdo.segmented_upload;
        let mut number = [0; 8];
        let bytes = objects.read(address, &mut number)?;
        match *bytes {
            // What most objects are goes the straight way.
            [a, b, c, d] => Ok(expedited_upload(
                address,
                4,
                u32::from_le_bytes([a, b, c, d]),
            )),
            [_] | [_, _] | [_, _, _] => Ok(expedited_upload(
                address,
                bytes.len() as u8,
                little_endian(bytes) as u32,
            )),
            _ if !segmented => Err(AbortCode::UnsupportedAccess),
            _ => self.begin_upload(address, bytes),
        }
    }

    /// A value of more than four bytes (or none) goes in segments.
    #[inline(never)]
    fn begin_upload(&mut self, address: Address, bytes: &[u8]) -> Result<[u8; 8], AbortCode> {
        let room = self.buffer.get_mut(..bytes.len());
        room.ok_or(AbortCode::OutOfMemory)?.copy_from_slice(bytes);
        self.transfer = Transfer::Upload(segmented::Upload::new(bytes.len()));
        Ok(Response::InitiateUpload {
            address,
            size: Some(bytes.len() as u32),
            expedited: None,
        }
        .emit())
    }

    #[cold]
    fn abort(&mut self, code: AbortCode) -> [u8; 8] {
        self.reset();
        Response::Abort {
            address: self.address,
            code: code.code(),
        }
        .emit()
    }

    /// May [`poll`](Self::poll) have something?
    #[inline]
    pub(crate) fn is_sending(&self) -> bool {
        matches!(self.transfer, Transfer::BlockUpload(_))
    }

    /// The next segment of a block upload, if one is due.
    pub(crate) fn poll(&mut self) -> Option<[u8; 8]> {
        match self.transfer {
            Transfer::BlockUpload(block) => self.next_segment(block),
            _ => None,
        }
    }

    /// When a block transfer gives up.
    #[inline]
    pub(crate) fn deadline(&self) -> Option<Instant> {
        self.deadline
    }

    /// Gives up a block transfer whose client is gone.
    pub(crate) fn handle_timeout(&mut self, now: Instant) -> Option<[u8; 8]> {
        self.deadline.is_some_and(|at| at <= now).then(|| {
            self.is_deaf = false;
            self.abort(AbortCode::Timeout)
        })
    }
}

/// Writes the up to four bytes that came with the request. Where no size was indicated,
/// the object's own counts; where the frame is shorter than its data, what is missing was
/// not given.
fn expedited_download(
    objects: &mut Objects<'_>,
    address: Address,
    size: Option<u32>,
    bytes: &[u8; 4],
    dlc: u8,
) -> Answer {
    let entry = objects.writable(address, None)?;
    let given = usize::from(dlc.saturating_sub(4)).min(4);
    let own = entry.data_type.size();
    let len = match size {
        // Bytes that do not count need not be there either.
        Some(size) if objects.profile.sdo.length.too_long.is_none() => {
            (size as usize).min(own.unwrap_or(4)).min(4)
        }
        Some(size) => (size as usize).min(4),
        None => own.unwrap_or(given),
    };
    if len > given {
        return Err(objects.profile.sdo.length.too_short);
    }
    objects.write(address, &bytes[..len])?;
    Ok(Some(Response::InitiateDownload { address }))
}
