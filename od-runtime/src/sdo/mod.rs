//! SDO server (CiA 301, chapter 7.2.4): expedited, segmented and block transfers, both ways.
//!
//! The server buffers a download and writes it when it is complete, so one that breaks off
//! leaves the object as it was.

mod block_download;
mod block_upload;
mod expedited;
mod late;
mod segmented;

use od_model::Address;

use crate::device::Device;
use crate::objects::Objects;
use crate::store::little_endian;
use od_wire::sdo::{Request, Response, expedited_upload};
use od_wire::{AbortCode, Instant};

use block_download::BlockDownload;
use block_upload::BlockUpload;
use late::{Held, Late};
use segmented::{Download, Upload};

/// Longest time that a block transfer waits for the client, in microseconds: its segments look
/// like requests, so a client that died would block the next one.
const BLOCK_TIMEOUT_US: u64 = 5_000_000;

/// Transfer under way.
#[derive(Clone, Copy, Debug, Default)]
enum Transfer {
    #[default]
    None,
    Upload(Upload),
    Download(Download),
    BlockUpload(BlockUpload),
    BlockDownload(BlockDownload),
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
    late: Late,
}

/// Response of the server, if there is one, or the reason of its abort.
type Answer = Result<Option<Response>, AbortCode>;

impl<const N: usize> Server<N> {
    pub(crate) const fn new() -> Self {
        Self {
            transfer: Transfer::None,
            address: Address::new(0, 0),
            buffer: [0; N],
            deadline: None,
            is_deaf: false,
            late: Late::NONE,
        }
    }

    /// Forgets everything without a word, as a change of the NMT state does.
    pub(crate) fn forget(&mut self) {
        self.reset();
        self.late = Late::NONE;
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
    pub(crate) fn handle<D: Device>(
        &mut self,
        objects: &mut Objects<'_, D>,
        data: &[u8; 8],
        dlc: u8,
    ) -> Option<[u8; 8]> {
        if dlc < objects.profile().sdo.min_dlc {
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
    fn handle_other<D: Device>(
        &mut self,
        objects: &mut Objects<'_, D>,
        data: &[u8; 8],
        dlc: u8,
    ) -> Option<[u8; 8]> {
        if D::STORAGE && self.late.is_awaited() {
            self.late.hold(data, dlc);
            return None;
        }
        let answer = match &mut self.transfer {
            Transfer::BlockDownload(block)
                if D::BLOCK && block.wants_segments() && data[0] != 0x80 =>
            {
                block.segment(&mut self.buffer, data)
            }
            _ => self.request(objects, Request::parse(data), data, dlc),
        };
        self.deadline = matches!(
            self.transfer,
            Transfer::BlockDownload(_) | Transfer::BlockUpload(_)
        )
        .then(|| objects.now.plus_micros(BLOCK_TIMEOUT_US));
        let is_late = D::STORAGE && core::mem::take(&mut objects.outbox.answer_later);
        let answer = match answer {
            Ok(Some(response)) if is_late => {
                self.late = Late::new(response.emit());
                None
            }
            Ok(response) => response.map(Response::emit),
            Err(code) => Some(self.abort(code)),
        };
        self.is_deaf = self.late.is_awaited()
            || matches!(self.transfer, Transfer::BlockDownload(block) if block.wants_segments());
        answer
    }

    fn request<D: Device>(
        &mut self,
        objects: &mut Objects<'_, D>,
        request: Request,
        data: &[u8; 8],
        dlc: u8,
    ) -> Answer {
        let profile = objects.profile().sdo;
        match (request, &mut self.transfer) {
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
                    Some(bytes) => expedited::download(objects, address, size, &bytes, dlc)?,
                    None if !D::SEGMENTED || !profile.segmented_download => {
                        return Err(AbortCode::InvalidCommand);
                    }
                    None => {
                        Self::check_size(objects, address, size)?;
                        self.transfer = Transfer::Download(Download::new(size));
                    }
                }
                Ok(Some(Response::InitiateDownload { address }))
            }
            (Request::UploadSegment { toggle }, Transfer::Upload(upload)) if D::SEGMENTED => {
                let segment = upload.segment(&self.buffer, toggle)?;
                if upload.is_over() {
                    self.reset();
                }
                Ok(Some(segment))
            }
            (Request::DownloadSegment(segment), Transfer::Download(download)) if D::SEGMENTED => {
                if let Some(len) = download.segment(&mut self.buffer, &segment)? {
                    self.write(objects, len)?;
                }
                let toggle = segment.toggle;
                Ok(Some(Response::DownloadSegment { toggle }))
            }
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
            ) if D::BLOCK && profile.block => {
                self.begin(address);
                block_upload::check(block_size)?;
                let mut number = [0; 8];
                let len = self.load(objects.read(address, &mut number)?)?;
                self.transfer = Transfer::BlockUpload(BlockUpload::new(len, crc, block_size));
                Ok(Some(Response::InitiateBlockUpload {
                    address,
                    crc: true,
                    size: Some(len as u32),
                }))
            }
            (Request::StartBlockUpload, Transfer::BlockUpload(block)) if D::BLOCK => {
                block.start().map(|()| None)
            }
            (Request::BlockUploadResponse { ack, block_size }, Transfer::BlockUpload(block))
                if D::BLOCK =>
            {
                block.acknowledged(&self.buffer, ack, block_size)
            }
            (Request::EndBlockUpload, Transfer::BlockUpload(block))
                if D::BLOCK && block.is_complete() =>
            {
                self.reset();
                Ok(None)
            }
            (Request::InitiateBlockDownload { address, crc, size }, _)
                if D::BLOCK && profile.block =>
            {
                self.begin(address);
                Self::check_size(objects, address, size)?;
                let block = BlockDownload::new(&self.buffer, crc, size);
                self.transfer = Transfer::BlockDownload(block);
                Ok(Some(Response::InitiateBlockDownload {
                    address,
                    crc: true,
                    block_size: block.block_size(),
                }))
            }
            (Request::EndBlockDownload { unused, crc }, Transfer::BlockDownload(block))
                if D::BLOCK =>
            {
                let len = block.end(&self.buffer, unused, crc)?;
                self.write(objects, len)?;
                Ok(Some(Response::EndBlockDownload))
            }
            (_, transfer) => {
                if matches!(transfer, Transfer::None) {
                    let [_, low, high, sub, ..] = *data;
                    self.address = Address::new(u16::from_le_bytes([low, high]), sub);
                }
                Err(AbortCode::InvalidCommand)
            }
        }
    }

    /// Checks whether a value of this size may be written to the object, and fits the buffer.
    fn check_size<D: Device>(
        objects: &Objects<'_, D>,
        address: Address,
        size: Option<u32>,
    ) -> Result<(), AbortCode> {
        let size = size.map(|size| size as usize);
        objects.writable(address, size)?;
        match size {
            Some(size) if size > N => Err(AbortCode::OutOfMemory),
            _ => Ok(()),
        }
    }

    /// Copies a value into the buffer. Returns its length.
    fn load(&mut self, bytes: &[u8]) -> Result<usize, AbortCode> {
        let room = self.buffer.get_mut(..bytes.len());
        room.ok_or(AbortCode::OutOfMemory)?.copy_from_slice(bytes);
        Ok(bytes.len())
    }

    /// A download is complete: writes the first `len` bytes of the buffer, and ends the transfer.
    fn write<D: Device>(
        &mut self,
        objects: &mut Objects<'_, D>,
        len: usize,
    ) -> Result<(), AbortCode> {
        objects.write(self.address, self.buffer.get(..len).unwrap_or(&[]))?;
        self.reset();
        Ok(())
    }

    /// A new transfer takes the place of one that was not finished.
    #[inline]
    fn begin(&mut self, address: Address) {
        self.reset();
        self.address = address;
    }

    #[inline(always)]
    fn upload<D: Device>(
        &mut self,
        objects: &mut Objects<'_, D>,
        address: Address,
    ) -> Result<[u8; 8], AbortCode> {
        let segmented = D::SEGMENTED && objects.profile().sdo.segmented_upload;
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
        let len = self.load(bytes)?;
        self.transfer = Transfer::Upload(Upload::new(len));
        Ok(Response::InitiateUpload {
            address,
            size: Some(len as u32),
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

    /// Whether [`poll`](Self::poll) may have a segment.
    #[inline]
    pub(crate) fn is_sending(&self) -> bool {
        matches!(self.transfer, Transfer::BlockUpload(_))
    }

    /// The next segment of a block upload, if one is due.
    pub(crate) fn poll(&mut self) -> Option<[u8; 8]> {
        match &mut self.transfer {
            Transfer::BlockUpload(block) => block.segment(&self.buffer),
            _ => None,
        }
    }

    /// Everything is stored, or could not be: the answer that waited, and the request behind it.
    pub(crate) fn finish(&mut self, failed: Option<AbortCode>) -> (Option<[u8; 8]>, Option<Held>) {
        let Late { answer, held, .. } = core::mem::replace(&mut self.late, Late::NONE);
        self.is_deaf = false;
        let answer = match (answer, failed) {
            (Some(_), Some(code)) => Some(self.abort(code)),
            (answer, _) => answer,
        };
        (answer, held)
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
