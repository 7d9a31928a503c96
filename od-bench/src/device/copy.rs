//! A copy of a device, at the same moment and in the same state.

use super::VirtualDevice;
use crate::roomy;

impl VirtualDevice {
    /// Returns a copy that goes on as this device would. Events and twin stay with this one. `None` for
    /// a device with a node, behaviour or storage of one's own.
    pub fn copy(&self) -> Option<Self> {
        Some(Self {
            title: self.title.clone(),
            source: self.source.clone(),
            values: self.values.clone(),
            node: roomy::copy(&*self.node)?,
            behaviour: self.behaviour.copy()?,
            storage: self.storage.copy()?,
            profile: self.profile,
            services: self.services.clone(),
            #[cfg(feature = "eds")]
            long: self.long.clone(),
            #[cfg(feature = "eds")]
            clock: self.clock.clone(),
            #[cfg(feature = "eds")]
            programs: self.programs.clone(),
            wanted_id: self.wanted_id,
            wanted_rate: self.wanted_rate,
            look_at: self.look_at,
            activated: self.activated,
            raised: self.raised.clone(),
            events: Default::default(),
            channels: self.channels,
            has_leds: self.has_leds,
            twin: None,
            #[cfg(feature = "real")]
            described: None,
            #[cfg(feature = "serve")]
            recorded: self.recorded.clone(),
        })
    }
}
