//! Forwarding of the calls of a device to its twin.

use std::prelude::v1::*;

use od_runtime::Instant;

use crate::behaviour::Behaviour;
use crate::device::VirtualDevice;
use crate::twin::{Before, Call, Twin};

impl VirtualDevice {
    /// With a twin. Do it before power comes.
    #[must_use]
    pub fn with_twin(mut self, twin: Box<dyn Twin>) -> Self {
        self.twin = Some(twin);
        self
    }

    /// Forwards a call to the twin; [`Call::End`] after the last.
    #[inline]
    pub fn forward(&mut self, now: Instant, call: Call<'_>) {
        if self.twin.is_some() {
            self.forward_now(now, call);
        }
    }

    #[cold]
    fn forward_now(&mut self, now: Instant, call: Call<'_>) {
        let Some(twin) = &mut self.twin else {
            return;
        };
        let before = Before {
            state: self.node.state(),
            node_id: self.node.node_id(),
            is_powered: self.node.is_powered(),
            due: self.node.poll_timeout(),
            encoder: match &self.behaviour {
                Behaviour::Encoder(encoder) => Some(encoder),
                _ => None,
            },
            storage: &mut self.storage,
        };
        twin.call(before, now, call);
    }
}
