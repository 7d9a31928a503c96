//! Values that the application streams: the buffer has the part that is on its way.

use od_wire::AbortCode;
use od_wire::sdo::Response;

use super::late::{Held, Late};
use super::segmented::Upload;
use super::stop::Stop;
use super::{Answer, Server, Transfer};
use crate::application::{Chunk, StreamEnd};
use crate::deadline::Deadline;
use crate::device::Device;
use crate::number::number_in;
use crate::objects::Objects;
use crate::rooms::{Blank, Rooms};

impl<D: Device, const N: usize, R: Rooms> Server<D, N, R> {
    /// Whether the application streams the value of the transfer.
    pub(super) fn streams(&self) -> bool {
        D::STREAMS && self.is_streaming
    }

    /// Begins to read from the stream. Returns the length of the value.
    pub(super) fn open_stream(&mut self, objects: &mut Objects<'_, D>) -> Result<usize, Stop> {
        if !D::STREAMS {
            return Err(AbortCode::NoResource.into());
        }
        let address = self.address;
        let begun = objects.stream(address, |stream, cx| stream.begin_upload(cx, address));
        let len = begun.map_err(|halt| Stop::new(halt, &mut self.deadline))?;
        self.window.clear();
        self.is_streaming = true;
        Ok(len as usize)
    }

    /// The answer to an upload that is not a block transfer.
    pub(super) fn stream_upload(&mut self, objects: &mut Objects<'_, D>) -> Answer {
        let address = self.address;
        let len = self.open_stream(objects)?;
        let mut expedited = None;
        if (1..=4).contains(&len) {
            // One that cannot be had now goes in a segment.
            match self.fetch(objects, 0, len) {
                Ok(()) => {
                    let value = number_in(self.window.from(0)) as u32;
                    expedited = Some(value.to_le_bytes());
                }
                Err(Stop::Wait) => {}
                Err(stop) => return Err(stop),
            }
        }
        let segmented = D::SEGMENTED && objects.profile().sdo.segmented_upload;
        if expedited.is_some() {
            self.close(objects, StreamEnd::Complete);
        } else if segmented {
            self.set_transfer(Transfer::Upload(Upload::new(len)));
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

    /// Has the value from `at` on in the buffer: seven bytes or more, or all that is left of its `len`
    /// bytes.
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
            if at < window.start || end > window.end() {
                let to = window.buffer.get_mut(..left.min(N)).unwrap_or_default();
                if to.len() < left.min(7) {
                    return Err(AbortCode::OutOfMemory.into());
                }
                (window.start, window.len) = (at, 0);
                let address = self.address;
                let read = objects.stream(address, |stream, cx| {
                    stream.read(cx, address, at as u32, to)
                });
                read.map_err(|halt| Stop::new(halt, &mut self.deadline))?;
                window.len = left.min(N);
            }
        }
        Ok(())
    }

    /// Gives the first `len` bytes of the buffer to the stream.
    pub(super) fn give(
        &mut self,
        objects: &mut Objects<'_, D>,
        len: usize,
        last: bool,
    ) -> Result<(), Stop> {
        if !D::STREAMS {
            return Ok(());
        }
        let (address, at) = (self.address, self.window.start as u32);
        let bytes = self.window.first(len);
        let chunk = Chunk { at, bytes, last };
        let given = objects.stream(address, |stream, cx| stream.write(cx, address, chunk));
        given.map_err(|halt| Stop::new(halt, &mut self.deadline))
    }

    /// Gives all that is in the buffer to the stream, and empties it.
    pub(super) fn pass_on(&mut self, objects: &mut Objects<'_, D>) -> Result<(), Stop> {
        let len = self.window.len;
        if len > 0 {
            self.give(objects, len, false)?;
            self.window.start += len;
            self.window.len = 0;
        }
        Ok(())
    }

    /// The transfer is over; its stream hears how.
    pub(super) fn close(&mut self, objects: &mut Objects<'_, D>, end: StreamEnd) {
        if D::STREAMS && core::mem::take(&mut self.is_streaming) {
            let address = self.address;
            // An application that has no such stream any more needs no notice.
            let _ = objects.stream(address, |stream, cx| {
                stream.end(cx, address, end);
                Ok(())
            });
        }
        self.reset();
    }

    /// The stream cannot serve this request, or the next segment, before this moment.
    pub(super) fn await_stream(&mut self, until: Deadline, held: Option<Held>) {
        self.set_late(Late::stream(held));
        self.deadline = until;
    }

    /// The stream is asked again.
    pub(super) fn ask_again(&mut self, objects: &mut Objects<'_, D>) -> Option<[u8; 8]> {
        let held = self.late().held;
        self.set_late(Late::BLANK);
        self.await_client(objects.now);
        self.look();
        let (data, dlc) = held?;
        self.handle(objects, &data, dlc)
    }

    /// Something outside the bus changed: a stream that could not go on may be able to.
    pub(crate) fn handle_change(&mut self, objects: &mut Objects<'_, D>) -> Option<[u8; 8]> {
        if !D::STREAMS || !self.late().awaits_stream() {
            return None;
        }
        self.ask_again(objects)
    }
}
