//! Segmented transfers (CiA 301, chapters 7.2.4.3.4–7.2.4.3.8).

use od_model::Address;

use super::{Answer, Server, Transfer};
use crate::objects::Objects;
use od_wire::AbortCode;
use od_wire::sdo::Response;

/// An upload under way: the value stands in the buffer.
#[derive(Clone, Copy, Debug)]
pub(super) struct Upload {
    toggle: bool,
    sent: usize,
    len: usize,
}

impl Upload {
    pub(super) const fn new(len: usize) -> Self {
        Self {
            toggle: false,
            sent: 0,
            len,
        }
    }
}

/// A download under way.
#[derive(Clone, Copy, Debug)]
pub(super) struct Download {
    toggle: bool,
    received: usize,
    size: Option<u32>,
}

impl<const N: usize> Server<N> {
    pub(super) fn upload_segment(&mut self, mut upload: Upload, toggle: bool) -> Answer {
        if toggle != upload.toggle {
            return Err(AbortCode::ToggleBit);
        }
        let rest = self.buffer.get(upload.sent..upload.len).unwrap_or(&[]);
        let len = rest.len().min(7);
        let mut data = [0; 7];
        data[..len].copy_from_slice(&rest[..len]);
        let last = len == rest.len();
        upload.sent += len;
        upload.toggle = !toggle;
        if last {
            self.reset();
        } else {
            self.transfer = Transfer::Upload(upload);
        }
        Ok(Some(Response::UploadSegment {
            toggle,
            data,
            len: len as u8,
            last,
        }))
    }

    pub(super) fn begin_download(
        &mut self,
        objects: &mut Objects<'_>,
        address: Address,
        size: Option<u32>,
    ) -> Answer {
        objects.writable(address, size.map(|size| size as usize))?;
        if size.is_some_and(|size| size as usize > N) {
            return Err(AbortCode::OutOfMemory);
        }
        self.transfer = Transfer::Download(Download {
            toggle: false,
            received: 0,
            size,
        });
        Ok(Some(Response::InitiateDownload { address }))
    }

    pub(super) fn download_segment(
        &mut self,
        objects: &mut Objects<'_>,
        mut download: Download,
        toggle: bool,
        data: &[u8],
        last: bool,
    ) -> Answer {
        if toggle != download.toggle {
            return Err(AbortCode::ToggleBit);
        }
        let end = download.received + data.len();
        if download.size.is_some_and(|size| end > size as usize) {
            return Err(AbortCode::TooLong);
        }
        let room = self
            .buffer
            .get_mut(download.received..end)
            .ok_or(AbortCode::OutOfMemory)?;
        room.copy_from_slice(data);
        download.received = end;
        download.toggle = !toggle;
        self.transfer = Transfer::Download(download);
        if last {
            if download.size.is_some_and(|size| end < size as usize) {
                return Err(AbortCode::TooShort);
            }
            objects.write(self.address, &self.buffer[..end])?;
            self.reset();
        }
        Ok(Some(Response::DownloadSegment { toggle }))
    }
}
