//! The parts that only a device of a file has, besides its behaviour: strings and DOMAINs that are too long for the store,
//! a clock, and programs. A long value takes memory only when a master writes it.

use std::prelude::v1::*;

use od_model::{Address, DataType, Dictionary, Entry};
use od_runtime::{AbortCode, Application, Context, Reset, Store, TimeOfDay};

use crate::device::clock::Clock;
use crate::device::programs::{self, Programs};

/// Default limit of a DOMAIN that a master writes, in bytes.
pub(crate) const DOMAIN_SIZE: usize = 1 << 20;

/// The values that the store has no room for.
#[derive(Clone, Default)]
pub(crate) struct Long {
    /// Limit of a string or DOMAIN that a master writes, in bytes; a longer default raises it. `None`:
    /// [`DOMAIN_SIZE`], for a string its room in the store.
    pub(crate) size: Option<usize>,
    pub(crate) values: Vec<(Address, Vec<u8>)>,
    /// Values of downloads in progress, one for each SDO server.
    pub(crate) coming: Vec<(Address, Vec<u8>)>,
}

impl Long {
    /// The value at an address, if the store does not have it.
    pub(crate) fn get(&self, address: Address) -> Option<&[u8]> {
        let mut values = self.values.iter();
        let (_, value) = values.find(|(own, _)| *own == address)?;
        Some(value)
    }

    /// Memory of the values, with those of downloads in progress, in bytes.
    #[cfg(test)]
    pub(crate) fn memory(&self) -> usize {
        let values = self.values.iter().map(|(_, value)| value.capacity());
        let coming = self.coming.iter().map(|(_, value)| value.capacity());
        values.chain(coming).sum()
    }

    /// The part of a value that a download in progress has brought so far.
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

    /// Drops the values at a reset: the saved value or the default is then in the store. Keeps only the defaults
    /// that are too long for it.
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

    /// Limit of a value that a master writes, in bytes.
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

/// Room of the store for a value of variable length, in bytes.
pub(crate) fn room(entry: &Entry) -> usize {
    usize::from(entry.slot.len.saturating_sub(2))
}

/// The parts that only a device of a file has.
#[derive(Clone, Default)]
pub(crate) struct FileParts {
    pub(crate) long: Long,
    pub(crate) clock: Clock,
    pub(crate) programs: Programs,
}

impl FileParts {
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
        // A value that the device itself sets is in the store.
        self.long.remove(address);
        for loader in &mut self.programs {
            loader.written(cx, address);
        }
        if Clock::is_configuration(address) {
            cx.signals.wake();
        }
    }
}
