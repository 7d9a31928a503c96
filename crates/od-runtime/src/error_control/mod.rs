//! Error control (CiA 301, chapter 7.2.8): heartbeat producer and consumer, node and life guarding.
//!
//! [`Monitor`] watches the other side (a master that guards, nodes that send
//! heartbeats) and says when it is lost and when it is back; what follows from
//! that is the node's business.

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
/// CiA 301: guarding while 1017h is 0. A family may have a switch for it instead, which
/// leaves nothing of the heartbeat, neither producer nor consumer.
pub(crate) fn guards<D: Services>(store: &Store<'_>, profile: &Profile) -> bool {
    match profile.guarding_switch {
        Some((index, mask)) => store.word(index, 0, 0) & mask != 0,
        None => D::GUARDING && store.word(0x1017, 0, 0) == 0 && store.try_word(0x100C, 0).is_some(),
    }
}

/// Returns whether the object at this index configures the monitor.
pub(crate) fn is_configuration(index: u16, profile: &Profile) -> bool {
    matches!(index, 0x100C | 0x100D | 0x1016 | 0x1017)
        || profile
            .guarding_switch
            .is_some_and(|(switch, _)| switch == index)
}

/// Monitor of the other side at work: life guarding and heartbeat consumer.
pub(crate) struct Monitor<'m> {
    pub(crate) guards: &'m mut [Guard],
    pub(crate) watches: &'m mut [Watch],
    /// Result of the last [`poll`](Self::poll).
    pub(crate) lost: &'m mut bool,
}

impl Monitor<'_> {
    /// Boot-up: no node is watched yet, and none is lost.
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

    /// A master guards this node. Returns the byte of the response, if guarding is in force.
    pub(crate) fn guard(&mut self, state: State, now: Instant) -> Option<u8> {
        self.guards.first_mut()?.request(state, now)
    }

    /// A heartbeat, or boot-up message, of another node.
    pub(crate) fn heartbeat(&mut self, node: u8, now: Instant) {
        for watch in &mut *self.watches {
            watch.heartbeat(node, now);
        }
    }

    /// Time has passed.
    pub(crate) fn handle_timeout(&mut self, now: Instant) {
        for guard in &mut *self.guards {
            guard.handle_timeout(now);
        }
        for watch in &mut *self.watches {
            watch.handle_timeout(now);
        }
    }

    /// `Some(true)` when a node was lost and none before, `Some(false)` when
    /// everybody is back.
    pub(crate) fn poll(&mut self) -> Option<bool> {
        let lost =
            self.guards.iter().any(Guard::is_lost) || self.watches.iter().any(Watch::is_lost);
        let changed = lost != *self.lost;
        *self.lost = lost;
        changed.then_some(lost)
    }
}

/// Time when a node is lost unless it is heard before.
pub(crate) fn deadline(guards: &[Guard], watches: &[Watch]) -> Deadline {
    let guards = guards.iter().map(Guard::deadline);
    let watches = watches.iter().map(Watch::deadline);
    guards.chain(watches).fold(Deadline::NEVER, Deadline::or)
}
