//! The configuration of a device, for a DCF.

use std::prelude::v1::*;
use std::string::ToString;

use od_eds::{Description, Spanned, Value};
use od_model::{Address, Group};

use crate::device::VirtualDevice;

impl VirtualDevice {
    /// Writes node ID, bit rate and the values that are not the factory's into the description
    /// that this device was made of. Commands, logs and measured values are not part of it.
    pub fn write_configuration(&mut self, description: &mut Description) {
        let node_id = self.node_id();
        description.commission("NodeID", &node_id.raw().to_string());
        if let Some(rate) = self.bit_rate() {
            description.commission("Baudrate", &rate.to_string());
        }
        for (address, value) in self.configured() {
            let entry = description
                .objects
                .get_mut(&address.index)
                .and_then(|object| object.entries.get_mut(&address.sub));
            if let Some(entry) = entry {
                entry.parameter = Some(Spanned::from(value));
            }
        }
    }

    /// Values that a master could set again and that are not the default values.
    fn configured(&mut self) -> Vec<(Address, Value)> {
        self.node.look(|_, store| {
            let set = store.dictionary().entries().filter(|entry| {
                entry.group != Group::None && entry.access.writable() && !store.is_default(entry)
            });
            set.map(|entry| {
                let bytes = store.bytes(&entry, &mut [0; 8]).to_vec();
                (entry.address, Value::from_wire(entry.data_type, bytes))
            })
            .collect()
        })
    }
}
