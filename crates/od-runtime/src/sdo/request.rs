//! Requests of clients, except the expedited upload, which `mod.rs` handles first.

use od_model::Address;
use od_wire::AbortCode;
use od_wire::sdo::{Response, Segment, address, crc16_after, end, number, toggle, wants_crc};

use super::block_download::BlockDownload;
use super::block_upload::{self, BlockUpload};
use super::segmented::Download;
use super::{Answer, Server, Stop, Transfer};
use crate::application::StreamEnd;
use crate::objects::{Objects, Unread};
use crate::profile::SdoProfile;
use crate::services::Services;
use od_model::row::Row;

impl<D: Services> Server<'_, D> {
    /// Handles a request by its command specifier.
    #[inline]
    pub(super) fn request(
        &mut self,
        objects: &mut Objects<'_, D>,
        data: &[u8; 8],
        dlc: u8,
    ) -> Answer {
        let [command, .., a, b, c, d] = *data;
        let address = address(data);
        match command >> 5 {
            1 if command & 2 != 0 => self.expedited(objects, address, data, dlc),
            4 => {
                let code = u32::from_le_bytes([a, b, c, d]);
                self.close(objects, StreamEnd::Cancelled(code));
                Ok(None)
            }
            _ if D::SEGMENTED || D::BLOCK || D::STREAMS => self.transfer_request(objects, data),
            _ => {
                self.state.address = address;
                Err(AbortCode::InvalidCommand.into())
            }
        }
    }

    /// Handles a request of a transfer of several frames. It is a function of its own, so that its
    /// stack frame does not add to that of an expedited download, which may save all values.
    fn transfer_request(&mut self, objects: &mut Objects<'_, D>, data: &[u8; 8]) -> Answer {
        let profile = &objects.profile.sdo;
        let has_blocks = D::BLOCK && profile.block;
        // The fields are used without making a `Request` of them, which would take more code.
        let (command, kind) = (data[0] >> 5, data[0] & 3);
        match (command, kind, &mut self.state.transfer) {
            (1, ..) => {
                self.replace(objects, address(data));
                if !D::SEGMENTED || !profile.segmented_download {
                    return Err(AbortCode::InvalidCommand.into());
                }
                let size = (kind == 1).then_some(number(data));
                self.open_download(objects, size)?;
                self.state.transfer = Transfer::Download(Download::new(size));
                let address = self.state.address;
                Ok(Some(Response::InitiateDownload { address }.emit_to(data)))
            }
            (3, _, Transfer::Upload(upload)) if D::SEGMENTED => {
                upload.check(toggle(data))?;
                let (at, len) = (upload.sent(), upload.len());
                self.fetch(objects, at, len)?;
                let Transfer::Upload(upload) = &mut self.state.transfer else {
                    return Ok(None);
                };
                let segment = upload.segment(self.window.from(at));
                if upload.is_over() {
                    self.close(objects, StreamEnd::Complete);
                }
                Ok(Some(segment))
            }
            (0, _, Transfer::Download(download)) if D::SEGMENTED => {
                let mut download = *download;
                let (bytes, is_last) = Segment::of_frame(data);
                let toggle = toggle(data);
                download.check(toggle, self.window.end() + bytes.len(), is_last)?;
                if self.streams() && bytes.len() > self.window.room() {
                    self.pass_on(objects)?;
                }
                self.window.put(bytes)?;
                let len = self.window.part.len + bytes.len();
                if is_last {
                    self.complete(objects, len)?;
                } else {
                    self.window.part.len = len;
                    download.go_on();
                    self.state.transfer = Transfer::Download(download);
                }
                Ok(Some(Response::DownloadSegment { toggle }.emit()))
            }
            (5, 0, _) if has_blocks => {
                self.replace(objects, address(data));
                let block_size = data[4];
                block_upload::check(block_size)?;
                let len = self.open_upload(objects)?;
                let block = BlockUpload::new(len, wants_crc(data), block_size);
                self.state.transfer = Transfer::BlockUpload(block);
                let response = Response::InitiateBlockUpload {
                    address: self.state.address,
                    crc: true,
                    size: Some(len as u32),
                };
                Ok(Some(response.emit_to(data)))
            }
            (5, 3, Transfer::BlockUpload(block)) if D::BLOCK => {
                block.start()?;
                Ok(None)
            }
            (5, 2, Transfer::BlockUpload(block)) if D::BLOCK => {
                Ok(block.acknowledged(data[1], data[2])?)
            }
            (5, 1, Transfer::BlockUpload(block)) if D::BLOCK && block.is_complete() => {
                self.close(objects, StreamEnd::Complete);
                Ok(None)
            }
            (6, 0 | 2, _) if has_blocks => {
                self.replace(objects, address(data));
                let size = (kind == 2).then_some(number(data));
                self.open_download(objects, size)?;
                let block = BlockDownload::new(self.window.buffer.len(), wants_crc(data), size);
                self.state.transfer = Transfer::BlockDownload(block);
                let response = Response::InitiateBlockDownload {
                    address: self.state.address,
                    crc: true,
                    block_size: block.block_size(),
                };
                Ok(Some(response.emit_to(data)))
            }
            (6, 1 | 3, Transfer::BlockDownload(block)) if D::BLOCK => {
                let (unused, crc) = end(data);
                let len = block.end(&self.window, unused, crc)?;
                self.complete(objects, len)?;
                Ok(Some(Response::EndBlockDownload.emit()))
            }
            (.., transfer) => {
                if matches!(transfer, Transfer::None) {
                    self.state.address = address(data);
                }
                Err(AbortCode::InvalidCommand.into())
            }
        }
    }

    fn expedited(
        &mut self,
        objects: &mut Objects<'_, D>,
        address: Address,
        data: &[u8; 8],
        dlc: u8,
    ) -> Answer {
        // Bytes 4 to 7 are the value; the command contains the number of unused bytes.
        let [command, _, _, _, bytes @ ..] = data;
        let size = (command & 1 != 0).then_some(4 - (command >> 2 & 3));
        let had_begun = match self.state.transfer {
            Transfer::Expedited(len) if D::STREAMS && address == self.state.address => {
                Some(usize::from(len))
            }
            _ => None,
        };
        if had_begun.is_none() {
            self.replace(objects, address);
        }
        let row = objects.writable(address)?;
        let len = expedited_len(&objects.profile.sdo, row, size.map(u32::from), dlc)?;
        let bytes = bytes.get(..len).unwrap_or_default();
        if !objects.streams(row) {
            objects.change(row, bytes)?;
            self.reset();
        } else {
            if had_begun != Some(len) {
                self.close(objects, StreamEnd::Replaced);
                self.open_download(objects, Some(len as u32))?;
                self.state.transfer = Transfer::Expedited(len as u8);
            }
            self.window.clear();
            self.window.put(bytes)?;
            self.complete(objects, len)?;
        }
        Ok(Some(Response::InitiateDownload { address }.emit_to(data)))
    }

    /// Begins a download, if the value can be written and fits into the buffer.
    fn open_download(
        &mut self,
        objects: &mut Objects<'_, D>,
        size: Option<u32>,
    ) -> Result<(), Stop> {
        let address = self.state.address;
        let row = objects.writable(address)?;
        self.window.clear();
        if objects.streams(row) {
            let begun = objects.stream(address, |stream, cx| {
                stream.begin_download(cx, address, size)
            });
            begun.map_err(|halt| Stop::new(halt, &mut self.state.deadline))?;
            self.state.is_streaming = true;
            return Ok(());
        }
        let size = size.map(|size| size as usize);
        if let Some(size) = size {
            objects.fit(row, size)?;
        }
        match size {
            Some(size) if size > self.window.buffer.len() => Err(AbortCode::OutOfMemory.into()),
            _ => Ok(()),
        }
    }

    /// Begins a block upload. Returns the length of the value in bytes.
    fn open_upload(&mut self, objects: &mut Objects<'_, D>) -> Result<usize, Stop> {
        let mut number = [0; 8];
        match objects.read(self.state.address, &mut number) {
            Ok(bytes) => Ok(self.window.load(bytes)?),
            Err(Unread::Abort(code)) => Err(code.into()),
            Err(Unread::Streamed) => self.open_stream(objects),
        }
    }

    /// Handles a segment of a block download.
    pub(super) fn block_segment(&mut self, objects: &mut Objects<'_, D>, data: &[u8; 8]) -> Answer {
        let Transfer::BlockDownload(block) = &mut self.state.transfer else {
            return Ok(None);
        };
        if !block.segment(&mut self.window, data)? {
            return Ok(None);
        }
        // The last part is passed on after the checks of length and checksum.
        if D::STREAMS && self.state.is_streaming && block.wants_segments() {
            let mut block = *block;
            block.check_size(&self.window)?;
            block.crc_before =
                crc16_after(block.crc_before, self.window.first(self.window.part.len));
            self.pass_on(objects)?;
            self.state.transfer = Transfer::BlockDownload(block);
        }
        let Transfer::BlockDownload(block) = &mut self.state.transfer else {
            return Ok(None);
        };
        Ok(Some(block.confirm(self.window.room()).emit()))
    }

    /// Completes a download: writes the first `len` bytes of the buffer, and ends the transfer.
    fn complete(&mut self, objects: &mut Objects<'_, D>, len: usize) -> Result<(), Stop> {
        if self.streams() {
            self.give(objects, len, true)?;
            objects.streamed(self.state.address);
        } else {
            objects.write(self.state.address, self.window.first(len))?;
        }
        self.close(objects, StreamEnd::Complete);
        Ok(())
    }
}

/// Returns how many of the up to four bytes of an expedited download are the value (CiA 301,
/// chapter 7.2.4.3.3). Without an indicated size it is the length of the object. Bytes beyond the
/// DLC of the frame were not given.
fn expedited_len(
    profile: &SdoProfile,
    row: &Row,
    size: Option<u32>,
    dlc: u8,
) -> Result<usize, AbortCode> {
    let given = usize::from(dlc.saturating_sub(4)).min(4);
    let own = Some(row.size()).filter(|size| *size > 0);
    let len = match size {
        // Bytes that the node would ignore may be missing.
        Some(size) if profile.length.too_long.is_none() => {
            (size as usize).min(own.unwrap_or(4)).min(4)
        }
        Some(size) => (size as usize).min(4),
        None => own.unwrap_or(given),
    };
    if len > given {
        return Err(profile.length.too_short);
    }
    Ok(len)
}
