//! The one way to read and write an object: SDO server and RPDOs come through here.

mod communication;
mod outbox;

use core::marker::PhantomData;

use od_model::{Address, Entry};

use crate::application::{Application, Context, Halt, Reset, Stream};
use crate::device::Device;
use crate::limits::{self, Outside};
use crate::profile::{Profile, SaveAnswer};
use crate::storage::{Storage, image};
use crate::store::Store;
use od_wire::{AbortCode, Instant};

use outbox::Saving;

pub(crate) use communication::check_mapped;
pub(crate) use outbox::{Effect, Outbox};

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
}

impl<'c, D: Device> Objects<'c, D> {
    /// Options of the device family: those that the compiler knows, or else those that were lent.
    #[inline(always)]
    pub(crate) fn profile(&self) -> &'c Profile {
        D::PROFILE.unwrap_or(self.lent_profile)
    }

    /// Whether one of these bits of an object is set.
    pub(crate) fn has_bits(&self, (index, bits): (u16, u32)) -> bool {
        self.store.unsigned(index, 0) & u64::from(bits) != 0
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

    /// The entry at an address.
    pub(crate) fn entry(&self, address: Address) -> Result<Entry, AbortCode> {
        Ok(self.store.dictionary().find(address)?)
    }

    /// The bytes of a readable object, brought up to date. `number` is room for a
    /// value that is not in the store.
    #[inline(always)] // into the one way from an SDO request to its answer
    pub(crate) fn read<'b>(
        &'b mut self,
        address: Address,
        number: &'b mut [u8; 8],
    ) -> Result<&'b [u8], Unread> {
        let (position, row) = self
            .store
            .dictionary()
            .locate(address)
            .map_err(AbortCode::from)?;
        let plain = row.plain();
        if plain.len == 0 {
            self.check_special(&self.store.dictionary().at(position))?;
        }
        if address.index == 0x1003 {
            self.unused_error(address)?;
        }
        self.refresh(address)?;
        Ok(match self.store.slot(plain) {
            [] => self
                .store
                .bytes(&self.store.dictionary().at(position), number),
            bytes => bytes,
        })
    }

    /// Whether a value that is not plain (a number in the store) can be read from the store.
    #[inline(never)]
    fn check_special(&mut self, entry: &Entry) -> Result<(), Unread> {
        if !entry.access.readable() {
            return Err(Unread::Abort(AbortCode::WriteOnly));
        }
        if self.streams(entry) {
            return Err(Unread::Streamed);
        }
        Ok(())
    }

    /// Whether the application streams the value.
    pub(crate) fn streams(&mut self, entry: &Entry) -> bool {
        D::STREAMS && entry.is_variable() && self.application.stream(entry.address).is_some()
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
        self.outbox.effect(Effect::Written(address));
    }

    /// Has the application bring a live value up to date.
    #[inline]
    pub(crate) fn refresh(&mut self, address: Address) -> Result<(), AbortCode> {
        // The communication area is the services' own; nothing in it is live.
        if address.index < 0x2000 {
            return Ok(());
        }
        self.application(|application, context| application.refresh(context, address))
    }

    /// Returns the entry, if it can be written and data of this length fits.
    pub(crate) fn writable(
        &self,
        address: Address,
        len: Option<usize>,
    ) -> Result<Entry, AbortCode> {
        let entry = self.entry(address)?;
        if !entry.access.writable() {
            return Err(AbortCode::ReadOnly);
        }
        if let Some(len) = len {
            self.fit(&entry, len)?;
        }
        Ok(entry)
    }

    /// Returns how many of `len` bytes the entry accepts.
    fn fit(&self, entry: &Entry, len: usize) -> Result<usize, AbortCode> {
        let rule = &self.profile().sdo.length;
        let (low, high) = match entry.data_type.size() {
            Some(size) => (size, size),
            None => (0, usize::from(entry.slot.len.saturating_sub(2))),
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
        let entry = self.writable(address, None)?;
        self.change(&entry, bytes)
    }

    /// Writes an object from the side of the device: as [`write`](Self::write), but for the access.
    pub(crate) fn set(&mut self, address: Address, bytes: &[u8]) -> Result<(), AbortCode> {
        let entry = self.entry(address)?;
        self.change(&entry, bytes)
    }

    fn change(&mut self, entry: &Entry, bytes: &[u8]) -> Result<(), AbortCode> {
        let address = entry.address;
        let len = self.fit(entry, bytes.len())?;
        let bytes = &bytes[..len];
        if D::STORAGE
            && let Some(signature) = communication::command(address)
        {
            return self.command(entry, signature, bytes);
        }
        limits::check(&self.store, entry, bytes)
            .map_err(|outside| self.refusal(address, outside))?;
        if address.index < 0x2000 {
            communication::check(&self.store, self.profile(), entry, bytes)?;
        }
        self.application(|application, context| application.validate(context, address, bytes))?;
        self.store.put(entry, bytes)?;
        if address == Address::new(0x1003, 0) {
            crate::emcy::clear_log(&mut self.store);
        }
        self.application(|application, context| application.written(context, address));
        self.outbox.effect(Effect::Written(address));
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
    fn command(
        &mut self,
        entry: &Entry,
        signature: [u8; 4],
        bytes: &[u8],
    ) -> Result<(), AbortCode> {
        if bytes != signature {
            return Err(AbortCode::NotStored);
        }
        let sub = entry.address.sub;
        // What a save writes in the background is there before anything follows.
        self.complete_save();
        if entry.address.index == 0x1010 {
            return self.save(sub);
        }
        let profile = &self.profile().store;
        image::erase(self.storage, &self.store, profile, sub).map_err(|_| profile.failed)?;
        self.storage_is_sound();
        if profile.restore == crate::profile::Restore::AtOnce {
            let which = |entry: &Entry| image::restores(profile, entry, sub);
            profile.reset(&mut self.store, &which);
            self.application(|application, context| application.reset(context, Reset::Defaults));
        }
        self.outbox.effect(Effect::Restored(sub));
        Ok(())
    }

    /// 1010h: the values of this moment, complete at once or in a while.
    fn save(&mut self, sub: u8) -> Result<(), AbortCode> {
        let profile = &self.profile().store;
        self.refresh_life_record();
        self.application(|application, context| application.saving(context, true));
        let pending = image::begin(self.storage, &self.store, profile, sub);
        self.application(|application, context| application.saving(context, false));
        let Ok(pending) = pending else {
            self.outbox.effect(Effect::NotSaved);
            return Err(profile.failed);
        };
        self.outbox.saving = Some(Saving {
            pending,
            sub,
            due: self.now.plus_micros(profile.duration_us.into()),
        });
        if profile.duration_us > 0 {
            self.outbox.answer_later = profile.answer == SaveAnswer::AfterStoring;
            self.outbox.effect(Effect::Saving);
            Ok(())
        } else if self.complete_save() {
            Ok(())
        } else {
            Err(profile.failed)
        }
    }

    /// Ends a save that goes on, if there is one; `false` where it failed.
    pub(crate) fn complete_save(&mut self) -> bool {
        let Some(Saving { pending, sub, .. }) = self.outbox.saving.take() else {
            return true;
        };
        let done = image::commit(self.storage, pending).is_ok();
        if done {
            self.storage_is_sound();
        }
        self.outbox.effect(if done {
            Effect::Saved(sub)
        } else {
            Effect::NotSaved
        });
        done
    }

    /// The application may report the end of an error that it found at the start.
    fn storage_is_sound(&mut self) {
        self.application.storage_is(true);
        self.outbox.signals.wake();
    }

    /// Updates the operating records before they are saved.
    pub(crate) fn refresh_life_record(&mut self) {
        let entries = self.store.dictionary().entries();
        for entry in entries.filter(image::is_life_record) {
            // A value that cannot be updated is saved as it is.
            let _ = self.refresh(entry.address);
        }
    }

    /// Reading an entry of 1003h that holds no error.
    #[inline(never)]
    fn unused_error(&self, address: Address) -> Result<(), AbortCode> {
        match self.profile().sdo.unused_error {
            Some(code) if u64::from(address.sub) > self.store.unsigned(0x1003, 0) => Err(code),
            _ => Ok(()),
        }
    }
}
