//! The SDO transfers with one node: one at a time, the others wait.

use alloc::collections::VecDeque;
use alloc::vec::Vec;

use od_model::Address;
use od_wire::{Frame, Instant, NodeId};

use super::events::{Event, Events, Job};
use crate::AbortCode;
use crate::error::Error;
use crate::sdo::{Channel, Download, Options, Upload};

/// A transfer in progress.
#[derive(Clone, Debug)]
enum Transfer {
    Upload(Upload<Vec<u8>>),
    Download(Download<Vec<u8>>),
}

/// A waiting job; it writes `bytes` if there are some.
#[derive(Clone, Debug)]
struct Waiting {
    job: Job,
    object: Address,
    bytes: Option<Vec<u8>>,
    options: Options,
}

/// The jobs of one node.
#[derive(Clone, Debug)]
pub(super) struct Lane {
    node: NodeId,
    active: Option<(Job, Transfer)>,
    waiting: VecDeque<Waiting>,
    /// The node does not support block transfers; they are not tried again before its next boot-up.
    has_no_block: bool,
    /// The node has booted since the transfer in progress began.
    has_booted: bool,
}

impl Lane {
    pub(super) const fn new(node: NodeId) -> Self {
        Self {
            node,
            active: None,
            waiting: VecDeque::new(),
            has_no_block: false,
            has_booted: false,
        }
    }

    pub(super) const fn node(&self) -> NodeId {
        self.node
    }

    /// Notes a restart of the node, which may now be another device.
    pub(super) fn booted(&mut self) {
        self.has_no_block = false;
        self.has_booted = true;
    }

    /// Adds a waiting job: it writes `bytes`, or reads.
    pub(super) fn push(
        &mut self,
        job: Job,
        object: Address,
        bytes: Option<Vec<u8>>,
        options: Options,
    ) {
        self.waiting.push_back(Waiting {
            job,
            object,
            bytes,
            options,
        });
        self.begin();
    }

    /// Returns whether the job was here.
    pub(super) fn cancel(&mut self, now: Instant, job: Job, out: &mut VecDeque<Frame>) -> bool {
        if let Some((active, transfer)) = &mut self.active
            && *active == job
        {
            match transfer {
                Transfer::Upload(upload) => upload.cancel(),
                Transfer::Download(download) => download.cancel(),
            }
            while let Some(frame) = transfer.poll_transmit(now) {
                out.push_back(frame);
            }
            self.active = None;
            self.begin();
            return true;
        }
        let at = self.waiting.iter().position(|waiting| waiting.job == job);
        at.and_then(|at| self.waiting.remove(at)).is_some()
    }

    pub(super) fn handle_frame(
        &mut self,
        now: Instant,
        frame: &Frame,
        out: &mut VecDeque<Frame>,
        events: &mut Events,
    ) {
        match &mut self.active {
            Some((_, Transfer::Upload(upload))) => upload.handle_frame(now, frame),
            Some((_, Transfer::Download(download))) => download.handle_frame(now, frame),
            None => return,
        }
        self.end_if_complete(now, out, events);
    }

    pub(super) fn handle_timeout(
        &mut self,
        now: Instant,
        out: &mut VecDeque<Frame>,
        events: &mut Events,
    ) {
        match &mut self.active {
            Some((_, Transfer::Upload(upload))) => upload.handle_timeout(now),
            Some((_, Transfer::Download(download))) => download.handle_timeout(now),
            None => return,
        }
        self.end_if_complete(now, out, events);
    }

    pub(super) fn poll_transmit(&mut self, now: Instant) -> Option<Frame> {
        let (_, transfer) = self.active.as_mut()?;
        transfer.poll_transmit(now)
    }

    pub(super) fn poll_timeout(&self) -> Option<Instant> {
        match &self.active {
            Some((_, Transfer::Upload(upload))) => upload.poll_timeout(),
            Some((_, Transfer::Download(download))) => download.poll_timeout(),
            None => None,
        }
    }

    /// Begins the next job if none is in progress.
    fn begin(&mut self) {
        if self.active.is_some() {
            return;
        }
        let Some(next) = self.waiting.pop_front() else {
            return;
        };
        let mut options = next.options;
        if self.has_no_block {
            options.block_from = None;
            options.block_upload = false;
        }
        let (channel, object) = (Channel::of(self.node), next.object);
        let transfer = match next.bytes {
            Some(bytes) => Transfer::Download(Download::new(channel, object, bytes, options)),
            None => Transfer::Upload(Upload::new(channel, object, Vec::new(), options)),
        };
        self.active = Some((next.job, transfer));
        self.has_booted = false;
    }

    /// Ends a completed transfer. Its remaining frames are sent before those of the next
    /// one.
    fn end_if_complete(&mut self, now: Instant, out: &mut VecDeque<Frame>, events: &mut Events) {
        let Some((job, transfer)) = &mut self.active else {
            return;
        };
        let Some(outcome) = transfer.outcome() else {
            return;
        };
        while let Some(frame) = transfer.poll_transmit(now) {
            out.push_back(frame);
        }
        let job = *job;
        let outcome = outcome.map_err(|error| match error {
            error if self.has_booted && is_lost(error) => Error::Booted,
            error => error,
        });
        match self.active.take() {
            Some((_, Transfer::Upload(upload))) => {
                self.has_no_block |= upload.refused_block();
                events.end(Event::Read(job, outcome.map(|()| upload.into_buffer())));
            }
            Some((_, Transfer::Download(download))) => {
                self.has_no_block |= download.refused_block();
                events.end(Event::Written(job, outcome));
            }
            None => {}
        }
        self.begin();
    }
}

/// Returns whether a server without this transfer causes this error: it does not respond, or not to this transfer.
fn is_lost(error: Error) -> bool {
    let unknown = [AbortCode::ToggleBit, AbortCode::InvalidCommand].map(AbortCode::code);
    match error {
        Error::Abort(code) => unknown.contains(&code),
        Error::Silent | Error::OutOfTurn { .. } | Error::NoProgress => true,
        _ => false,
    }
}

impl Transfer {
    fn poll_transmit(&mut self, now: Instant) -> Option<Frame> {
        match self {
            Self::Upload(upload) => upload.poll_transmit(now),
            Self::Download(download) => download.poll_transmit(now),
        }
    }

    const fn outcome(&self) -> Option<Result<(), Error>> {
        match self {
            Self::Upload(upload) => upload.outcome(),
            Self::Download(download) => download.outcome(),
        }
    }
}
