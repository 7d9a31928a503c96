//! Power of a device.

use od_runtime::Instant;

use super::VirtualDevice;
use crate::behaviour::Behaviour;
use crate::slave::Input;
use crate::twin::Call;

impl VirtualDevice {
    /// Power comes. A device that keeps its node ID in 2101h and has an empty EEPROM starts
    /// with the ID that it was made with.
    pub fn power_on(&mut self, now: Instant) {
        if self.is_powered() {
            return;
        }
        if let Some(memory) = self.storage.memory() {
            memory.restore_power();
        }
        self.storage.fails = false;
        self.configure_node_id();
        self.forward(now, Call::PowerOn);
        // `build` made room for the values.
        let powered = self.lend(|node, device| node.power_on(device, now));
        debug_assert!(powered.is_ok());
        self.take_events();
    }

    /// Boots up now, where the initialisation after power-on takes its time.
    pub(crate) fn boot_at_once(&mut self, now: Instant) {
        self.handle(now, Input::Boot);
    }

    /// Power goes. Time goes on, and the shaft with it.
    pub fn power_off(&mut self, now: Instant) {
        self.forward(now, Call::PowerOff);
        if let Behaviour::Encoder(encoder) = &mut self.behaviour {
            encoder.power_off(now);
        }
        self.node.power_off();
        #[cfg(feature = "serve")]
        if let Some(playing) = &mut self.recorded {
            playing.stop();
        }
    }

    /// Has its CAN controller left the bus, with the node still off?
    pub(crate) fn is_bus_off(&self) -> bool {
        self.node.is_bus_off()
    }

    /// Is there power? A node of a real bus that it describes has some.
    pub fn is_powered(&self) -> bool {
        #[cfg(feature = "real")]
        if self.is_described() {
            return true;
        }
        self.node.is_powered()
    }
}
