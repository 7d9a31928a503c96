//! Parts of a device of a file beside its behaviour: strings and DOMAINs of any length (the store has
//! those that fit into it, and the longer ones take memory when a master writes them), a clock, and programs.

use std::prelude::v1::*;

use od_model::{Address, DataType, Dictionary, Entry};
use od_runtime::{AbortCode, Application, Context, Reset, Store, TimeOfDay};

use crate::device::clock::Clock;
use crate::device::programs::{self, Programs};

/// Most bytes of a DOMAIN that a master writes, where nothing says another number.
pub(crate) const DOMAIN_SIZE: usize = 1 << 20;

/// The values that the store has no room for.
#[derive(Clone, Default)]
pub(crate) struct Long {
    /// Most bytes of a string or DOMAIN that a master writes, if its default is not longer. `None`:
    /// [`DOMAIN_SIZE`], and for a string its room in the store.
    pub(crate) size: Option<usize>,
    pub(crate) values: Vec<(Address, Vec<u8>)>,
    /// The values that masters write now, each by an SDO server of its own.
    pub(crate) coming: Vec<(Address, Vec<u8>)>,
}

impl Long {
    /// The value at an address, if the store does not have it.
    pub(crate) fn get(&self, address: Address) -> Option<&[u8]> {
        let mut values = self.values.iter();
        let (_, value) = values.find(|(own, _)| *own == address)?;
        Some(value)
    }

    /// Bytes that the values take, and the one that comes.
    #[cfg(test)]
    pub(crate) fn memory(&self) -> usize {
        let values = self.values.iter().map(|(_, value)| value.capacity());
        let coming = self.coming.iter().map(|(_, value)| value.capacity());
        values.chain(coming).sum()
    }

    /// The part that came of a value.
    pub(crate) fn coming(&mut self, address: Address) -> &mut Vec<u8> {
        let known = self.coming.iter().position(|(own, _)| *own == address);
        let at = known.unwrap_or_else(|| {
            self.coming.push((address, Vec::new()));
            self.coming.len() - 1
        });
        &mut self.coming[at].1
    }

    pub(crate) fn remove(&mut self, address: Address) {
        self.values.retain(|(own, _)| *own != address);
    }

    /// After a reset the store has what was saved, or the default, unless that is too long for it.
    fn reset(&mut self, store: &Store<'_>, reset: Reset) {
        let all = reset != Reset::Communication;
        let is_reset = |address: Address| all || (0x1000..0x2000).contains(&address.index);
        self.coming = Vec::new();
        self.values.retain(|(address, _)| !is_reset(*address));
        for entry in store.dictionary().entries() {
            let default = store.dictionary().literal_bytes(entry.default);
            if default.len() > room(&entry) && entry.slot.len > 0 && is_reset(entry.address) {
                self.values.push((entry.address, default.to_vec()));
            }
        }
    }

    /// Most bytes that a master writes into an entry.
    pub(crate) fn limit(&self, store: &Store<'_>, entry: &Entry) -> usize {
        let default = store.dictionary().literal_bytes(entry.default).len();
        let size = match self.size {
            Some(size) => size,
            None if entry.data_type == DataType::Domain => DOMAIN_SIZE,
            None => room(entry),
        };
        size.max(default)
    }
}

/// Bytes that the store has for a value of variable length.
pub(crate) fn room(entry: &Entry) -> usize {
    usize::from(entry.slot.len.saturating_sub(2))
}

/// The parts of a file's device.
#[derive(Clone, Default)]
pub(crate) struct Beside {
    pub(crate) long: Long,
    pub(crate) clock: Clock,
    pub(crate) programs: Programs,
}

impl Beside {
    pub(crate) fn of(dictionary: Dictionary<'_>) -> Self {
        Self {
            programs: programs::of(dictionary),
            ..Self::default()
        }
    }

    pub(crate) fn reset(&mut self, cx: &mut Context<'_, '_>, reset: Reset) {
        self.long.reset(cx.store, reset);
        if reset == Reset::PowerOn {
            self.clock = Clock::default();
            self.clock.set(cx.now, TimeOfDay::default());
        }
        for loader in &mut self.programs {
            loader.reset(cx, reset);
        }
    }

    pub(crate) fn validate(
        &mut self,
        cx: &mut Context<'_, '_>,
        address: Address,
        value: &[u8],
    ) -> Result<(), AbortCode> {
        let mut programs = self.programs.iter_mut();
        programs.try_for_each(|loader| loader.validate(cx, address, value))
    }

    pub(crate) fn written(&mut self, cx: &mut Context<'_, '_>, address: Address) {
        // From the side of the device it goes into the store.
        self.long.remove(address);
        for loader in &mut self.programs {
            loader.written(cx, address);
        }
        if Clock::is_configuration(address) {
            cx.signals.wake();
        }
    }
}
