//! The behaviour of a device: that of an encoder, that of its maker, or none. A device of a file has
//! more beside it: strings and DOMAINs of any length, a clock, programs.

use std::prelude::v1::*;

use od_model::{Address, Dictionary};
use od_runtime::encoder::Encoder;
use od_runtime::kind::Own;
use od_runtime::{
    AbortCode, Application, ChangeKind, Context, Instant, NoApplication, NodeId, Pin, Reset, Store,
    Stream, TimeOfDay,
};
#[cfg(feature = "eds")]
use od_runtime::{Chunk, Halt, StreamEnd};
use od_wire::nmt::State;

#[cfg(feature = "eds")]
use crate::device::beside::{Beside, Long, room};
#[cfg(feature = "eds")]
use crate::device::programs::Loader;
use crate::shaft::{self, Shaft};

/// The behaviour that belongs to the objects of a dictionary.
#[derive(Clone)]
pub(crate) enum Behind {
    Encoder(Box<Encoder<Shaft>>),
    Plain(NoApplication),
    Own(Box<dyn Own>),
}

/// The application of a bench's node.
#[derive(Clone)]
pub(crate) struct Behaviour {
    pub(crate) behind: Behind,
    /// Replaces the default of 1018h:04 if the behaviour has no serial number of its own.
    pub(crate) serial_number: Option<u32>,
    /// The parts of a device of a file.
    #[cfg(feature = "eds")]
    pub(crate) beside: Option<Beside>,
}

impl From<Behind> for Behaviour {
    fn from(behind: Behind) -> Self {
        Self {
            behind,
            serial_number: None,
            #[cfg(feature = "eds")]
            beside: None,
        }
    }
}

impl Behaviour {
    /// An encoder if the dictionary has a position value (6004h); otherwise no behaviour.
    pub(crate) fn of(dictionary: Dictionary<'_>) -> Self {
        let behind = match shaft::encoder_of(dictionary) {
            Some(encoder) => Behind::Encoder(Box::new(encoder)),
            None => Behind::Plain(NoApplication),
        };
        behind.into()
    }

    pub(crate) fn encoder(&self) -> Option<&Encoder<Shaft>> {
        match &self.behind {
            Behind::Encoder(encoder) => Some(encoder),
            _ => None,
        }
    }

    pub(crate) fn encoder_mut(&mut self) -> Option<&mut Encoder<Shaft>> {
        match &mut self.behind {
            Behind::Encoder(encoder) => Some(encoder),
            _ => None,
        }
    }

    /// The behaviour without the parts of a device of a file.
    pub(crate) fn own(&self) -> &dyn Application {
        match &self.behind {
            Behind::Encoder(encoder) => &**encoder,
            Behind::Plain(plain) => plain,
            Behind::Own(own) => &**own,
        }
    }

    /// The behaviour without the parts of a device of a file.
    pub(crate) fn own_mut(&mut self) -> &mut dyn Application {
        match &mut self.behind {
            Behind::Encoder(encoder) => &mut **encoder,
            Behind::Plain(plain) => plain,
            Behind::Own(own) => &mut **own,
        }
    }
}

impl Application for Behaviour {
    fn reset(&mut self, cx: &mut Context<'_, '_>, reset: Reset) {
        #[cfg(feature = "eds")]
        if let Some(beside) = &mut self.beside {
            beside.reset(cx, reset);
        }
        if let Some(number) = self.serial_number {
            cx.store
                .set_unsigned(Address::new(0x1018, 4), number.into());
        }
        self.own_mut().reset(cx, reset);
    }

    fn node_id(&self, store: &Store<'_>) -> Option<NodeId> {
        self.own().node_id(store)
    }

    fn is_live(&self, address: Address) -> bool {
        self.own().is_live(address)
    }

    fn refresh(&mut self, cx: &mut Context<'_, '_>, address: Address) -> Result<(), AbortCode> {
        self.own_mut().refresh(cx, address)
    }

    fn validate(
        &mut self,
        cx: &mut Context<'_, '_>,
        address: Address,
        value: &[u8],
    ) -> Result<(), AbortCode> {
        #[cfg(feature = "eds")]
        if let Some(beside) = &mut self.beside {
            beside.validate(cx, address, value)?;
        }
        self.own_mut().validate(cx, address, value)
    }

    fn written(&mut self, cx: &mut Context<'_, '_>, address: Address) {
        #[cfg(feature = "eds")]
        if let Some(beside) = &mut self.beside {
            beside.written(cx, address);
        }
        self.own_mut().written(cx, address);
    }

    fn stream(&mut self, address: Address) -> Option<&mut dyn Stream> {
        #[cfg(feature = "eds")]
        if self.beside.is_some() {
            return Some(self.stream_beside(address));
        }
        self.own_mut().stream(address)
    }

    fn saving(&mut self, cx: &mut Context<'_, '_>, begins: bool) {
        self.own_mut().saving(cx, begins);
    }

    fn storage_is(&mut self, sound: bool) {
        self.own_mut().storage_is(sound);
    }

    fn error_info(&self, store: &Store<'_>) -> [u8; 5] {
        self.own().error_info(store)
    }

    fn state_is(&mut self, cx: &mut Context<'_, '_>, state: State) {
        self.own_mut().state_is(cx, state);
    }

    fn master_lost(&mut self, cx: &mut Context<'_, '_>) {
        self.own_mut().master_lost(cx);
    }

    fn change_kind(&self, store: &Store<'_>, address: Address, last: u64, now: u64) -> ChangeKind {
        self.own().change_kind(store, address, last, now)
    }

    fn pins(&self) -> &'static [Pin] {
        self.own().pins()
    }

    fn pin(&self, number: usize) -> i64 {
        self.own().pin(number)
    }

    fn set_pin(&mut self, number: usize, value: i64) {
        self.own_mut().set_pin(number, value);
    }

    fn tick(&mut self, cx: &mut Context<'_, '_>) -> Option<Instant> {
        #[cfg(feature = "eds")]
        if let Some(beside) = &mut self.beside {
            let ticks = [beside.clock.tick(cx), self.own_mut().tick(cx)];
            return ticks.into_iter().flatten().min();
        }
        self.own_mut().tick(cx)
    }

    fn set_time(&mut self, cx: &mut Context<'_, '_>, time: TimeOfDay) {
        #[cfg(feature = "eds")]
        if let Some(beside) = &mut self.beside {
            return beside.clock.set(cx.now, time);
        }
        self.own_mut().set_time(cx, time);
    }

    fn time(&mut self, cx: &mut Context<'_, '_>) -> Option<TimeOfDay> {
        #[cfg(feature = "eds")]
        if let Some(beside) = &self.beside {
            return Some(beside.clock.time(cx.now));
        }
        self.own_mut().time(cx)
    }
}

/// Strings, DOMAINs and programs of a device of a file.
#[cfg(feature = "eds")]
impl Behaviour {
    fn long(&mut self) -> &mut Long {
        &mut self.beside.get_or_insert_default().long
    }

    /// The program that belongs to an object; otherwise the strings and DOMAINs.
    pub(crate) fn stream_beside(&mut self, address: Address) -> &mut dyn Stream {
        let programs = &mut self.beside.get_or_insert_default().programs;
        let loads = |loader: &mut Loader| loader.stream(address).is_some();
        match programs.iter_mut().position(loads) {
            Some(at) => &mut self.beside.get_or_insert_default().programs[at],
            None => self,
        }
    }

    /// Calls `look` with the bytes at an address.
    fn look<R>(
        &mut self,
        store: &Store<'_>,
        address: Address,
        look: impl FnOnce(&[u8]) -> R,
    ) -> Result<R, Halt> {
        if let Some(value) = self.long().get(address) {
            return Ok(look(value));
        }
        let entry = store.dictionary().find(address).map_err(AbortCode::from)?;
        Ok(look(store.bytes(&entry, &mut [0; 8])))
    }

    /// Stores a value whose last part was written.
    fn keep(&mut self, cx: &mut Context<'_, '_>, address: Address) -> Result<(), Halt> {
        let mut value = core::mem::take(self.long().coming(address));
        value.shrink_to_fit();
        self.own_mut().validate(cx, address, &value)?;
        let entry = cx
            .store
            .dictionary()
            .find(address)
            .map_err(AbortCode::from)?;
        self.long().remove(address);
        if value.len() <= room(&entry) {
            cx.store.put(&entry, &value)?;
        } else {
            // The store has no room for it, and holds the default, which is what 1010h saves.
            cx.store.reset_entry(&entry);
            self.long().values.push((address, value));
        }
        self.own_mut().written(cx, address);
        Ok(())
    }
}

/// Strings and DOMAINs of a device of a file.
#[cfg(feature = "eds")]
impl Stream for Behaviour {
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
        let limit = self.long().limit(cx.store, &entry);
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
        let limit = self.long().limit(cx.store, &entry);
        if self.long().coming(address).len() + chunk.bytes.len() > limit {
            return Err(AbortCode::TooLong.into());
        }
        self.long().coming(address).extend_from_slice(chunk.bytes);
        if chunk.last {
            self.keep(cx, address)
        } else {
            Ok(())
        }
    }

    fn begin_upload(&mut self, cx: &mut Context<'_, '_>, address: Address) -> Result<u32, Halt> {
        if address.index >= 0x2000 {
            self.own_mut().refresh(cx, address)?;
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
            // The value may have changed since the server announced its length.
            let part = value.get(at..at + to.len()).ok_or(AbortCode::General)?;
            to.copy_from_slice(part);
            Ok(())
        })?
    }

    fn end(&mut self, _: &mut Context<'_, '_>, address: Address, _: StreamEnd) {
        self.long().coming.retain(|(own, _)| *own != address);
    }
}
