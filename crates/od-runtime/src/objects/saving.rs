//! Saving and restoring (1010h, 1011h). A download is a command, which is carried out when the service that
//! received it is done: that is as deep as the stack gets.

use od_model::Address;
use od_model::row::Row;
use od_wire::AbortCode;

use super::Objects;
use super::command::{Command, KEEP, RESTORE};
use super::outbox::Effect;
use crate::application::Reset;
use crate::deadline::Deadline;
use crate::profile::{Restore, SaveAnswer};
use crate::services::Services;
use crate::storage::Save;
use crate::storage::image::{self, Banks, Loaded, Medium, Plan};

/// Time until a memory that is still writing is asked again, in microseconds.
const ASK_AGAIN_US: u32 = 2_000;

impl<D: Services> Objects<'_, D> {
    /// The [device](image::device) whose values are saved, as far as the compiler knows it.
    const DEVICE: Option<u32> = match &D::DICTIONARY {
        Some(dictionary) => Some(image::device(dictionary)),
        None => None,
    };

    /// There are operating records, as far as the compiler knows.
    const HAS_LIFE_RECORD: bool = match &D::DICTIONARY {
        Some(dictionary) => {
            let mut rest = dictionary.rows();
            let mut found = false;
            while let [row, others @ ..] = rest {
                found |= image::is_life_record(row);
                rest = others;
            }
            found
        }
        None => true,
    };

    /// The [device](image::device) whose values are saved.
    #[inline]
    pub(crate) fn device(&self) -> u32 {
        match Self::DEVICE {
            Some(device) => device,
            None => image::device(self.store.dictionary()),
        }
    }

    /// Puts saved values over those of the store, for the entries that `which` names; no save goes on.
    /// A storage that cannot be read is damaged.
    pub(crate) fn load(&mut self, which: &dyn Fn(&Row) -> bool) -> Loaded {
        let (device, profile) = (self.device(), &self.profile.store);
        let Some(saving) = &mut self.saving else {
            return Loaded::Blank;
        };
        let mut medium = Medium::new(self.storage, &mut saving.banks);
        let loaded = medium
            .survey(device)
            .and_then(|()| image::take_over(&mut medium, &mut self.store, profile, which));
        loaded.unwrap_or(Loaded::Damaged)
    }

    /// 1010h and 1011h: the signature is the value, and nothing is kept of it.
    pub(super) fn command(
        &mut self,
        address: Address,
        signature: [u8; 4],
        bytes: &[u8],
    ) -> Result<(), AbortCode> {
        if bytes != signature {
            return Err(AbortCode::NotStored);
        }
        if let Some(saving) = &mut self.saving {
            saving.command = match address.index {
                0x1010 => Command::Save(address.sub),
                _ => Command::Restore(address.sub),
            };
        }
        Ok(())
    }

    /// Returns whether there is something to [carry out](Self::carry_out).
    pub(crate) fn is_commanded(&self) -> bool {
        let saving = self.saving.as_ref();
        D::STORAGE && saving.is_some_and(|saving| saving.command != Command::None)
    }

    /// Carries out what was commanded: `Some(false)` where it failed, `None` if nothing was, or its end
    /// is to be waited for.
    #[inline]
    pub(crate) fn carry_out(&mut self) -> Option<bool> {
        let saving = self.saving.as_mut().filter(|_| D::STORAGE)?;
        match core::mem::take(&mut saving.command) {
            Command::None => None,
            command => self.execute(command),
        }
    }

    /// Saves the operating records, unless a save goes on, which has them. Returns whether that failed.
    pub(crate) fn keep(&mut self) -> bool {
        !self.is_saving() && self.execute(KEEP) == Some(false)
    }

    /// A command, in parts each of which takes much of a small stack.
    fn execute(&mut self, command: Command) -> Option<bool> {
        if command != KEEP {
            // What a save writes in the background is there before anything follows.
            self.complete_save();
        }
        if let Command::Save(_) = command {
            self.prepare(command);
        }
        let begun = self.begin(command);
        match command {
            KEEP => Some(begun && self.kept()),
            Command::Save(sub) => self.saved(sub, begun),
            Command::Restore(sub) => self.restored(sub, begun),
            Command::None => None,
        }
    }

    /// The operating records: they are saved, or will be, and only a failure is reported.
    fn kept(&mut self) -> bool {
        let is_done = self.commit();
        if self.storage.is_writing() {
            self.await_memory(RESTORE);
        }
        is_done
    }

    /// The set that a command makes is written, but for its commit word. Returns whether that is done.
    fn begin(&mut self, command: Command) -> bool {
        let (device, profile) = (self.device(), &self.profile.store);
        let Some(saving) = &mut self.saving else {
            return false;
        };
        let (restores, sub) = match command {
            Command::Restore(sub) => (true, sub),
            Command::Save(sub) => (false, sub),
            Command::None => return false,
        };
        let store = &self.store;
        if self.storage.take(&Save {
            restores,
            sub,
            device,
            store,
            profile,
        }) {
            saving.banks = Banks::NONE;
            return true;
        }
        let plan = if restores {
            Plan::Restore(sub)
        } else {
            Plan::Save(sub)
        };
        let mut medium = Medium::new(self.storage, &mut saving.banks);
        let mut begun = medium.survey(device);
        if begun.is_ok() {
            begun = medium.begin(&self.store, profile, &plan);
        }
        if begun.is_err() {
            saving.banks = Banks::NONE;
        }
        begun.is_ok()
    }

    /// The values of this moment are to be saved.
    fn prepare(&mut self, command: Command) {
        self.refresh_life_record();
        if command != KEEP {
            self.tell(true);
        }
    }
    /// 1010h: complete at once or in a while.
    fn saved(&mut self, sub: u8, begun: bool) -> Option<bool> {
        self.tell(false);
        self.saving.as_mut()?.sub = sub;
        let profile = &self.profile.store;
        if begun && profile.duration_us > 0 {
            self.await_end(profile.duration_us);
            return (profile.answer == SaveAnswer::AtOnce).then_some(true);
        }
        self.end_save(begun)
    }

    /// The application hears that its values are about to be saved, and that they have been read.
    fn tell(&mut self, begins: bool) {
        self.application(|application, context| application.saving(context, begins));
    }

    /// 1011h: at once, or at the next reset.
    fn restored(&mut self, sub: u8, begun: bool) -> Option<bool> {
        if !(begun && self.commit()) {
            return Some(false);
        }
        self.storage_is_sound();
        let profile = &self.profile.store;
        if profile.restore == Restore::AtOnce {
            let which = |row: &Row| image::restores(profile, row, sub);
            profile.reset(&mut self.store, &which);
            self.application(|application, context| application.reset(context, Reset::Defaults));
        }
        self.outbox.effect(Effect::Restored(sub));
        if self.storage.is_writing() {
            self.await_memory(RESTORE);
            return None;
        }
        Some(true)
    }

    /// Writes the commit word, if a set waits for it. Returns whether that is done.
    fn commit(&mut self) -> bool {
        let saving = self.saving.as_mut();
        saving.is_some_and(|saving| {
            let mut medium = Medium::new(self.storage, &mut saving.banks);
            medium.commit().is_ok()
        })
    }

    /// Ends a save that goes on, if there is one; `Some(false)` where it failed, `None` while the
    /// memory is still writing.
    pub(crate) fn complete_save(&mut self) -> Option<bool> {
        if self.is_saving() {
            self.end_save(true)
        } else {
            Some(true)
        }
    }

    /// The end of a save of which all but the commit word is written; else it failed.
    fn end_save(&mut self, begun: bool) -> Option<bool> {
        self.forget_save();
        let saving = self.saving.as_mut()?;
        let (sub, has_set) = (saving.sub, saving.banks.is_some());
        let is_written = begun && self.commit();
        if is_written && self.storage.is_writing() {
            self.await_memory(sub);
            return None;
        }
        let done = is_written && (has_set || self.storage.flush().is_ok());
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

    /// All is written to RAM, and the memory that keeps it has not confirmed it yet.
    fn await_memory(&mut self, sub: u8) {
        if let Some(saving) = &mut self.saving {
            saving.sub = sub;
        }
        self.await_end(ASK_AGAIN_US);
    }

    fn await_end(&mut self, micros: u32) {
        if let Some(saving) = &mut self.saving {
            saving.due = Deadline::at(self.now.plus_micros(micros.into()));
        }
    }

    /// Returns whether a save goes on.
    fn is_saving(&self) -> bool {
        let saving = self.saving.as_ref().filter(|_| D::STORAGE);
        saving.is_some_and(|saving| saving.due.is_set())
    }

    /// Time when the save that goes on is complete.
    pub(crate) fn save_due(&self) -> Deadline {
        let saving = self.saving.as_ref().filter(|_| D::STORAGE);
        saving.map_or(Deadline::NEVER, |saving| saving.due)
    }

    /// Drops the save that is not complete.
    pub(crate) fn forget_save(&mut self) {
        if let Some(saving) = &mut self.saving {
            saving.due = Deadline::NEVER;
        }
    }

    /// The application may report the end of an error that it found at the start.
    fn storage_is_sound(&mut self) {
        self.application.storage_is(true);
        self.outbox.signals.wake();
    }

    /// Updates the operating records before they are saved.
    fn refresh_life_record(&mut self) {
        if !Self::HAS_LIFE_RECORD {
            return;
        }
        for row in self.store.dictionary().rows() {
            if image::is_life_record(row) {
                // A value that cannot be updated is saved as it is.
                let _ = self.refresh(row.address());
            }
        }
    }
}
