//! The EEPROM of a virtual device, seen from outside: its bytes, the values that the next start loads,
//! and power that fails during a write.

use std::ops::Range;
use std::prelude::v1::*;
use std::vec;

use od_model::{Address, Entry};
use od_runtime::Store;
use od_runtime::storage::{Memory, Storage, image};

use crate::device::VirtualDevice;

/// Saved values, which the device loads at its next start.
pub struct Saved {
    values: Vec<u8>,
}

impl Saved {
    /// The value at an address; `None` if the object is not saved.
    pub fn bytes(&mut self, device: &VirtualDevice, address: Address) -> Option<Vec<u8>> {
        device.saved_slot(address)?;
        let dictionary = device.dictionary();
        let entry = dictionary.find(address).ok()?;
        let store = Store::new(&dictionary, &mut self.values, device.node_id()).ok()?;
        Some(store.bytes(&entry, &mut [0; 8]).to_vec())
    }
}

impl VirtualDevice {
    /// The bytes of the EEPROM; empty if they cannot be read.
    pub fn eeprom(&mut self) -> Vec<u8> {
        let storage = &mut self.node.storage;
        let mut bytes = vec![0; storage.capacity()];
        match storage.read(0, &mut bytes) {
            Ok(()) => bytes,
            // A memory of this program can be read without power, too.
            Err(_) => match storage.memory() {
                Some(memory) => memory.bytes().to_vec(),
                None => Vec::new(),
            },
        }
    }

    /// Writes bytes into the EEPROM, as many as it has room for. The device loads them at the next start.
    pub fn set_eeprom(&mut self, bytes: &[u8]) {
        let storage = &mut self.node.storage;
        let len = bytes.len().min(storage.capacity());
        // A memory that fails keeps its bytes.
        let _ = storage.write(0, &bytes[..len]);
    }

    /// Lets the power fail at the first byte that is written to the EEPROM after `bytes` more bytes. Returns `false` for
    /// an EEPROM whose bytes are in a storage of the caller: its power cannot be cut.
    pub fn cut_power_after(&mut self, bytes: usize) -> bool {
        let storage = &mut self.node.storage;
        let Some(memory) = storage.memory() else {
            return false;
        };
        memory.cut_after(bytes);
        storage.fails = true;
        true
    }

    /// Returns the values that a start would load now.
    pub fn saved(&mut self) -> Saved {
        let loaded = self.node.device().clone();
        let profile = loaded.profile.store;
        let dictionary = loaded.source.dictionary();
        let mut values = vec![0; dictionary.store_len()];
        if let Ok(mut store) = Store::new(&dictionary, &mut values, self.node_id()) {
            profile.reset(&mut store, &|_| true);
            // If nothing can be read, the defaults stay.
            let _ = image::load(&mut self.node.storage, &mut store, &profile, &|_| true);
        }
        Saved { values }
    }

    /// Returns the values that the EEPROM would contain after a save.
    pub fn image(&mut self) -> Vec<u8> {
        let mut memory = Memory::new(vec![0xFF; self.node.storage.capacity()]);
        let profile = self.profile().store;
        // Values without room are lost, as in the device.
        let _ = self
            .node
            .look(|_, store| image::save(&mut memory, store, &profile, 1));
        memory.bytes().to_vec()
    }

    /// The bytes of an object after a start: the saved value, otherwise the default. `None` if the object does not
    /// exist or is not saved.
    pub(crate) fn saved_bytes(&self, saved: &Saved, address: Address) -> Option<Vec<u8>> {
        let entry = self.dictionary().find(address).ok()?;
        let range = place(&entry);
        let kept = entry.group != od_model::Group::None && !range.is_empty();
        saved.values.get(range).filter(|_| kept).map(<[u8]>::to_vec)
    }

    /// Returns whether a start would change the value of an object. `None` for an object that is not saved.
    pub fn is_unsaved(&self, saved: &Saved, address: Address) -> Option<bool> {
        let range = self.saved_slot(address)?;
        Some(saved.values.get(range.clone()) != self.node.values().get(range))
    }

    /// Place of the value of a saved object in the store.
    fn saved_slot(&self, address: Address) -> Option<Range<usize>> {
        let dictionary = self.dictionary();
        let entry = dictionary.find(address).ok().filter(is_saved)?;
        Some(place(&entry))
    }
}

/// Place of a value in the store.
fn place(entry: &Entry) -> Range<usize> {
    let start = entry.slot.offset as usize;
    start..start + usize::from(entry.slot.len)
}

/// Returns whether 1010h saves the value.
pub fn is_saved(entry: &Entry) -> bool {
    entry.group != od_model::Group::None && entry.access.writable() && entry.slot.len > 0
}
