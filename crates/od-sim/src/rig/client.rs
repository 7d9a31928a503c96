//! The SDO client of a rig: a station on the bus like any other master.

use std::collections::VecDeque;
use std::prelude::v1::*;

use od_client::sdo::Options;
use od_client::{Client, Event, Job, lss};
use od_model::Address;
use od_wire::{Duration, Frame, Instant, NodeId};

use crate::sdo::is_timeout;

/// A finished transfer.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct Outcome {
    /// The number that [`Rig::read`](super::Rig::read) or [`write`](super::Rig::write) returned.
    pub job: u32,
    /// The node.
    pub node: NodeId,
    /// The object.
    pub address: Address,
    /// The value of a read, empty after a write; or the error.
    pub result: Result<Vec<u8>, od_client::Error>,
}

impl Outcome {
    fn of(
        (_, job, node, address): (Job, u32, NodeId, Address),
        result: Result<Vec<u8>, od_client::Error>,
    ) -> Self {
        Self {
            job,
            node,
            address,
            result,
        }
    }
}

/// The client, its frames, and its open transfers.
#[derive(Debug)]
pub(super) struct SdoClient {
    client: Client,
    requests: VecDeque<Frame>,
    /// Open transfers, with their numbers.
    asked: Vec<(Job, u32, NodeId, Address)>,
    count: u32,
}

impl Default for SdoClient {
    fn default() -> Self {
        let mut options = Options::SEGMENTED;
        options.timeout = Duration::from_millis(500);
        Self {
            client: Client::with(options, lss::Options::DEFAULT),
            requests: VecDeque::new(),
            asked: Vec::new(),
            count: 0,
        }
    }
}

impl SdoClient {
    /// Starts a transfer; with bytes it is a write.
    pub(super) fn ask(
        &mut self,
        now: Instant,
        node: NodeId,
        address: Address,
        bytes: Option<&[u8]>,
    ) -> u32 {
        let job = match bytes {
            Some(bytes) => self.client.write(node, address, bytes),
            None => self.client.read(node, address),
        };
        self.count += 1;
        self.asked.push((job, self.count, node, address));
        self.take(now);
        self.count
    }

    /// Handles a frame of a device.
    pub(super) fn handle_frame(&mut self, now: Instant, frame: &Frame) {
        if !self.asked.is_empty() {
            self.client.handle_frame(now, frame);
            self.take(now);
        }
    }

    pub(super) fn handle_timeout(&mut self, now: Instant) {
        self.client.handle_timeout(now);
        self.take(now);
    }

    /// Next deadline of the client; `None` without open transfers, since a search through all nodes would take a third
    /// of the time of a simulation.
    pub(super) fn poll_timeout(&self) -> Option<Instant> {
        if self.asked.is_empty() {
            None
        } else {
            self.client.poll_timeout()
        }
    }

    /// Returns whether a transfer is open.
    pub(super) fn is_busy(&self) -> bool {
        !self.asked.is_empty() || self.has_request()
    }

    /// Returns whether a frame waits to be sent.
    pub(super) fn has_request(&self) -> bool {
        !self.requests.is_empty()
    }

    /// The next frame to send.
    pub(super) fn request(&mut self) -> Option<Frame> {
        self.requests.pop_front()
    }

    /// The next finished transfer.
    pub(super) fn poll(&mut self) -> Option<Outcome> {
        loop {
            let (job, result) = match self.client.poll_event()? {
                Event::Read(job, result) => (job, result),
                Event::Written(job, result) => (job, result.map(|()| Vec::new())),
                _ => continue,
            };
            if let Some(at) = self.asked.iter().position(|(asked, ..)| *asked == job) {
                return Some(Outcome::of(self.asked.remove(at), result));
            }
        }
    }

    /// Ends all open transfers, because the bus was replaced and no node will respond.
    pub(super) fn give_up(&mut self) -> Vec<Outcome> {
        let count = self.count;
        let Self { asked, .. } = std::mem::take(self);
        self.count = count;
        let silent = |asked| Outcome::of(asked, Err(od_client::Error::Silent));
        asked.into_iter().map(silent).collect()
    }

    /// Collects the frames of the client, except aborts to a node that did not respond.
    fn take(&mut self, now: Instant) {
        while let Some(frame) = self.client.poll_transmit(now) {
            if !is_timeout(&frame) {
                self.requests.push_back(frame);
            }
        }
    }
}
