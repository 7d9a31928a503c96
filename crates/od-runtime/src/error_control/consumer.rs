//! Heartbeat consumer (CiA 301, chapter 7.2.8.3.2.2, object 1016h).

use crate::blank::Blank;
use crate::deadline::Deadline;
use crate::store::Store;
use od_wire::{CanId, Instant, NodeId};

/// One entry of 1016h. Monitoring begins with the first heartbeat.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct Watch {
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

/// Reads 1016h: bits 0 to 15 are the time in ms, bits 16 to 23 the node ID. An unchanged entry
/// keeps its state. Without `enabled` no node is monitored.
pub(super) fn configure(watches: &mut [Watch], store: &Store<'_>, enabled: bool) {
    for (sub, watch) in (1..).zip(watches) {
        let raw = store.word(0x1016, sub, 0);
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
    }
}

impl Watch {
    /// CAN-ID of the monitored heartbeats.
    pub(crate) fn received_by(&self) -> Option<CanId> {
        NodeId::new(self.node).map(|node| node.plus(0x700))
    }

    /// Receives a heartbeat or boot-up message of this node.
    pub(super) fn heartbeat(&mut self, node: u8, now: Instant) {
        if self.node == node && self.period_ms > 0 {
            self.lost = false;
            self.deadline = Deadline::at(now.plus_millis(self.period_ms.into()));
        }
    }

    pub(super) fn handle_timeout(&mut self, now: Instant) {
        if self.deadline.is_due(now) {
            self.deadline = Deadline::NEVER;
            self.lost = true;
        }
    }

    pub(super) fn is_lost(&self) -> bool {
        self.lost
    }

    pub(super) fn deadline(&self) -> Deadline {
        self.deadline
    }
}
