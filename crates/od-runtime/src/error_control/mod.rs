//! Error control (CiA 301, chapter 7.2.8): heartbeat producer and consumer, node and life guarding.
//!
//! [`Monitor`] watches other nodes (a master that guards, nodes that send heartbeats) and reports
//! when one is lost and when all have returned. The node decides how to react.

mod consumer;
mod guarding;
mod heartbeat;

pub use consumer::Watch;
pub use guarding::Guard;
pub(crate) use heartbeat::Producer;

use crate::blank::Blank;
use crate::deadline::Deadline;
use crate::profile::Profile;
use crate::services::Services;
use crate::store::Store;
use od_wire::Instant;
use od_wire::nmt::State;

/// Returns whether node guarding is active instead of heartbeat.
///
/// In CiA 301 guarding is active while 1017h is 0. A family may have a switch instead, which
/// disables both heartbeat producer and consumer.
pub(crate) fn guards<D: Services>(store: &Store<'_>, profile: &Profile) -> bool {
    match profile.guarding_switch {
        Some((index, mask)) => store.word(index, 0, 0) & mask != 0,
        None => D::GUARDING && store.word(0x1017, 0, 0) == 0 && store.try_word(0x100C, 0).is_some(),
    }
}

/// Returns whether the object at this index switches between heartbeat and node guarding.
pub(crate) fn is_switch(index: u16, profile: &Profile) -> bool {
    let switch = profile.guarding_switch;
    switch.is_some_and(|(switch, _)| switch == index)
}

/// Returns whether the object at this index configures the monitor.
pub(crate) fn is_configuration(index: u16, profile: &Profile) -> bool {
    matches!(index, 0x100C | 0x100D | 0x1016 | 0x1017) || is_switch(index, profile)
}

/// Monitor of other nodes: life guarding and heartbeat consumer.
pub(crate) struct Monitor<'m> {
    pub(crate) guards: &'m mut [Guard],
    pub(crate) watches: &'m mut [Watch],
    /// Result of the last [`poll`](Self::poll).
    pub(crate) lost: &'m mut bool,
}

impl Monitor<'_> {
    /// At boot-up: no node is monitored yet, and none is lost.
    pub(crate) fn reset(&mut self) {
        self.guards.fill(Guard::BLANK);
        self.watches.fill(Watch::BLANK);
        *self.lost = false;
    }

    /// Reads 100Ch, 100Dh and 1016h again.
    pub(crate) fn configure<D: Services>(&mut self, store: &Store<'_>, profile: &Profile) {
        let guards = guards::<D>(store, profile);
        for guard in &mut *self.guards {
            guard.configure(store, guards);
        }
        let switched_off = profile.guarding_switch.is_some() && guards;
        consumer::configure(self.watches, store, !switched_off);
    }

    /// Handles a guarding request. Returns the byte of the response, if guarding is active.
    pub(crate) fn guard(&mut self, state: State, now: Instant) -> Option<u8> {
        self.guards.first_mut()?.request(state, now)
    }

    /// Receives a heartbeat or boot-up message of another node.
    pub(crate) fn heartbeat(&mut self, node: u8, now: Instant) {
        for watch in &mut *self.watches {
            watch.heartbeat(node, now);
        }
    }

    /// Checks the deadlines at this time.
    pub(crate) fn handle_timeout(&mut self, now: Instant) {
        for guard in &mut *self.guards {
            guard.handle_timeout(now);
        }
        for watch in &mut *self.watches {
            watch.handle_timeout(now);
        }
    }

    /// Returns `Some(true)` when the first node was lost, and `Some(false)` when all nodes have
    /// returned.
    pub(crate) fn poll(&mut self) -> Option<bool> {
        let lost =
            self.guards.iter().any(Guard::is_lost) || self.watches.iter().any(Watch::is_lost);
        let changed = lost != *self.lost;
        *self.lost = lost;
        changed.then_some(lost)
    }
}

/// Time when the next node is lost, if it sends nothing before.
pub(crate) fn deadline(guards: &[Guard], watches: &[Watch]) -> Deadline {
    let guards = guards.iter().map(Guard::deadline);
    let watches = watches.iter().map(Watch::deadline);
    guards.chain(watches).fold(Deadline::NEVER, Deadline::or)
}
