//! Events of the client, for its host.

use alloc::collections::VecDeque;
use alloc::vec::Vec;

use od_wire::NodeId;
use od_wire::nmt::State;

use crate::emcy::Emcy;
use crate::error::Error;
use crate::lss::Answer;
use crate::watch;

/// Limit of waiting events of the bus.
const NEWS: usize = 256;

/// Job of the host: a number that is repeated in the event of its end.
///
/// ```
/// use od_client::{Client, NodeId};
/// use od_model::Address;
///
/// let mut client = Client::new();
/// let first = client.read(NodeId::ONE, Address::new(0x1000, 0));
/// let second = client.read(NodeId::ONE, Address::new(0x1018, 1));
/// assert!(first != second);
/// ```
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Debug)]
pub struct Job(u32);

impl Job {
    pub(super) const fn new(number: u32) -> Self {
        Self(number)
    }

    /// The number: 1 for the first job of a client, then counting up.
    pub const fn number(self) -> u32 {
        self.0
    }
}

/// End of a job, or an event of the bus.
///
/// ```
/// use od_client::{Client, Event, Frame, Instant, NodeId};
///
/// let mut client = Client::new();
/// client.handle_frame(Instant::ZERO, &Frame::standard(0x705, &[0]));
/// let node = NodeId::new(5).expect("1 to 127");
/// assert_eq!(client.poll_event(), Some(Event::BootUp(node)));
/// ```
#[derive(Clone, PartialEq, Eq, Debug)]
#[non_exhaustive]
pub enum Event {
    /// The end of [`Client::read`](crate::Client::read), with the value.
    Read(Job, Result<Vec<u8>, Error>),
    /// The end of [`Client::write`](crate::Client::write).
    Written(Job, Result<(), Error>),
    /// The end of [`Client::lss`](crate::Client::lss).
    Lss(Job, Result<Answer, Error>),
    /// A boot-up message, of any node.
    BootUp(NodeId),
    /// The state in a heartbeat of any node, if it changed.
    State(NodeId, State),
    /// A watched node sent no heartbeat in time.
    Lost(NodeId),
    /// A heartbeat of a lost node.
    Back(NodeId),
    /// An EMCY message, of any node.
    Emcy(NodeId, Emcy),
}

impl From<watch::Event> for Event {
    fn from(event: watch::Event) -> Self {
        match event {
            watch::Event::Back(node) => Self::Back(node),
            watch::Event::BootUp(node) => Self::BootUp(node),
            watch::Event::State(node, state) => Self::State(node, state),
            watch::Event::Lost(node) => Self::Lost(node),
        }
    }
}

/// Events for the host. Ends of jobs are never dropped: there are as many as the
/// host began.
#[derive(Clone, Debug)]
pub(super) struct Events {
    waiting: VecDeque<Event>,
    /// Number of events of the bus among them.
    news: usize,
    dropped: u64,
}

impl Events {
    pub(super) const fn new() -> Self {
        Self {
            waiting: VecDeque::new(),
            news: 0,
            dropped: 0,
        }
    }

    /// Adds the end of a job.
    pub(super) fn end(&mut self, event: Event) {
        self.waiting.push_back(event);
    }

    /// Adds an event of the bus.
    pub(super) fn report(&mut self, event: Event) {
        if self.news < NEWS {
            self.news += 1;
            self.waiting.push_back(event);
        } else {
            self.dropped += 1;
        }
    }

    pub(super) fn pop(&mut self) -> Option<Event> {
        let event = self.waiting.pop_front()?;
        let is_end = matches!(event, Event::Read(..) | Event::Written(..) | Event::Lss(..));
        if !is_end {
            self.news -= 1;
        }
        Some(event)
    }

    pub(super) const fn dropped(&self) -> u64 {
        self.dropped
    }
}
