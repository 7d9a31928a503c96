//! Heartbeat consumer (CiA 301, chapter 7.2.8.2.2; object 1016h).

use crate::deadline::Deadline;
use crate::rooms::{Blank, Room, Rooms};
use crate::store::Store;
use od_wire::{Instant, NodeId};

/// One entry of 1016h. Watching begins with the first heartbeat that is heard.
#[derive(Clone, Copy, PartialEq, Debug)]
pub(crate) struct Watch {
    node: u8,
    lost: bool,
    period_ms: u16,
    deadline: Deadline,
}

impl Blank for Watch {
    const BLANK: Self = Self {
        node: 0,
        lost: false,
        period_ms: 0,
        deadline: Deadline::NEVER,
    };
}

/// The nodes that are watched.
#[derive(Clone, Debug)]
pub(super) struct Consumer<R: Rooms> {
    watches: R::Watches<Watch>,
    count: u8,
}

impl<R: Rooms> Consumer<R> {
    pub(super) const fn new() -> Self {
        Self {
            watches: Room::BLANK,
            count: 0,
        }
    }

    pub(super) fn reset(&mut self) {
        self.watches.all_mut().fill(Watch::BLANK);
        self.count = 0;
    }

    /// Reads 1016h: bits 0–15 the time in ms, bits 16–23 the node ID. An entry that did
    /// not change goes on. Without `enabled` no node is watched.
    pub(super) fn configure(&mut self, store: &Store<'_>, enabled: bool) {
        self.count = 0;
        for (sub, watch) in (1..).zip(self.watches.all_mut()) {
            let Some(raw) = store.try_word(0x1016, sub) else {
                break;
            };
            let (node, period_ms) = ((raw >> 16) as u8, raw as u16);
            let active = enabled && period_ms > 0 && NodeId::new(node).is_some();
            let (node, period_ms) = if active { (node, period_ms) } else { (0, 0) };
            if (node, period_ms) != (watch.node, watch.period_ms) {
                *watch = Watch {
                    node,
                    period_ms,
                    ..Watch::BLANK
                };
            }
            self.count += 1;
        }
    }

    /// The nodes that are watched; 0: none.
    pub(super) fn nodes(&self) -> impl Iterator<Item = u8> + '_ {
        self.watches().iter().map(|watch| watch.node)
    }

    /// One for each entry of 1016h.
    fn watches(&self) -> &[Watch] {
        let watches = self.watches.all().get(..self.count.into());
        watches.unwrap_or_default()
    }

    fn active(&mut self) -> impl Iterator<Item = &mut Watch> {
        let watches = self.watches.all_mut().get_mut(..self.count.into());
        let watches = watches.unwrap_or_default().iter_mut();
        watches.filter(|watch| watch.period_ms > 0)
    }

    pub(super) fn heartbeat(&mut self, node: u8, now: Instant) {
        for watch in self.active().filter(|watch| watch.node == node) {
            watch.lost = false;
            watch.deadline = Deadline::at(now.plus_millis(watch.period_ms.into()));
        }
    }

    #[inline]
    pub(super) fn handle_timeout(&mut self, now: Instant) {
        for watch in self.active() {
            if watch.deadline.is_due(now) {
                watch.deadline = Deadline::NEVER;
                watch.lost = true;
            }
        }
    }

    #[inline]
    pub(super) fn is_lost(&self) -> bool {
        self.watches().iter().any(|watch| watch.lost)
    }

    #[inline]
    pub(super) fn deadline(&self) -> Deadline {
        let watches = self.watches().iter();
        watches.fold(Deadline::NEVER, |first, watch| first.or(watch.deadline))
    }
}
