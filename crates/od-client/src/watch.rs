//! Boot-up and heartbeat consumer (CiA 301, 7.2.8.3.2.2 and 7.2.8.3.3).

use core::fmt;

use od_wire::nmt::State;
use od_wire::{Duration, Frame, Instant, NodeId};

/// Event of a node.
///
/// ```
/// use od_client::watch::{Event, Watch};
/// use od_client::{Frame, Instant, NodeId};
///
/// let mut watch = Watch::<1>::new();
/// watch.add(NodeId::ONE, None).expect("there is room for one");
/// watch.handle_frame(Instant::ZERO, &Frame::standard(0x701, &[0]));
/// assert_eq!(watch.poll_event(), Some(Event::BootUp(NodeId::ONE)));
/// ```
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug)]
#[non_exhaustive]
pub enum Event {
    /// A heartbeat after the node was lost.
    Back(NodeId),
    /// The boot-up message.
    BootUp(NodeId),
    /// A heartbeat with a changed state.
    State(NodeId, State),
    /// No heartbeat came in time.
    Lost(NodeId),
}

/// The table of watched nodes has no free place.
///
/// ```
/// use od_client::NodeId;
/// use od_client::watch::{Full, Watch};
///
/// let mut watch = Watch::<0>::new();
/// assert_eq!(watch.add(NodeId::ONE, None), Err(Full));
/// ```
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug)]
pub struct Full;

impl fmt::Display for Full {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("no more nodes can be watched")
    }
}

impl core::error::Error for Full {}

/// State of one node.
#[derive(Clone, Copy, Debug)]
struct Slot {
    node: NodeId,
    heartbeat: Option<Duration>,
    /// It is set from the first heartbeat on.
    deadline: Option<Instant>,
    state: Option<State>,
    is_lost: bool,
    /// The events that the caller has not taken yet.
    news: News,
}

/// At most one event of each kind waits, so a busy bus does not fill memory.
#[derive(Clone, Copy, Default, Debug)]
struct News {
    back: bool,
    boot_up: bool,
    state: Option<State>,
    lost: bool,
}

impl Slot {
    fn heartbeat(&mut self, now: Instant, state: State) {
        self.deadline = self.heartbeat.map(|heartbeat| now + heartbeat);
        if core::mem::take(&mut self.is_lost) {
            self.news.back = true;
        }
        if state == State::Initialising {
            self.news.boot_up = true;
            self.news.state = None;
        } else if self.state != Some(state) {
            self.news.state = Some(state);
        }
        self.state = Some(state);
    }

    fn handle_timeout(&mut self, now: Instant) {
        if self.deadline.is_some_and(|at| at <= now) {
            self.deadline = None;
            self.is_lost = true;
            self.news.lost = true;
        }
    }

    fn poll(&mut self) -> Option<Event> {
        let (node, news) = (self.node, &mut self.news);
        if core::mem::take(&mut news.lost) {
            return Some(Event::Lost(node));
        }
        if core::mem::take(&mut news.back) {
            return Some(Event::Back(node));
        }
        if core::mem::take(&mut news.boot_up) {
            return Some(Event::BootUp(node));
        }
        news.state.take().map(|state| Event::State(node, state))
    }
}

/// Watches up to `N` nodes.
///
/// Call [`poll_event`](Self::poll_event) after each input: of several events of one
/// kind and node only the newest is kept.
///
/// ```
/// use od_client::watch::{Event, Watch};
/// use od_client::{Duration, Frame, Instant, NodeId};
///
/// let mut watch = Watch::<1>::new();
/// let heartbeat = Some(Duration::from_millis(100));
/// watch.add(NodeId::ONE, heartbeat).expect("there is room for one");
/// watch.handle_frame(Instant::ZERO, &Frame::standard(0x701, &[5]));
/// watch.poll_event();
/// let late = watch.poll_timeout().expect("a heartbeat is due");
/// watch.handle_timeout(late);
/// assert_eq!(watch.poll_event(), Some(Event::Lost(NodeId::ONE)));
/// ```
#[derive(Clone, Debug)]
pub struct Watch<const N: usize> {
    slots: [Option<Slot>; N],
}

impl<const N: usize> Default for Watch<N> {
    fn default() -> Self {
        Self::new()
    }
}

impl<const N: usize> Watch<N> {
    /// Watches no node at first.
    pub const fn new() -> Self {
        Self { slots: [None; N] }
    }

    /// Watches a node from now on, or changes its heartbeat consumer time.
    ///
    /// `heartbeat`: longest time between two heartbeats, counted from the first one; `None`:
    /// boot-up and states are reported, and the node is never lost.
    ///
    /// # Errors
    /// [`Full`] if `N` other nodes are watched.
    pub fn add(&mut self, node: NodeId, heartbeat: Option<Duration>) -> Result<(), Full> {
        if let Some(slot) = self.slot(node) {
            slot.heartbeat = heartbeat;
            slot.deadline = None;
            slot.is_lost = false;
            return Ok(());
        }
        let free = self.slots.iter_mut().find(|slot| slot.is_none());
        *free.ok_or(Full)? = Some(Slot {
            node,
            heartbeat,
            deadline: None,
            state: None,
            is_lost: false,
            news: News::default(),
        });
        Ok(())
    }

    /// Stops watching a node.
    pub fn remove(&mut self, node: NodeId) {
        for slot in &mut self.slots {
            if slot.is_some_and(|slot| slot.node == node) {
                *slot = None;
            }
        }
    }

    /// Returns whether the node is watched.
    pub fn contains(&self, node: NodeId) -> bool {
        let mut nodes = self.slots.iter().flatten().map(|slot| slot.node);
        nodes.any(|watched| watched == node)
    }

    /// Returns the state in the node's last heartbeat, [`State::Initialising`] after its boot-up
    /// message; `None` if there was none or the node is lost.
    pub fn state(&self, node: NodeId) -> Option<State> {
        let slot = self.slots.iter().flatten().find(|slot| slot.node == node)?;
        slot.state.filter(|_| !slot.is_lost)
    }

    /// Handles a frame from the bus. Frames other than boot-up messages and heartbeats of watched nodes are ignored.
    pub fn handle_frame(&mut self, now: Instant, frame: &Frame) {
        if let Some((node, state)) = parse(frame)
            && let Some(slot) = self.slot(node)
        {
            slot.heartbeat(now, state);
        }
    }

    /// Reports nodes whose heartbeat is overdue.
    pub fn handle_timeout(&mut self, now: Instant) {
        for slot in self.slots.iter_mut().flatten() {
            slot.handle_timeout(now);
        }
    }

    /// Returns when to call [`handle_timeout`](Self::handle_timeout), if at all.
    pub fn poll_timeout(&self) -> Option<Instant> {
        let deadlines = self.slots.iter().flatten().filter_map(|slot| slot.deadline);
        deadlines.min()
    }

    /// Returns the next event.
    pub fn poll_event(&mut self) -> Option<Event> {
        self.slots.iter_mut().flatten().find_map(Slot::poll)
    }

    fn slot(&mut self, node: NodeId) -> Option<&mut Slot> {
        self.slots
            .iter_mut()
            .flatten()
            .find(|slot| slot.node == node)
    }
}

/// Returns node and state of a boot-up message, a heartbeat or the response to a node guarding
/// request (700h plus the node ID); `None` for any other frame.
pub fn parse(frame: &Frame) -> Option<(NodeId, State)> {
    let id = frame.id().as_standard()?.checked_sub(0x700)?;
    let node = NodeId::new(u8::try_from(id).ok()?)?;
    let &[byte] = frame.data() else { return None };
    // Bit 7 is the toggle bit of node guarding.
    let state = State::from_code(byte & 0x7F)?;
    (byte == 0 || state != State::Initialising).then_some((node, state))
}
