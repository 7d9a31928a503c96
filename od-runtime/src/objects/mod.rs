//! The one way to read and write an object: SDO server and RPDOs come through here.

mod communication;
pub(crate) mod outbox;

use core::marker::PhantomData;

use od_model::Address;
use od_model::row::Row;

use crate::application::{Application, Context, Halt, Reset, Stream};
use crate::deadline::Deadline;
use crate::device::{Device, may_have};
use crate::limits::{self, Outside};
use crate::profile::{Profile, SaveAnswer};
use crate::storage::{Storage, image};
use crate::store::Store;
use od_wire::{AbortCode, Instant};

use outbox::{Effect, Outbox, RESTORE, Saving, live_bit};

pub(crate) use communication::check_mapped;

/// Time until a memory that is still writing is asked again, in microseconds.
const ASK_AGAIN_US: u64 = 2_000;

/// Reason why [`Objects::read`] has no bytes.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(crate) enum Unread {
    Abort(AbortCode),
    /// The application streams the value.
    Streamed,
}

impl From<AbortCode> for Unread {
    fn from(code: AbortCode) -> Self {
        Self::Abort(code)
    }
}

/// The device for the length of one call, with what the services add.
pub(crate) struct Objects<'c, D> {
    pub(crate) device: PhantomData<D>,
    pub(crate) store: Store<'c>,
    pub(crate) application: &'c mut dyn Application,
    pub(crate) storage: &'c mut dyn Storage,
    /// See [`profile`](Self::profile).
    pub(crate) lent_profile: &'c Profile,
    pub(crate) now: Instant,
    pub(crate) outbox: &'c mut Outbox,
    /// A save that is not complete, which outlasts the call; a device without storage has no room for one.
    pub(crate) saving: Option<&'c mut Option<Saving>>,
}

impl<'c, D: Device> Objects<'c, D> {
    /// The device may have a log of its errors.
    pub(crate) const HAS_LOG: bool = may_have::<D>(0x1003, 0x1003, None);

    /// Options of the device family: those that the compiler knows, or else those that were lent.
    #[inline(always)]
    pub(crate) fn profile(&self) -> &'c Profile {
        D::PROFILE.unwrap_or(self.lent_profile)
    }

    /// Whether one of these bits of an object is set.
    pub(crate) fn has_bits(&self, (index, bits): (u16, u32)) -> bool {
        self.store.word(index, 0, 0) & bits != 0
    }

    /// Calls the application with its context.
    #[inline]
    pub(crate) fn application<R>(
        &mut self,
        call: impl FnOnce(&mut dyn Application, &mut Context<'_, 'c>) -> R,
    ) -> R {
        let mut context = Context {
            store: &mut self.store,
            now: self.now,
            signals: &mut self.outbox.signals,
        };
        call(self.application, &mut context)
    }

    /// The row of the value at an address.
    pub(crate) fn row(&self, address: Address) -> Result<&'c Row, AbortCode> {
        Ok(self.store.dictionary().row_of(address)?)
    }

    /// The bytes of a readable object, brought up to date. `number` is room for a
    /// value that is not in the store.
    pub(crate) fn read<'b>(
        &'b mut self,
        address: Address,
        number: &'b mut [u8; 8],
    ) -> Result<&'b [u8], Unread> {
        let row = self.row(address)?;
        let plain = row.plain();
        if plain.len == 0 {
            self.check_special(row)?;
        }
        if Self::HAS_LOG && address.index == 0x1003 {
            self.unused_error(address)?;
        }
        self.refresh(address)?;
        Ok(match self.store.slot(plain) {
            [] => self.store.value(row, number),
            bytes => bytes,
        })
    }

    /// Whether a value that is not plain (a number in the store) can be read from the store.
    #[inline(never)]
    fn check_special(&mut self, row: &Row) -> Result<(), Unread> {
        if !row.readable() {
            return Err(Unread::Abort(AbortCode::WriteOnly));
        }
        if self.streams(row) {
            return Err(Unread::Streamed);
        }
        Ok(())
    }

    /// Whether the application streams the value.
    pub(crate) fn streams(&mut self, row: &Row) -> bool {
        D::STREAMS && row.is_variable() && self.application.stream(row.address()).is_some()
    }

    /// Calls the stream of a value.
    pub(crate) fn stream<R>(
        &mut self,
        address: Address,
        call: impl FnOnce(&mut dyn Stream, &mut Context<'_, 'c>) -> Result<R, Halt>,
    ) -> Result<R, Halt> {
        self.application(|application, context| match application.stream(address) {
            Some(stream) => call(stream, context),
            None => Err(Halt::Abort(AbortCode::NoResource)),
        })
    }

    /// A stream took all of a value.
    pub(crate) fn streamed(&mut self, address: Address) {
        self.outbox.written(address);
    }

    /// Asks the application which values are live. The communication area is the services' own;
    /// nothing in it is.
    pub(crate) fn look_for_live(&mut self) {
        let rows = self.store.dictionary().rows().iter();
        let own = rows.filter(|row| row.index() >= 0x2000);
        let live = own.filter(|row| self.application.is_live(row.address()));
        self.outbox.live = live.fold(0, |bits, row| bits | live_bit(row.address()));
    }

    /// Whether the application may have to bring a value up to date.
    #[inline(always)]
    pub(crate) fn is_live(&self, address: Address) -> bool {
        self.outbox.is_live(address)
    }

    /// Has the application bring a live value up to date.
    #[inline(always)]
    pub(crate) fn refresh(&mut self, address: Address) -> Result<(), AbortCode> {
        match self.is_live(address) {
            true => self.refresh_live(address),
            false => Ok(()),
        }
    }

    #[inline(never)]
    fn refresh_live(&mut self, address: Address) -> Result<(), AbortCode> {
        self.application(|application, context| application.refresh(context, address))
    }

    /// Returns the row of a value, if it can be written.
    #[inline(never)]
    pub(crate) fn writable(&self, address: Address) -> Result<&'c Row, AbortCode> {
        let row = self.row(address)?;
        match row.writable() {
            true => Ok(row),
            false => Err(AbortCode::ReadOnly),
        }
    }

    /// Returns how many of `len` bytes the value accepts.
    #[inline(never)]
    pub(crate) fn fit(&self, row: &Row, len: usize) -> Result<usize, AbortCode> {
        let rule = &self.profile().sdo.length;
        let (low, high) = match row.size() {
            0 => {
                let slot = row.slot(self.store.dictionary().pool());
                (0, usize::from(slot.len.saturating_sub(2)))
            }
            size => (size, size),
        };
        if len < low {
            return Err(rule.too_short);
        }
        match rule.too_long {
            Some(code) if len > high => Err(code),
            _ => Ok(len.min(high)),
        }
    }

    /// Writes an object with everything that belongs to it: access, length, limits, the
    /// services' and the application's rules, then the value, then what follows from it.
    pub(crate) fn write(&mut self, address: Address, bytes: &[u8]) -> Result<(), AbortCode> {
        let row = self.writable(address)?;
        self.change(row, bytes)
    }

    /// Writes an object from the side of the device: as [`write`](Self::write), but for the access.
    pub(crate) fn set(&mut self, address: Address, bytes: &[u8]) -> Result<(), AbortCode> {
        let row = self.row(address)?;
        self.change(row, bytes)
    }

    /// Writes a value of which it is known that it may be written.
    #[inline(never)]
    pub(crate) fn change(&mut self, row: &Row, bytes: &[u8]) -> Result<(), AbortCode> {
        let address = row.address();
        let len = self.fit(row, bytes.len())?;
        let bytes = bytes.get(..len).unwrap_or(bytes);
        if D::STORAGE
            && let Some(signature) = communication::command(address)
        {
            return self.command(address, signature, bytes);
        }
        limits::check(&self.store, row, bytes).map_err(|outside| self.refusal(address, outside))?;
        if address.index < 0x2000 {
            communication::check::<D>(&self.store, self.profile(), row, bytes)?;
        }
        self.application(|application, context| application.validate(context, address, bytes))?;
        self.store.put_row(row, bytes)?;
        if Self::HAS_LOG && address == Address::new(0x1003, 0) {
            crate::emcy::clear_log(&mut self.store);
        }
        self.application(|application, context| application.written(context, address));
        self.outbox.written(address);
        Ok(())
    }

    /// Returns the abort code for a value outside its limits.
    fn refusal(&self, address: Address, outside: Outside) -> AbortCode {
        match outside {
            // More objects than a mapping has room for are too many, not too great a number.
            Outside::Above if communication::is_mapping_count(address) => AbortCode::PdoTooLong,
            Outside::Above => AbortCode::ValueTooHigh,
            Outside::Below => self.profile().sdo.below_limit,
            Outside::NotAllowed => AbortCode::ValueRange,
            Outside::Length => AbortCode::Length,
        }
    }

    /// 1010h and 1011h: the signature is the value, and nothing is kept of it.
    #[inline(never)]
    fn command(
        &mut self,
        address: Address,
        signature: [u8; 4],
        bytes: &[u8],
    ) -> Result<(), AbortCode> {
        if bytes != signature {
            return Err(AbortCode::NotStored);
        }
        let sub = address.sub;
        // What a save writes in the background is there before anything follows.
        self.complete_save();
        if address.index == 0x1010 {
            return self.save(sub);
        }
        let profile = &self.profile().store;
        image::erase(self.storage, &self.store, profile, sub).map_err(|_| profile.failed)?;
        self.storage_is_sound();
        if profile.restore == crate::profile::Restore::AtOnce {
            let which = |row: &Row| image::restores(profile, row, sub);
            profile.reset(&mut self.store, &which);
            self.application(|application, context| application.reset(context, Reset::Defaults));
        }
        self.outbox.effect(Effect::Restored(sub));
        if self.storage.is_writing() {
            self.await_memory(RESTORE);
            self.outbox.answer_later = true;
        }
        Ok(())
    }

    /// 1010h: the values of this moment, complete at once or in a while.
    #[inline(never)]
    fn save(&mut self, sub: u8) -> Result<(), AbortCode> {
        let profile = &self.profile().store;
        self.refresh_life_record();
        self.application(|application, context| application.saving(context, true));
        let mut saving = Saving {
            pending: image::Pending::NONE,
            sub,
            due: self.now.plus_micros(profile.duration_us.into()),
        };
        let pending = &mut saving.pending;
        let begun = image::begin(self.storage, &self.store, profile, sub, pending);
        self.application(|application, context| application.saving(context, false));
        if begun.is_err() {
            self.outbox.effect(Effect::NotSaved);
            return Err(profile.failed);
        }
        self.begin_save(saving);
        if profile.duration_us > 0 {
            self.outbox.answer_later = profile.answer == SaveAnswer::AfterStoring;
            self.outbox.effect(Effect::Saving);
            return Ok(());
        }
        let done = self.complete_save();
        self.outbox.answer_later = done.is_none();
        match done {
            Some(false) => Err(profile.failed),
            _ => Ok(()),
        }
    }

    /// Ends a save that goes on, if there is one; `Some(false)` where it failed, `None` while the
    /// memory is still writing.
    pub(crate) fn complete_save(&mut self) -> Option<bool> {
        let Some(Saving { pending, sub, .. }) = self.forget_save() else {
            return Some(true);
        };
        let is_written = !pending.is_some() || image::commit(self.storage, &pending).is_ok();
        if is_written && self.storage.is_writing() {
            self.await_memory(sub);
            return None;
        }
        let done = is_written && (pending.is_some() || self.storage.flush().is_ok());
        if done {
            self.storage_is_sound();
        }
        match sub {
            _ if !done => self.outbox.effect(Effect::NotSaved),
            RESTORE => {}
            sub => self.outbox.effect(Effect::Saved(sub)),
        }
        Some(done)
    }

    /// All is written, and on its way to the memory that keeps it.
    fn await_memory(&mut self, sub: u8) {
        self.begin_save(Saving {
            pending: image::Pending::NONE,
            sub,
            due: self.now.plus_micros(ASK_AGAIN_US),
        });
        self.outbox.effect(Effect::Saving);
    }

    fn begin_save(&mut self, saving: Saving) {
        if let Some(room) = &mut self.saving {
            **room = Some(saving);
        }
    }

    /// Whether a save goes on.
    pub(crate) fn is_saving(&self) -> bool {
        matches!(&self.saving, Some(Some(_)))
    }

    /// When the save that goes on is complete.
    pub(crate) fn save_due(&self) -> Deadline {
        match &self.saving {
            Some(Some(saving)) => Deadline::at(saving.due),
            _ => Deadline::NEVER,
        }
    }

    /// The save that is not complete is no more.
    pub(crate) fn forget_save(&mut self) -> Option<Saving> {
        self.saving.as_mut().and_then(|saving| saving.take())
    }

    /// The application may report the end of an error that it found at the start.
    fn storage_is_sound(&mut self) {
        self.application.storage_is(true);
        self.outbox.signals.wake();
    }

    /// Updates the operating records before they are saved.
    pub(crate) fn refresh_life_record(&mut self) {
        for row in self.store.dictionary().rows() {
            if image::is_life_record(row) {
                // A value that cannot be updated is saved as it is.
                let _ = self.refresh(row.address());
            }
        }
    }

    /// Reading an entry of 1003h that holds no error.
    #[inline(never)]
    fn unused_error(&self, address: Address) -> Result<(), AbortCode> {
        match self.profile().sdo.unused_error {
            Some(code) if u32::from(address.sub) > self.store.word(0x1003, 0, 0) => Err(code),
            _ => Ok(()),
        }
    }
}
