//! Describes SDO requests, responses and aborts (CiA 301, chapter 7.2.4).

use std::format;
use std::prelude::v1::*;

use od_model::{Address, values};
use od_runtime::Frame;
use od_wire::AbortReason;
use od_wire::sdo::{Request, Response, expedited_len};

use super::description::{Service, Words, bytes};
use super::value;
use crate::device::VirtualDevice;
use crate::sdo::{Message, Observer};

/// State of a transfer after the frames so far.
#[derive(Clone, Debug, Default)]
pub(super) struct Transfer {
    observer: Observer,
    /// The bytes of its segments.
    data: Vec<u8>,
}

/// Longest value that is assembled from segments.
const KEPT: usize = 4096;

struct Explainer<'e> {
    transfer: &'e mut Transfer,
    device: Option<&'e VirtualDevice>,
    service: Service,
    node: u8,
}

pub(super) fn explain(
    transfer: &mut Transfer,
    device: Option<&VirtualDevice>,
    is_response: bool,
    node: u8,
    frame: &Frame,
) -> Words {
    let service = if is_response {
        Service::SdoResponse
    } else {
        Service::SdoRequest
    };
    let mut explainer = Explainer {
        transfer,
        device,
        service,
        node,
    };
    if frame.is_remote() || frame.dlc() == 0 {
        return explainer.words("not an SDO message");
    }
    let message = explainer.transfer.observer.read(is_response, frame);
    let is_in_segments = matches!(
        message,
        None | Some(
            Message::Request(Request::DownloadSegment(_) | Request::UploadSegment { .. })
                | Message::Response(Response::UploadSegment(_) | Response::DownloadSegment { .. })
        )
    );
    if !is_in_segments {
        explainer.transfer.data.clear();
    }
    let words = match message {
        Some(Message::Request(request)) => explainer.request(request, frame),
        Some(Message::Response(response)) => explainer.response(response, frame),
        Some(Message::Segment {
            number, is_last, ..
        }) => {
            let which = if is_last { "last segment" } else { "segment" };
            let name = explainer.current();
            explainer.words(format!("{which} {number} of a block of {name}"))
        }
        None => explainer.words(""),
    };
    if frame.dlc() == 8 {
        return words;
    }
    let before = if words.text.is_empty() { "" } else { ": " };
    let count = bytes(frame.dlc().into());
    words
        .remark(&format!("{before}{count}, but an SDO message has 8"))
        .error()
}

impl Explainer<'_> {
    fn words(&self, text: impl Into<String>) -> Words {
        let words = Words::new(self.service, Some(self.node), text);
        match self.transfer.observer.object {
            Some(address) => words.about(address),
            None => words,
        }
    }

    fn name(&self, address: Address) -> String {
        match self.device {
            Some(device) => values::label(device.dictionary(), address),
            None => address.to_string(),
        }
    }

    fn type_size(&self, address: Address) -> Option<usize> {
        let entry = self.device?.dictionary().find(address).ok()?;
        entry.data_type.size()
    }

    fn current(&self) -> String {
        self.transfer
            .observer
            .object
            .map_or_else(|| "a transfer".into(), |address| self.name(address))
    }

    fn show(&self, data: &[u8]) -> String {
        // The signatures of 1010h and 1011h are ASCII words.
        let object = self.transfer.observer.object;
        if matches!(object.map(|address| address.index), Some(0x1010 | 0x1011))
            && data.iter().all(u8::is_ascii_lowercase)
        {
            return format!("\"{}\"", String::from_utf8_lossy(data));
        }
        let find = |address| {
            let device = self.device?;
            Some((device, device.dictionary().find(address).ok()?))
        };
        match object.and_then(find) {
            Some((device, entry)) => value::show(device, entry.address, entry.data_type, data),
            None => values::hex(data),
        }
    }

    fn request(&mut self, request: Request, frame: &Frame) -> Words {
        match request {
            Request::InitiateUpload { address } => {
                self.words(format!("read {}", self.name(address)))
            }
            Request::InitiateDownload {
                address,
                size,
                expedited,
            } => {
                let name = self.name(address);
                match (expedited, size) {
                    (Some(data), size) => {
                        let sent = frame.data().len().saturating_sub(4);
                        let len = size.map_or(sent, |size| size as usize).min(4);
                        let own = self.type_size(address);
                        let len = own.map_or(len, |own| own.min(len));
                        let text = format!("write {name} = {}", self.show(&data[..len]));
                        self.words(text)
                    }
                    (None, Some(size)) => self.words(format!(
                        "write {name}, {} in segments",
                        bytes(size as usize)
                    )),
                    (None, None) => self.words(format!("write {name} in segments")),
                }
            }
            Request::DownloadSegment(segment) => self.segment(segment.bytes(), segment.last),
            Request::UploadSegment { .. } => {
                self.words(format!("next segment of {}", self.current()))
            }
            Request::Abort { address, code } => self.abort(address, code),
            Request::InitiateBlockUpload {
                address,
                block_size,
                ..
            } => self.words(format!(
                "read {} in blocks of {block_size}",
                self.name(address)
            )),
            Request::StartBlockUpload => self.words(format!("start blocks of {}", self.current())),
            Request::BlockUploadResponse { ack, .. } => self.block_taken(ack),
            Request::EndBlockUpload => self.words(format!("{} is complete", self.current())),
            Request::InitiateBlockDownload { address, size, .. } => {
                let size =
                    size.map_or_else(String::new, |size| format!(", {}", bytes(size as usize)));
                self.words(format!("write {} in blocks{size}", self.name(address)))
            }
            Request::EndBlockDownload { crc, .. } => {
                self.words(format!("{} is complete, CRC {crc:04X}h", self.current()))
            }
            Request::Unknown => self
                .words(format!("unknown command {:02X}h", frame.bytes()[0]))
                .error(),
        }
    }

    fn response(&mut self, response: Response, frame: &Frame) -> Words {
        match response {
            Response::InitiateUpload {
                address,
                size,
                expedited,
            } => {
                let name = self.name(address);
                match (expedited, size) {
                    (Some(data), size) => {
                        let len = expedited_len(size, self.type_size(address));
                        self.words(format!("{name} is {}", self.show(&data[..len])))
                    }
                    (None, Some(size)) => {
                        self.words(format!("{name} has {}", bytes(size as usize)))
                    }
                    (None, None) => self.words(format!("{name} follows in segments")),
                }
            }
            Response::InitiateDownload { address } => {
                self.words(format!("write of {} confirmed", self.name(address)))
            }
            Response::UploadSegment(segment) => self.segment(segment.bytes(), segment.last),
            Response::DownloadSegment { .. } => {
                self.words(format!("segment of {} confirmed", self.current()))
            }
            Response::Abort { address, code } => self.abort(address, code),
            Response::InitiateBlockDownload {
                address,
                block_size,
                ..
            } => {
                let name = self.name(address);
                self.words(format!(
                    "write of {name} accepted in blocks of {block_size}"
                ))
            }
            Response::BlockDownloadResponse { ack, .. } => self.block_taken(ack),
            Response::EndBlockDownload => {
                self.words(format!("write of {} confirmed", self.current()))
            }
            Response::InitiateBlockUpload { address, size, .. } => {
                let size = size.map_or_else(|| "data".into(), |size| bytes(size as usize));
                self.words(format!("{} has {size}, in blocks", self.name(address)))
            }
            Response::EndBlockUpload { crc, .. } => {
                self.words(format!("end of {}, CRC {crc:04X}h", self.current()))
            }
            Response::Unknown => self
                .words(format!("unknown command {:02X}h", frame.bytes()[0]))
                .error(),
        }
    }

    fn segment(&mut self, data: &[u8], last: bool) -> Words {
        let room = KEPT
            .saturating_sub(self.transfer.data.len())
            .min(data.len());
        self.transfer.data.extend_from_slice(&data[..room]);
        if !last {
            return self.words(format!(
                "segment of {}, {}",
                self.current(),
                bytes(data.len())
            ));
        }
        let whole = core::mem::take(&mut self.transfer.data);
        self.words(format!(
            "last segment of {}: {}",
            self.current(),
            self.show(&whole)
        ))
    }

    fn block_taken(&self, ack: u8) -> Words {
        let name = self.current();
        self.words(format!("block of {name} confirmed up to segment {ack}"))
    }

    fn abort(&mut self, address: Address, code: u32) -> Words {
        let why = AbortReason(code);
        let reason = why.text();
        let name = self.name(address);
        let mut words = self.words(format!("{name} aborted: {why}")).error();
        words.address = Some(address);
        words.reason_first = Some(format!("{reason} ({code:08X}h): {name} aborted"));
        words
    }
}
