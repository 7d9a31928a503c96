//! A device on a real bus, as a master sees it: an SDO client over a link.

mod slcan;

use std::time::{Duration, Instant};

use od_model::Address;
use od_runtime::{Frame, NodeId};
use od_wire::sdo::{Request, Response};

use crate::Failure;

/// So long an answer may take. Devices that save or calibrate take their time.
const TIMEOUT: Duration = Duration::from_secs(1);

/// A value longer than this is a device gone wild.
const LONGEST: usize = 1 << 20;

/// What carries frames.
pub(crate) trait Link {
    /// Sends a frame.
    fn send(&mut self, frame: &Frame) -> Result<(), Failure>;
    /// The next frame, if one comes before `until`.
    fn receive(&mut self, until: Instant) -> Result<Option<Frame>, Failure>;
}

/// A link by its name on the command line: `slcan:HOST:PORT`.
pub(crate) fn open(name: &str) -> Result<Box<dyn Link>, Failure> {
    match name.split_once(':') {
        Some(("slcan", address)) => Ok(Box::new(slcan::Client::open(address)?)),
        _ => Err(Failure::Usage(format!(
            "`{name}` is no link; write slcan:HOST:PORT, for example slcan:127.0.0.1:2000"
        ))),
    }
}

/// The SDO client of one node.
pub(crate) struct Client<'l> {
    link: &'l mut dyn Link,
    node: NodeId,
}

impl<'l> Client<'l> {
    pub(crate) fn new(link: &'l mut dyn Link, node: NodeId) -> Self {
        Self { link, node }
    }

    /// The bytes of an object, or the code of the abort; a device that says nothing, or
    /// something else, is an error.
    pub(crate) fn upload(&mut self, address: Address) -> Result<Result<Vec<u8>, u32>, Failure> {
        match self.ask(Request::InitiateUpload { address })? {
            Response::InitiateUpload {
                size,
                expedited: Some(data),
                address: answered,
            } if answered == address => {
                let len = size.map_or(4, |size| size.min(4) as usize);
                return Ok(Ok(data[..len].to_vec()));
            }
            Response::InitiateUpload {
                expedited: None, ..
            } => {}
            Response::Abort { code, .. } => return Ok(Err(code)),
            other => return Err(self.odd(address, other)),
        }
        let mut bytes = Vec::new();
        let mut toggle = false;
        while bytes.len() < LONGEST {
            match self.ask(Request::UploadSegment { toggle })? {
                Response::UploadSegment {
                    toggle: answered,
                    data,
                    len,
                    last,
                } if answered == toggle => {
                    bytes.extend_from_slice(&data[..usize::from(len)]);
                    if last {
                        return Ok(Ok(bytes));
                    }
                }
                Response::Abort { code, .. } => return Ok(Err(code)),
                other => return Err(self.odd(address, other)),
            }
            toggle = !toggle;
        }
        Err(Failure::Failed(format!(
            "node {}: {address} has no end after {LONGEST} bytes",
            self.node.raw()
        )))
    }

    fn ask(&mut self, request: Request) -> Result<Response, Failure> {
        // What an earlier, slower answer left behind is not the answer to this.
        while self.link.receive(Instant::now())?.is_some() {}
        self.link
            .send(&Frame::full(self.node.plus(0x600), request.emit()))?;
        let until = Instant::now() + TIMEOUT;
        while let Some(frame) = self.link.receive(until)? {
            if frame.id() == self.node.plus(0x580) && !frame.is_remote() {
                return Ok(Response::parse(frame.bytes()));
            }
        }
        Err(Failure::Failed(format!(
            "node {} does not answer SDO requests within {} s; is it powered, not stopped, and is \
             this its node ID?",
            self.node.raw(),
            TIMEOUT.as_secs()
        )))
    }

    fn odd(&self, address: Address, response: Response) -> Failure {
        Failure::Failed(format!(
            "node {} answers {address} out of turn: {response:?}",
            self.node.raw()
        ))
    }
}
