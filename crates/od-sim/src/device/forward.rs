//! Passes the calls of a device to its twin and to its node.

use std::prelude::v1::*;

use od_runtime::Instant;

use crate::device::twin::{Before, Call, Twin};
use crate::device::{Node, VirtualDevice};

impl VirtualDevice {
    /// The same device with a twin. Call it before the power is switched on.
    #[must_use]
    pub fn with_twin(mut self, twin: Box<dyn Twin>) -> Self {
        self.twin.0 = Some(twin);
        self
    }

    /// Calls the twin, then the node, and collects the events of the node.
    pub(crate) fn call<R>(
        &mut self,
        now: Instant,
        call: Call<'_>,
        act: impl FnOnce(&mut Node) -> R,
    ) -> R {
        self.forward(now, call);
        let result = act(&mut self.node);
        self.take_events();
        result
    }

    /// Forwards a call to the twin; [`Call::End`] after the last.
    pub fn forward(&mut self, now: Instant, call: Call<'_>) {
        let Some(twin) = &mut self.twin.0 else {
            return;
        };
        let before = Before {
            state: self.node.state(),
            node_id: self.node.node_id(),
            is_powered: self.node.is_powered(),
            due: self.node.poll_timeout(),
            encoder: self.node.application.encoder(),
            storage: &mut self.node.storage,
        };
        twin.call(before, now, call);
    }
}
