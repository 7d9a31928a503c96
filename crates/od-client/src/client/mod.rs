//! A client for all nodes of a bus, with queues.

mod events;
mod lane;
mod tasks;

use alloc::collections::VecDeque;
use alloc::vec::Vec;

use od_model::{Address, DataType};
use od_wire::nmt::{Command, State};
use od_wire::{Duration, Frame, Instant, NodeId};

use self::events::Events;
use self::lane::Lane;
use self::tasks::Tasks;
use crate::lss;
use crate::sdo::Options;
use crate::watch::{self, Watch};
use crate::{emcy, nmt};

pub use self::events::{Event, Job};

/// Number of node IDs.
const NODES: usize = 127;

/// A CANopen client for all nodes of a bus.
///
/// Jobs for one node run one after the other; jobs for several nodes run at the same time. Each ends
/// with exactly one event of its own. The crate documentation shows the loop: send the frames of
/// [`poll_transmit`](Self::poll_transmit), take the events of [`poll_event`](Self::poll_event),
/// wait for a frame or [`poll_timeout`](Self::poll_timeout).
/// Input from the bus cannot make memory grow: values have a limit, and at most 256 boot-up
/// messages, states and EMCY messages wait; further ones are dropped and counted.
///
/// ```
/// use od_client::{Client, Instant, NodeId, nmt};
///
/// let mut client = Client::new();
/// client.nmt(Some(NodeId::ONE), nmt::Command::Start);
/// let frame = client.poll_transmit(Instant::ZERO).expect("the NMT command");
/// assert_eq!(frame.to_string(), "000#0101");
/// ```
#[derive(Clone, Debug)]
pub struct Client {
    options: Options,
    jobs: u32,
    /// One lane for each node with a job so far, in the order of their first jobs.
    lanes: Vec<Lane>,
    /// The lane that sends next.
    turn: usize,
    tasks: Tasks,
    watch: Watch<NODES>,
    out: VecDeque<Frame>,
    events: Events,
}

impl Default for Client {
    fn default() -> Self {
        Self::new()
    }
}

impl Client {
    /// A client with default options.
    pub fn new() -> Self {
        Self::with(Options::DEFAULT, lss::Options::DEFAULT)
    }

    /// A client with options for its transfers and its LSS master.
    pub fn with(sdo: Options, lss: lss::Options) -> Self {
        Self {
            options: sdo,
            jobs: 0,
            lanes: Vec::new(),
            turn: 0,
            tasks: Tasks::new(lss),
            watch: Watch::new(),
            out: VecDeque::new(),
            events: Events::new(),
        }
    }

    /// Reads an object; ends with [`Event::Read`].
    pub fn read(&mut self, node: NodeId, object: Address) -> Job {
        self.transfer(node, object, None, self.options)
    }

    /// Like [`read`](Self::read), for an object with a known data type: a response without a size has the
    /// length of the type, and a DOMAIN is read in blocks. A value that is more than 64 bytes longer than a type of
    /// fixed length fails with [`Error::TooLong`](crate::Error::TooLong).
    pub fn read_as(&mut self, node: NodeId, object: Address, data_type: DataType) -> Job {
        const BEYOND: usize = 64;
        let mut options = self.options;
        options.type_size = data_type.size();
        if let Some(size) = options.type_size {
            options.limit = options.limit.min(size + BEYOND);
        }
        options.block_upload |= data_type == DataType::Domain;
        self.transfer(node, object, None, options)
    }

    /// Writes an object; ends with [`Event::Written`].
    pub fn write(&mut self, node: NodeId, object: Address, bytes: &[u8]) -> Job {
        self.transfer(node, object, Some(bytes.to_vec()), self.options)
    }

    /// Runs an LSS service after the waiting ones; ends with [`Event::Lss`].
    ///
    /// To give node IDs to several slaves without one: run fastscan until it finds no other
    /// slave, switch all to waiting state, then for each LSS address switch state selective,
    /// configure node ID, store, and switch to waiting state again.
    pub fn lss(&mut self, task: lss::Task) -> Job {
        let job = self.job();
        self.tasks.push(job, task);
        job
    }

    /// Ends a job without an event. A transfer in progress is aborted. Returns whether the
    /// job existed.
    pub fn cancel(&mut self, now: Instant, job: Job) -> bool {
        let Self { lanes, out, .. } = self;
        lanes.iter_mut().any(|lane| lane.cancel(now, job, out)) || self.tasks.cancel(job)
    }

    /// Sends an NMT command; `None` addresses all nodes.
    pub fn nmt(&mut self, node: Option<NodeId>, command: Command) {
        self.out.push_back(nmt::frame(node, command));
    }

    /// Watches a node: without a heartbeat for this time it is [`Event::Lost`]. The time starts
    /// with the first heartbeat.
    pub fn watch(&mut self, node: NodeId, heartbeat: Duration) {
        // This cannot fail: there is room for each node ID.
        _ = self.watch.add(node, Some(heartbeat));
    }

    /// Ends the monitoring that [`watch`](Self::watch) began. Boot-up messages and states of the node are still reported.
    pub fn unwatch(&mut self, node: NodeId) {
        // This cannot fail, as in `watch`.
        _ = self.watch.add(node, None);
    }

    /// Returns the state in the node's last heartbeat, [`State::Initialising`] after its boot-up
    /// message; `None` if there was none or the node is lost.
    pub fn state(&self, node: NodeId) -> Option<State> {
        self.watch.state(node)
    }

    /// Handles a frame from the bus; frames that are not for a client are ignored.
    pub fn handle_frame(&mut self, now: Instant, frame: &Frame) {
        for lane in &mut self.lanes {
            lane.handle_frame(now, frame, &mut self.out, &mut self.events);
        }
        self.tasks.handle_frame(now, frame, &mut self.events);
        if let Some((node, state)) = watch::parse(frame) {
            if !self.watch.contains(node) {
                // Boot-up messages and states of all nodes are reported. This cannot fail, as in `watch`.
                _ = self.watch.add(node, None);
            }
            let lane = self.lanes.iter_mut().find(|lane| lane.node() == node);
            if let Some(lane) = lane.filter(|_| state == State::Initialising) {
                lane.booted();
            }
            self.watch.handle_frame(now, frame);
            self.report_news();
        }
        if let Some((node, emcy)) = emcy::parse(frame) {
            self.events.report(Event::Emcy(node, emcy));
        }
    }

    /// Handles deadlines that have passed; does nothing before [`poll_timeout`](Self::poll_timeout).
    pub fn handle_timeout(&mut self, now: Instant) {
        for lane in &mut self.lanes {
            lane.handle_timeout(now, &mut self.out, &mut self.events);
        }
        self.tasks.handle_timeout(now, &mut self.events);
        self.watch.handle_timeout(now);
        self.report_news();
    }

    /// Returns the next frame to send; the time for its response starts at `now`. Nodes take
    /// turns.
    pub fn poll_transmit(&mut self, now: Instant) -> Option<Frame> {
        if let Some(frame) = self.out.pop_front() {
            return Some(frame);
        }
        if let Some(frame) = self.tasks.poll_transmit(now, &mut self.events) {
            return Some(frame);
        }
        for _ in 0..self.lanes.len() {
            self.turn = (self.turn + 1) % self.lanes.len();
            let frame = self.lanes.get_mut(self.turn)?.poll_transmit(now);
            if frame.is_some() {
                return frame;
            }
        }
        None
    }

    /// Returns when to call [`handle_timeout`](Self::handle_timeout), if at all.
    pub fn poll_timeout(&self) -> Option<Instant> {
        let lanes = self.lanes.iter().filter_map(Lane::poll_timeout);
        let others = [self.tasks.poll_timeout(), self.watch.poll_timeout()];
        lanes.chain(others.into_iter().flatten()).min()
    }

    /// Returns the oldest event.
    pub fn poll_event(&mut self) -> Option<Event> {
        self.events.pop()
    }

    /// Returns the number of events of the bus that were dropped because 256 waited.
    pub const fn dropped_events(&self) -> u64 {
        self.events.dropped()
    }

    fn job(&mut self) -> Job {
        self.jobs = self.jobs.wrapping_add(1);
        Job::new(self.jobs)
    }

    fn transfer(
        &mut self,
        node: NodeId,
        object: Address,
        bytes: Option<Vec<u8>>,
        options: Options,
    ) -> Job {
        let job = self.job();
        let at = self.lanes.iter().position(|lane| lane.node() == node);
        let at = at.unwrap_or(self.lanes.len());
        if at == self.lanes.len() {
            self.lanes.push(Lane::new(node));
        }
        self.lanes[at].push(job, object, bytes, options);
        job
    }

    fn report_news(&mut self) {
        while let Some(event) = self.watch.poll_event() {
            self.events.report(event.into());
        }
    }
}
