//! Identity of a device on the bus: serial number, LSS address, and whether it has a node ID.

use std::prelude::v1::*;

use crate::device::{Behaviour, VirtualDevice};
use crate::services::Services;

impl VirtualDevice {
    /// With this serial number in 1018h:04, unless its behaviour is of one's own. Do it before
    /// power comes.
    #[must_use]
    pub fn with_serial_number(mut self, serial_number: u32) -> Self {
        match &mut self.behaviour {
            Behaviour::Encoder(encoder) => {
                **encoder = encoder.clone().with_serial_number(serial_number);
            }
            Behaviour::Plain(plain) => plain.serial_number = Some(serial_number),
            Behaviour::Other(_) => {}
        }
        self
    }

    /// Vendor-ID, product code, revision number and serial number (1018h) of its first start.
    pub fn lss_address(&self) -> [u32; 4] {
        let dictionary = self.dictionary();
        let own = |sub| {
            let entry = dictionary.entry(0x1018, sub)?;
            u32::try_from(entry.default.integer(self.wanted_id.raw())?).ok()
        };
        let mut address = [1, 2, 3, 4].map(|sub| own(sub).unwrap_or_default());
        let serial_number = match &self.behaviour {
            Behaviour::Encoder(encoder) => encoder.serial_number(),
            Behaviour::Plain(plain) => plain.serial_number,
            Behaviour::Other(_) => None,
        };
        address[3] = serial_number.unwrap_or(address[3]);
        address
    }

    /// Whether it has a node ID; without one there is LSS alone (CiA 305).
    pub fn is_configured(&self) -> bool {
        self.node.is_configured()
    }

    /// Without a node ID at the first start: nothing but LSS, until a master gives it one
    /// (CiA 305). Do it before power comes.
    ///
    /// # Errors
    /// A sentence, if the device has no LSS slave, or one that always has a node ID.
    pub fn without_node_id(mut self) -> Result<Self, String> {
        if !self.profile.lss.is_some_and(|lss| lss.is_own()) {
            return Err(String::from(
                "a device starts without a node ID only if its EDS says `LSS_Supported=1`",
            ));
        }
        self.node.set_node_id(None);
        Ok(self)
    }

    /// The services that its EDS turns on, and those that it promises in vain; both empty for a
    /// built-in device.
    pub fn services(&self) -> &Services {
        &self.services
    }
}
