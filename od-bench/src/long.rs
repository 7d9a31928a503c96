//! Strings and DOMAINs of a file's device at any length: the store has those that fit into it, and
//! the longer ones take memory when a master writes them. Beside them the clock of the device.

use std::prelude::v1::*;

use od_model::{Address, DataType, Entry};
use od_runtime::{
    AbortCode, Application, Chunk, Context, Halt, Instant, NodeId, Reset, Store, Stream, StreamEnd,
    TimeOfDay,
};

use crate::clock::Clock;
use crate::programs::{Loader, Programs};

/// Most bytes of a DOMAIN that a master writes, where nothing says another number.
pub(crate) const DOMAIN_SIZE: usize = 1 << 20;

/// The values that the store has no room for.
#[derive(Clone, Default)]
pub(crate) struct Long {
    /// Most bytes of a string or DOMAIN that a master writes, if its default is not longer. `None`:
    /// [`DOMAIN_SIZE`], and for a string its room in the store.
    pub(crate) size: Option<usize>,
    values: Vec<(Address, Vec<u8>)>,
    /// The values that masters write now, each by an SDO server of its own.
    coming: Vec<(Address, Vec<u8>)>,
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
    fn coming(&mut self, address: Address) -> &mut Vec<u8> {
        let known = self.coming.iter().position(|(own, _)| *own == address);
        let at = known.unwrap_or_else(|| {
            self.coming.push((address, Vec::new()));
            self.coming.len() - 1
        });
        &mut self.coming[at].1
    }

    fn remove(&mut self, address: Address) {
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
    fn limit(&self, store: &Store<'_>, entry: &Entry) -> usize {
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
fn room(entry: &Entry) -> usize {
    usize::from(entry.slot.len.saturating_sub(2))
}

/// An application with the long values beside it.
pub(crate) struct Beside<'d> {
    pub(crate) application: &'d mut dyn Application,
    pub(crate) long: &'d mut Long,
    pub(crate) clock: &'d mut Clock,
    pub(crate) programs: &'d mut Programs,
}

impl Beside<'_> {
    /// Looks at the bytes at an address.
    fn look<R>(
        &self,
        store: &Store<'_>,
        address: Address,
        look: impl FnOnce(&[u8]) -> R,
    ) -> Result<R, Halt> {
        if let Some(value) = self.long.get(address) {
            return Ok(look(value));
        }
        let entry = store.dictionary().find(address).map_err(AbortCode::from)?;
        Ok(look(store.bytes(&entry, &mut [0; 8])))
    }

    /// A value came whole.
    fn keep(&mut self, cx: &mut Context<'_, '_>, address: Address) -> Result<(), Halt> {
        let mut value = core::mem::take(self.long.coming(address));
        value.shrink_to_fit();
        self.application.validate(cx, address, &value)?;
        let entry = cx
            .store
            .dictionary()
            .find(address)
            .map_err(AbortCode::from)?;
        self.long.remove(address);
        if value.len() <= room(&entry) {
            cx.store.put(&entry, &value)?;
        } else {
            // What 1010h saves is the default.
            cx.store.reset_entry(&entry);
            self.long.values.push((address, value));
        }
        self.application.written(cx, address);
        Ok(())
    }
}

impl Stream for Beside<'_> {
    fn begin_download(
        &mut self,
        cx: &mut Context<'_, '_>,
        address: Address,
        size: Option<u32>,
    ) -> Result<(), Halt> {
        let entry = cx
            .store
            .dictionary()
            .find(address)
            .map_err(AbortCode::from)?;
        let limit = self.long.limit(cx.store, &entry);
        if size.is_some_and(|size| size as usize > limit) {
            return Err(AbortCode::TooLong.into());
        }
        Ok(())
    }

    fn write(
        &mut self,
        cx: &mut Context<'_, '_>,
        address: Address,
        chunk: Chunk<'_>,
    ) -> Result<(), Halt> {
        let entry = cx
            .store
            .dictionary()
            .find(address)
            .map_err(AbortCode::from)?;
        let limit = self.long.limit(cx.store, &entry);
        if self.long.coming(address).len() + chunk.bytes.len() > limit {
            return Err(AbortCode::TooLong.into());
        }
        self.long.coming(address).extend_from_slice(chunk.bytes);
        if chunk.last {
            self.keep(cx, address)
        } else {
            Ok(())
        }
    }

    fn begin_upload(&mut self, cx: &mut Context<'_, '_>, address: Address) -> Result<u32, Halt> {
        if address.index >= 0x2000 {
            self.application.refresh(cx, address)?;
        }
        let len = self.look(cx.store, address, <[u8]>::len)?;
        Ok(u32::try_from(len).map_err(|_| AbortCode::OutOfMemory)?)
    }

    fn read(
        &mut self,
        cx: &mut Context<'_, '_>,
        address: Address,
        at: u32,
        to: &mut [u8],
    ) -> Result<(), Halt> {
        let at = at as usize;
        self.look(cx.store, address, |value| {
            // The value may have changed since its length was announced.
            let part = value.get(at..at + to.len()).ok_or(AbortCode::General)?;
            to.copy_from_slice(part);
            Ok(())
        })?
    }

    fn end(&mut self, _: &mut Context<'_, '_>, address: Address, _: StreamEnd) {
        self.long.coming.retain(|(own, _)| *own != address);
    }
}

impl Application for Beside<'_> {
    fn reset(&mut self, cx: &mut Context<'_, '_>, reset: Reset) {
        self.long.reset(cx.store, reset);
        if reset == Reset::PowerOn {
            *self.clock = Clock::default();
            self.clock.set(cx.now, TimeOfDay::default());
        }
        for loader in self.programs.iter_mut() {
            loader.reset(cx, reset);
        }
        self.application.reset(cx, reset);
    }

    fn node_id(&self, store: &Store<'_>) -> Option<NodeId> {
        self.application.node_id(store)
    }

    fn is_live(&self, address: Address) -> bool {
        self.application.is_live(address)
    }

    fn refresh(&mut self, cx: &mut Context<'_, '_>, address: Address) -> Result<(), AbortCode> {
        self.application.refresh(cx, address)
    }

    fn number(&mut self, now: Instant, address: Address) -> Option<u32> {
        self.application.number(now, address)
    }

    fn validate(
        &mut self,
        cx: &mut Context<'_, '_>,
        address: Address,
        value: &[u8],
    ) -> Result<(), AbortCode> {
        for loader in self.programs.iter_mut() {
            loader.validate(cx, address, value)?;
        }
        self.application.validate(cx, address, value)
    }

    fn written(&mut self, cx: &mut Context<'_, '_>, address: Address) {
        // From the side of the device it goes into the store.
        self.long.remove(address);
        for loader in self.programs.iter_mut() {
            loader.written(cx, address);
        }
        if Clock::is_configuration(address) {
            cx.signals.wake();
        }
        self.application.written(cx, address);
    }

    fn stream(&mut self, address: Address) -> Option<&mut dyn Stream> {
        let loads = |loader: &mut Loader| loader.stream(address).is_some();
        match self.programs.iter_mut().position(loads) {
            Some(at) => self.programs[at].stream(address),
            None => Some(self),
        }
    }

    fn saving(&mut self, cx: &mut Context<'_, '_>, begins: bool) {
        self.application.saving(cx, begins);
    }

    fn storage_is(&mut self, sound: bool) {
        self.application.storage_is(sound);
    }

    fn error_info(&self, store: &Store<'_>) -> [u8; 5] {
        self.application.error_info(store)
    }

    fn tick(&mut self, cx: &mut Context<'_, '_>) -> Option<Instant> {
        let ticks = [self.clock.tick(cx), self.application.tick(cx)];
        ticks.into_iter().flatten().min()
    }

    fn set_time(&mut self, cx: &mut Context<'_, '_>, time: TimeOfDay) {
        self.clock.set(cx.now, time);
    }

    fn time(&mut self, cx: &mut Context<'_, '_>) -> Option<TimeOfDay> {
        Some(self.clock.time(cx.now))
    }
}
