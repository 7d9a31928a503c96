//! Identity of a device on the bus: serial number, LSS address, and whether it has a node ID.

use std::prelude::v1::*;
use std::vec;

use od_model::{Group, Refused};
use od_runtime::Store;
use od_runtime::encoder::{Role, Switches};
use od_runtime::storage::image;

use crate::device::VirtualDevice;
use crate::device::application::Behaviour;
use crate::device::services::Services;

impl VirtualDevice {
    /// The same device with this serial number in 1018h:04. Call it before the power is switched on.
    #[must_use]
    pub fn with_serial_number(mut self, serial_number: u32) -> Self {
        match &mut self.node.application.behaviour {
            Behaviour::Encoder(encoder) => {
                **encoder = encoder.clone().with_serial_number(serial_number);
            }
            _ => self.node.application.serial_number = Some(serial_number),
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
        let serial_number = match &self.node.application.behaviour {
            Behaviour::Encoder(encoder) => encoder.serial_number(),
            _ => self.node.application.serial_number,
        };
        address[3] = serial_number.unwrap_or(address[3]);
        address
    }

    /// The same device, whose factory value of the node ID is the one that it was made with: 1011h restores
    /// it, and not the default of the dictionary. Only a device with an object for its node ID (2101h)
    /// changes. Call it before the power is switched on.
    #[must_use]
    pub fn delivered(mut self) -> Self {
        if let Some(encoder) = self.node.application.encoder() {
            let object = encoder.profile().object(Role::NodeId);
            let node_id = object.map(|at| (at, self.wanted_id));
            self.node.device_mut().profile.store.node_id = node_id;
        }
        self
    }

    /// The same device, whose rotary switches set the node ID that it was made with, and whose DIP switches
    /// set the bit rate of its dictionary. A device without switches, or with a node ID above 99, is only
    /// [`delivered`](Self::delivered).
    #[must_use]
    pub fn with_node_switch(mut self) -> Self {
        if let Some(encoder) = self.node.application.encoder() {
            let family = encoder.profile();
            let dictionary = self.dictionary();
            let code = family.object(Role::BitRate).and_then(|at| {
                let entry = dictionary.find(at).ok()?;
                usize::try_from(entry.default.integer(0)?).ok()
            });
            let rate = code.and_then(|code| family.bit_rates.get(code));
            let dip = rate.and_then(|rate| family.switch_rates.iter().position(|one| one == rate));
            if let (Some(dip), node_id @ ..=99) = (dip, self.wanted_id.raw()) {
                let bit_rate = dip as u8;
                let mut encoder = encoder.clone();
                encoder.set_switches(Switches { node_id, bit_rate });
                self.node.application.behaviour = Behaviour::Encoder(Box::new(encoder));
            }
        }
        self.delivered()
    }

    /// Identity and layout in words: title, vendor-ID and product code (1018h), and a number for
    /// addresses and types of the objects that it saves.
    pub fn identity(&self) -> String {
        let [vendor, product, ..] = self.lss_address();
        // FNV-1a; without lengths of strings, which depend on options.
        let mut layout = 0x811C_9DC5_u32;
        let entries = self.dictionary().entries().iter();
        for entry in entries.filter(|entry| entry.group != Group::None && entry.slot.len > 0) {
            let ([a, b], [c, d]) = (
                entry.address.index.to_le_bytes(),
                entry.data_type.code().to_le_bytes(),
            );
            for byte in [a, b, entry.address.sub, c, d] {
                layout = (layout ^ u32::from(byte)).wrapping_mul(0x0100_0193);
            }
        }
        let title = self.title();
        format!(
            "{title}, vendor-ID {vendor:08X}h, product code {product:08X}h, saved objects {layout:08X}h"
        )
    }

    /// Returns whether it has a node ID; without one only LSS works (CiA 305).
    pub fn is_configured(&self) -> bool {
        self.node.is_configured()
    }

    /// The same device without a node ID: it only supports LSS until a master gives it a node ID (CiA 305).
    /// Call it before the power is switched on.
    ///
    /// # Errors
    /// A sentence: the device has no LSS slave, or its LSS slave always has a node ID.
    pub fn without_node_id(mut self) -> Result<Self, Refused> {
        if !self.profile().lss.is_some_and(|lss| lss.is_own()) {
            return Err(String::from(
                "a device starts without a node ID only if its EDS says `LSS_Supported=1`",
            )
            .into());
        }
        self.node.set_node_id(None);
        Ok(self)
    }

    /// The services that its EDS enables, and those that its EDS promises but a node does not have; both are
    /// empty for a built-in device.
    pub fn services(&self) -> &Services {
        &self.services
    }

    /// Writes the wanted node ID and bit rate into an empty EEPROM, as in a device that was set up.
    pub(crate) fn configure_node_id(&mut self) {
        let Some(encoder) = self.node.application.encoder() else {
            return;
        };
        let family = encoder.profile();
        let code = self.wanted_rate.and_then(|rate| {
            let code = family.bit_rates.iter().position(|known| *known == rate)?;
            Some((family.object(Role::BitRate)?, code as u64))
        });
        let id = family
            .object(Role::NodeId)
            .map(|at| (at, u64::from(self.wanted_id.raw())));
        let wanted = [id, code];
        let loaded = self.node.device().clone();
        let profile = &loaded.profile.store;
        let dictionary = loaded.source.dictionary();
        let mut values = vec![0; dictionary.store_len()];
        let Ok(mut store) = Store::new(&dictionary, &mut values, self.wanted_id) else {
            return;
        };
        store.reset(|_| true);
        let storage = &mut self.node.storage;
        let loaded = image::load(storage, &mut store, profile, &|_| true);
        if loaded != Ok(image::Loaded::Blank) {
            return;
        }
        let mut differs = false;
        for (at, value) in wanted.into_iter().flatten() {
            differs |= store.unsigned(at.index, at.sub) != value;
            store.set_unsigned(at, value);
        }
        if differs {
            // This saves only the group of the object. If the storage fails, the default stays.
            let _ = image::save(storage, &store, profile, 4);
        }
    }
}
