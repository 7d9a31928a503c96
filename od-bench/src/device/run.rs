//! Many deadlines of a device in one go.

use std::prelude::v1::*;

use od_runtime::{Frame, Instant};

use super::VirtualDevice;
use crate::slave::Stretch;

impl VirtualDevice {
    /// Lets time pass, and hands over what is sent; see [`Stretch`]. Returns whether there may be more to do
    /// at the moment that it is now. `None`: somebody wants to know of each call, or acts between them.
    pub(crate) fn run(
        &mut self,
        stretch: &mut Stretch,
        sent: &mut dyn FnMut(Instant, Frame),
    ) -> Option<bool> {
        let looks_on = self.twin.is_some() || self.look_at.is_some() || self.storage.fails;
        #[cfg(feature = "real")]
        let looks_on = looks_on || self.described.is_some();
        #[cfg(feature = "serve")]
        let looks_on = looks_on || self.recorded.is_some();
        if looks_on {
            return None;
        }
        let again = self.lend(|node, device| node.run(device, stretch, sent));
        for event in std::mem::take(&mut stretch.events) {
            self.take_event(event);
        }
        Some(again)
    }
}
