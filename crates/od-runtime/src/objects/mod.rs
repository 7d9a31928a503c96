//! The one way to read and write an object, for SDO server and RPDOs.

pub(crate) mod command;
mod communication;
pub(crate) mod outbox;
mod saving;

use core::marker::PhantomData;

use od_model::Address;
use od_model::row::Row;

use crate::application::{Application, Context, Halt, Reset, Stream};
use crate::limits::{self, Outside};
use crate::profile::Profile;
use crate::services::{Services, may_have};
use crate::storage::Storage;
use crate::store::Store;
use od_wire::{AbortCode, Instant};

use command::Saving;
use outbox::{Outbox, live_bit};

pub(crate) use communication::check_mapped;

/// Reason why [`Objects::read`] returns no bytes.
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

/// Parts of the device during one call, with the requests of the services.
pub(crate) struct Objects<'c, D> {
    pub(crate) device: PhantomData<D>,
    pub(crate) store: Store<'c>,
    pub(crate) application: &'c mut dyn Application,
    pub(crate) storage: &'c mut dyn Storage,
    /// Options of the device family.
    pub(crate) profile: &'c Profile,
    pub(crate) now: Instant,
    pub(crate) outbox: &'c mut Outbox,
    /// A save in progress; `None`: the device has no storage.
    pub(crate) saving: Option<&'c mut Saving>,
}

impl<'c, D: Services> Objects<'c, D> {
    /// Whether the device may have an error history (1003h).
    pub(crate) const HAS_LOG: bool = may_have::<D>(0x1003, 0x1003, None);

    /// Whether the device may have values of variable length.
    const VARIES: bool = match &D::DICTIONARY {
        Some(dictionary) => dictionary.varying().is_some(),
        None => true,
    };

    /// Returns whether one of these bits of an object is set.
    pub(crate) fn has_bits(&self, (index, bits): (u16, u32)) -> bool {
        self.store.word(index, 0, 0) & bits != 0
    }

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
        self.store.row(address)
    }

    /// Returns the bytes of a readable object, brought up to date. `number` is memory for a value
    /// that is not in the store.
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
        Ok(self.store.value(row, number))
    }

    /// Checks a value that is not a plain number: it is readable, and the application does not stream it.
    fn check_special(&mut self, row: &Row) -> Result<(), Unread> {
        if !row.readable() {
            return Err(Unread::Abort(AbortCode::WriteOnly));
        }
        if self.streams(row) {
            return Err(Unread::Streamed);
        }
        Ok(())
    }

    /// Returns whether the application streams the value.
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

    /// Notes that a stream received a complete value.
    pub(crate) fn streamed(&mut self, address: Address) {
        self.outbox.written(address);
    }

    /// Resets the application, and asks which values are live. Objects of the communication area
    /// belong to the services and are never live.
    pub(crate) fn restart(&mut self, reset: Reset) {
        self.application(|application, context| application.reset(context, reset));
        let rows = self.store.dictionary().rows().iter();
        let own = rows.filter(|row| row.index() >= 0x2000);
        let live = own.filter(|row| self.application.is_live(row.address()));
        self.outbox.live = live.fold(0, |bits, row| bits | live_bit(row.address()));
    }

    /// Returns whether the application may have to bring a value up to date.
    pub(crate) fn is_live(&self, address: Address) -> bool {
        self.outbox.is_live(address)
    }

    /// Lets the application bring a live value up to date.
    pub(crate) fn refresh(&mut self, address: Address) -> Result<(), AbortCode> {
        if self.is_live(address) {
            self.refresh_live(address)
        } else {
            Ok(())
        }
    }

    fn refresh_live(&mut self, address: Address) -> Result<(), AbortCode> {
        self.application(|application, context| application.refresh(context, address))
    }

    /// Returns the row of a value, if it can be written.
    pub(crate) fn writable(&self, address: Address) -> Result<&'c Row, AbortCode> {
        let row = self.row(address)?;
        if row.writable() {
            Ok(row)
        } else {
            Err(AbortCode::ReadOnly)
        }
    }

    /// Returns how many of `len` bytes are used for the value.
    pub(crate) fn fit(&self, row: &Row, len: usize) -> Result<usize, AbortCode> {
        let rule = &self.profile.sdo.length;
        let (low, high) = match row.size() {
            0 if Self::VARIES => {
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

    /// Writes an object after all checks: access, length, limits, the rules of the services and of
    /// the application. Then it stores the value and notes its effects. A save or restore is only
    /// noted; [`carry_out`](Self::carry_out) executes it.
    pub(crate) fn write(&mut self, address: Address, bytes: &[u8]) -> Result<(), AbortCode> {
        let row = self.writable(address)?;
        self.change(row, bytes)
    }

    /// Writes an object for the device itself: as [`write`](Self::write), but without the
    /// check of the access type.
    pub(crate) fn set(&mut self, address: Address, bytes: &[u8]) -> Result<(), AbortCode> {
        let row = self.row(address)?;
        self.change(row, bytes)?;
        match self.carry_out() {
            Some(false) => Err(self.profile.store.failed),
            _ => Ok(()),
        }
    }

    /// Writes a value whose access was checked, as [`write`](Self::write) does.
    pub(crate) fn change(&mut self, row: &Row, bytes: &[u8]) -> Result<(), AbortCode> {
        let address = row.address();
        let len = self.fit(row, bytes.len())?;
        let bytes = bytes.get(..len).unwrap_or(bytes);
        if D::STORAGE
            && let Some(signature) = communication::command(address)
        {
            return self.command(address, signature, bytes);
        }
        let reals = match &D::DICTIONARY {
            Some(dictionary) => dictionary.reals(),
            None => self.store.dictionary().reals(),
        };
        limits::check_with(&self.store, row, bytes, reals)
            .map_err(|outside| self.refusal(address, outside))?;
        if address.index < 0x2000 {
            communication::check::<D>(&self.store, self.profile, row, bytes)?;
        }
        self.application(|application, context| application.validate(context, address, bytes))?;
        self.store.put_row(row, bytes)?;
        if Self::HAS_LOG && address == Address::new(0x1003, 0) {
            crate::emcy::clear_log::<D>(&mut self.store);
        }
        self.application(|application, context| application.written(context, address));
        self.outbox.written(address);
        Ok(())
    }

    /// Returns the abort code for a value outside its limits.
    fn refusal(&self, address: Address, outside: Outside) -> AbortCode {
        match outside {
            // A number of mapped objects above the limit has an abort code of its own.
            Outside::Above if communication::is_mapping_count(address) => AbortCode::PdoTooLong,
            Outside::Above => AbortCode::ValueTooHigh,
            Outside::Below => self.profile.sdo.below_limit,
            Outside::NotAllowed => AbortCode::ValueRange,
            Outside::Length => AbortCode::Length,
        }
    }

    /// Result of reading an entry of 1003h that contains no error.
    fn unused_error(&self, address: Address) -> Result<(), AbortCode> {
        match self.profile.sdo.unused_error {
            Some(code) if u32::from(address.sub) > self.store.word(0x1003, 0, 0) => Err(code),
            _ => Ok(()),
        }
    }
}
