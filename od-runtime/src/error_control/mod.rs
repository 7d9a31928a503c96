//! Error control (CiA 301, chapter 7.2.8): heartbeat producer and consumer, node and life guarding.
//!
//! [`Monitor`] watches the other side (a master that guards, nodes that send
//! heartbeats) and says when it is lost and when it is back; what follows from
//! that is the node's business.

mod consumer;
mod guarding;
mod heartbeat;

pub(crate) use heartbeat::Producer;

use crate::deadline::Deadline;
use crate::device::Device;
use crate::profile::Profile;
use crate::rooms::{Blank, Room, Rooms};
use crate::store::Store;
use od_wire::nmt::State;
use od_wire::{CanId, Instant, NodeId};

/// Whether node guarding is active instead of heartbeat.
///
/// CiA 301: guarding while 1017h is 0. A family may have a switch for it instead, which
/// leaves nothing of the heartbeat, neither producer nor consumer.
pub(crate) fn guards<D: Device>(store: &Store<'_>, profile: &Profile) -> bool {
    match profile.guarding_switch {
        Some((index, mask)) => store.word(index, 0, 0) & mask != 0,
        None => D::GUARDING && store.word(0x1017, 0, 0) == 0 && store.try_word(0x100C, 0).is_some(),
    }
}

/// Whether the object at this index configures the monitor.
pub(crate) fn is_configuration(index: u16, profile: &Profile) -> bool {
    matches!(index, 0x100C | 0x100D | 0x1016 | 0x1017)
        || profile
            .guarding_switch
            .is_some_and(|(switch, _)| switch == index)
}

/// Monitor of the other side: life guarding and heartbeat consumer.
#[derive(Clone, Debug)]
pub(crate) struct Monitor<R: Rooms> {
    guards: R::Guards<guarding::Guard>,
    consumer: consumer::Consumer<R>,
    /// Result of the last [`poll`](Self::poll).
    lost: bool,
}

impl<R: Rooms> Monitor<R> {
    pub(crate) const fn new() -> Self {
        Self {
            guards: Room::BLANK,
            consumer: consumer::Consumer::new(),
            lost: false,
        }
    }

    /// Boot-up: no node is watched yet, and none is lost.
    pub(crate) fn reset(&mut self) {
        self.guards.all_mut().fill(Blank::BLANK);
        self.consumer.reset();
        self.lost = false;
    }

    /// Reads 100Ch, 100Dh and 1016h again.
    pub(crate) fn configure<D: Device>(&mut self, store: &Store<'_>, profile: &Profile) {
        let guards = guards::<D>(store, profile);
        for guard in self.guards.all_mut() {
            guard.configure(store, guards);
        }
        if D::CONSUMER {
            let switched_off = profile.guarding_switch.is_some() && guards;
            self.consumer.configure(store, !switched_off);
        }
    }

    /// A master guards this node: the byte of the answer, if guarding is in force.
    pub(crate) fn guard(&mut self, state: State, now: Instant) -> Option<u8> {
        self.guards.all_mut().first_mut()?.request(state, now)
    }

    /// A heartbeat, or boot-up message, of another node.
    pub(crate) fn heartbeat(&mut self, node: u8, now: Instant) {
        self.consumer.heartbeat(node, now);
    }

    /// CAN-IDs of the heartbeats that are watched.
    pub(crate) fn watched(&self) -> impl Iterator<Item = CanId> + '_ {
        let nodes = self.consumer.nodes().filter_map(NodeId::new);
        nodes.map(|node| node.plus(0x700))
    }

    /// Time has passed.
    #[inline]
    pub(crate) fn handle_timeout<D: Device>(&mut self, now: Instant) {
        for guard in self.guards.all_mut() {
            guard.handle_timeout(now);
        }
        if D::CONSUMER {
            self.consumer.handle_timeout(now);
        }
    }

    /// `Some(true)` when a node was lost and none before, `Some(false)` when
    /// everybody is back.
    #[inline]
    pub(crate) fn poll<D: Device>(&mut self) -> Option<bool> {
        let mut guards = self.guards.all().iter();
        let lost = guards.any(guarding::Guard::is_lost) || D::CONSUMER && self.consumer.is_lost();
        let changed = lost != self.lost;
        self.lost = lost;
        changed.then_some(lost)
    }

    /// Whether a node or the master is lost.
    pub(crate) const fn is_lost(&self) -> bool {
        self.lost
    }

    /// Time when a node is lost unless it is heard before.
    #[inline]
    pub(crate) fn deadline<D: Device>(&self) -> Deadline {
        let guards = self.guards.all().iter().map(guarding::Guard::deadline);
        let consumer = D::CONSUMER.then(|| self.consumer.deadline());
        guards.chain(consumer).fold(Deadline::NEVER, Deadline::or)
    }
}
