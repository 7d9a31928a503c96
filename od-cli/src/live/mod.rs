//! A device on a real bus, as a master sees it: an SDO client over a link.

mod link;
mod slcan;

use std::time::{Duration, Instant};

use od_client::sdo::{Options, SdoError};
use od_client::{Event, lss};
use od_model::Address;
use od_wire::NodeId;

use crate::failure::Failure;
use link::Link;

/// An answer within 1 s, as devices that save or calibrate take their time; a value of at most
/// 1 MiB, as a longer one is a device gone wild.
const OPTIONS: Options = Options::DEFAULT;

/// A link by its name on the command line: `slcan:HOST:PORT`.
pub(crate) fn open(name: &str) -> Result<Box<dyn Link>, Failure> {
    match name.split_once(':') {
        Some(("slcan", address)) => Ok(Box::new(slcan::Client::open(address)?)),
        _ => Err(Failure::Usage(format!(
            "`{name}` is not a valid link; write `slcan:HOST:PORT`, such as `slcan:127.0.0.1:2000`"
        ))),
    }
}

/// The SDO client of one node.
pub(crate) struct Client<'l> {
    link: &'l mut dyn Link,
    node: NodeId,
    client: od_client::Client,
    /// Origin of the client's time.
    start: Instant,
}

impl<'l> Client<'l> {
    pub(crate) fn new(link: &'l mut dyn Link, node: NodeId) -> Self {
        Self {
            link,
            node,
            client: od_client::Client::with(OPTIONS, lss::Options::DEFAULT),
            start: Instant::now(),
        }
    }

    /// The node ID.
    pub(crate) fn node(&self) -> NodeId {
        self.node
    }

    /// The bytes of an object, or the code of the abort; a device that says nothing, or
    /// something else, is an error.
    pub(crate) fn upload(&mut self, address: Address) -> Result<Result<Vec<u8>, u32>, Failure> {
        self.client.read(self.node, address);
        loop {
            self.send()?;
            match self.client.poll_event() {
                Some(Event::Read(_, result)) => return self.outcome(address, result),
                Some(_) => continue,
                None => {}
            }
            let until = self.client.poll_timeout().map_or(0, |at| at.as_micros());
            match self
                .link
                .receive(self.start + Duration::from_micros(until))?
            {
                Some(frame) => self.client.handle_frame(self.now(), &frame),
                None => self.client.handle_timeout(self.now()),
            }
        }
    }

    fn send(&mut self) -> Result<(), Failure> {
        while let Some(frame) = self.client.poll_transmit(self.now()) {
            // What an earlier, slower answer left behind is not the answer to this.
            while self.link.receive(Instant::now())?.is_some() {}
            self.link.send(&frame)?;
        }
        Ok(())
    }

    fn now(&self) -> od_client::Instant {
        od_client::Instant::ZERO + self.start.elapsed()
    }

    fn outcome(
        &self,
        address: Address,
        result: Result<Vec<u8>, SdoError>,
    ) -> Result<Result<Vec<u8>, u32>, Failure> {
        let node = self.node;
        Err(Failure::Failed(match result {
            Ok(bytes) => return Ok(Ok(bytes)),
            Err(SdoError::Abort(code)) => return Ok(Err(code)),
            Err(SdoError::Silent) => format!(
                "node {node} does not respond to SDO requests within {} s; check its power, its NMT \
                 state (not Stopped) and its node ID",
                OPTIONS.timeout.as_secs()
            ),
            Err(SdoError::OutOfTurn { got, .. }) => {
                format!("node {node}: unexpected SDO response for {address}: {got:?}")
            }
            Err(SdoError::TooLong) => {
                let limit = OPTIONS.limit;
                format!("node {node}: {address} is longer than {limit} bytes")
            }
            Err(other) => format!("node {node}: {address}: {other}"),
        }))
    }
}
