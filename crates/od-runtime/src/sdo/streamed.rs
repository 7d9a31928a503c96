//! Values that the application streams: the buffer holds one part of the value at a time.

use od_wire::AbortCode;
use od_wire::sdo::Response;

use super::late::{Held, Late};
use super::segmented::Upload;
use super::{Answer, Server, Stop, Transfer};
use crate::application::{Chunk, StreamEnd};
use crate::blank::Blank;
use crate::deadline::Deadline;
use crate::number::number_in;
use crate::objects::Objects;
use crate::services::Services;

impl<D: Services> Server<'_, D> {
    /// Returns whether the application streams the value of the transfer.
    pub(super) fn streams(&self) -> bool {
        D::STREAMS && self.state.is_streaming
    }

    /// Begins to read from the stream. Returns the length of the value in bytes.
    pub(super) fn open_stream(&mut self, objects: &mut Objects<'_, D>) -> Result<usize, Stop> {
        if !D::STREAMS {
            return Err(AbortCode::NoResource.into());
        }
        let address = self.state.address;
        let begun = objects.stream(address, |stream, cx| stream.begin_upload(cx, address));
        let len = begun.map_err(|halt| Stop::new(halt, &mut self.state.deadline))?;
        self.window.clear();
        self.state.is_streaming = true;
        Ok(len as usize)
    }

    /// Returns the response to an upload that is not a block transfer.
    pub(super) fn stream_upload(&mut self, objects: &mut Objects<'_, D>) -> Answer {
        let address = self.state.address;
        let len = self.open_stream(objects)?;
        let mut expedited = None;
        if (1..=4).contains(&len) {
            // A value that the stream cannot supply now is sent in a segment later.
            match self.fetch(objects, 0, len) {
                Ok(()) => {
                    let value = number_in(self.window.from(0)) as u32;
                    expedited = Some(value.to_le_bytes());
                }
                Err(Stop::Wait) => {}
                Err(stop) => return Err(stop),
            }
        }
        let segmented = D::SEGMENTED && objects.profile.sdo.segmented_upload;
        if expedited.is_some() {
            self.close(objects, StreamEnd::Complete);
        } else if segmented {
            self.state.transfer = Transfer::Upload(Upload::new(len));
        } else {
            return Err(AbortCode::UnsupportedAccess.into());
        }
        Ok(Some(
            Response::InitiateUpload {
                address,
                size: Some(len as u32),
                expedited,
            }
            .emit(),
        ))
    }

    /// Makes sure that the buffer has the value from `at` on: seven bytes or more, or the rest of
    /// its `len` bytes.
    pub(super) fn fetch(
        &mut self,
        objects: &mut Objects<'_, D>,
        at: usize,
        len: usize,
    ) -> Result<(), Stop> {
        if self.streams() {
            let left = len.saturating_sub(at);
            let end = at + left.min(7);
            let window = &mut self.window;
            let room = window.buffer.len();
            if at < window.part.start || end > window.end() {
                let to = window.buffer.get_mut(..left.min(room)).unwrap_or_default();
                if to.len() < left.min(7) {
                    return Err(AbortCode::OutOfMemory.into());
                }
                (window.part.start, window.part.len) = (at, 0);
                let address = self.state.address;
                let read = objects.stream(address, |stream, cx| {
                    stream.read(cx, address, at as u32, to)
                });
                read.map_err(|halt| Stop::new(halt, &mut self.state.deadline))?;
                window.part.len = left.min(room);
            }
        }
        Ok(())
    }

    /// Passes the first `len` bytes of the buffer to the stream.
    pub(super) fn give(
        &mut self,
        objects: &mut Objects<'_, D>,
        len: usize,
        last: bool,
    ) -> Result<(), Stop> {
        if !D::STREAMS {
            return Ok(());
        }
        let (address, at) = (self.state.address, self.window.part.start as u32);
        let bytes = self.window.first(len);
        let chunk = Chunk { at, bytes, last };
        let given = objects.stream(address, |stream, cx| stream.write(cx, address, chunk));
        given.map_err(|halt| Stop::new(halt, &mut self.state.deadline))
    }

    /// Passes all bytes of the buffer to the stream, and empties the buffer.
    pub(super) fn pass_on(&mut self, objects: &mut Objects<'_, D>) -> Result<(), Stop> {
        let len = self.window.part.len;
        if len > 0 {
            self.give(objects, len, false)?;
            self.window.part.start += len;
            self.window.part.len = 0;
        }
        Ok(())
    }

    /// Ends the transfer, and tells the stream how it ended.
    pub(super) fn close(&mut self, objects: &mut Objects<'_, D>, end: StreamEnd) {
        if D::STREAMS && core::mem::take(&mut self.state.is_streaming) {
            let address = self.state.address;
            // An application that no longer has this stream needs no notification.
            let _ = objects.stream(address, |stream, cx| {
                stream.end(cx, address, end);
                Ok(())
            });
        }
        self.reset();
    }

    /// Waits until `until`, because the stream cannot serve this request or the next segment
    /// before.
    pub(super) fn await_stream(&mut self, until: Deadline, held: Option<Held>) {
        self.state.late = Late::stream(held);
        self.state.deadline = until;
    }

    /// Asks the stream again.
    pub(super) fn ask_again(&mut self, objects: &mut Objects<'_, D>) -> Option<[u8; 8]> {
        let held = self.state.late.held;
        self.state.late = Late::BLANK;
        self.await_client(objects.now);
        let (data, dlc) = held?;
        self.handle(objects, &data, dlc)
    }

    /// Asks a waiting stream again after a change outside the bus.
    pub(crate) fn handle_change(&mut self, objects: &mut Objects<'_, D>) -> Option<[u8; 8]> {
        if !D::STREAMS || !self.state.late.awaits_stream() {
            return None;
        }
        self.ask_again(objects)
    }
}
