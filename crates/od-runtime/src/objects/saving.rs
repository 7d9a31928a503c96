//! Saving and restoring (1010h, 1011h). A download only notes a command. The node carries it out
//! after the service has returned, because a save needs more stack than anything else.

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
    /// The [device](image::device) number of the values, if the compiler knows it.
    const DEVICE: Option<u32> = match &D::DICTIONARY {
        Some(dictionary) => Some(image::device(dictionary)),
        None => None,
    };

    /// Whether there are operating records, if the compiler knows it.
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

    /// The [device](image::device) number of the values.
    #[inline]
    pub(crate) fn device(&self) -> u32 {
        match Self::DEVICE {
            Some(device) => device,
            None => image::device(self.store.dictionary()),
        }
    }

    /// Loads the saved values of the entries for which `which` is true into the store. No save may
    /// be in progress. A storage that cannot be read counts as damaged.
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

    /// Notes the command of a download to 1010h or 1011h: the value must be the signature, and is
    /// not stored.
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

    /// Returns whether there is a command to [carry out](Self::carry_out).
    pub(crate) fn is_commanded(&self) -> bool {
        let saving = self.saving.as_ref();
        D::STORAGE && saving.is_some_and(|saving| saving.command != Command::None)
    }

    /// Carries out the command. Returns `Some(false)` if it failed, `None` if there was no command
    /// or it is not complete yet.
    #[inline]
    pub(crate) fn carry_out(&mut self) -> Option<bool> {
        let saving = self.saving.as_mut().filter(|_| D::STORAGE)?;
        match core::mem::take(&mut saving.command) {
            Command::None => None,
            command => self.execute(command),
        }
    }

    /// Saves the operating records, unless a save is in progress, which includes them. Returns
    /// whether that failed.
    pub(crate) fn keep(&mut self) -> bool {
        !self.is_saving() && self.execute(KEEP) == Some(false)
    }

    /// Executes a command. Each part is a function of its own, since each needs much of a small stack.
    fn execute(&mut self, command: Command) -> Option<bool> {
        if command != KEEP {
            // A save in the background must be complete before this one begins.
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

    /// Ends a save of the operating records. Only a failure is reported.
    fn kept(&mut self) -> bool {
        let is_done = self.commit();
        if self.storage.is_writing() {
            self.await_memory(RESTORE);
        }
        is_done
    }

    /// Writes the set of a command, except its commit word. Returns whether that succeeded.
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

    /// Prepares the current values for a save.
    fn prepare(&mut self, command: Command) {
        self.refresh_life_record();
        if command != KEEP {
            self.announce_save(true);
        }
    }

    /// Ends 1010h, at once or after the duration of a save.
    fn saved(&mut self, sub: u8, begun: bool) -> Option<bool> {
        self.announce_save(false);
        self.saving.as_mut()?.sub = sub;
        let profile = &self.profile.store;
        if begun && profile.duration_us > 0 {
            self.await_end(profile.duration_us);
            return (profile.answer == SaveAnswer::AtOnce).then_some(true);
        }
        self.end_save(begun)
    }

    /// Tells the application that its values will be saved, or that they have been read.
    fn announce_save(&mut self, begins: bool) {
        self.application(|application, context| application.saving(context, begins));
    }

    /// Ends 1011h: the defaults apply at once, or at the next reset.
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

    /// Writes the commit word, if a set waits for it. Returns whether that succeeded.
    fn commit(&mut self) -> bool {
        let saving = self.saving.as_mut();
        saving.is_some_and(|saving| {
            let mut medium = Medium::new(self.storage, &mut saving.banks);
            medium.commit().is_ok()
        })
    }

    /// Ends the save in progress, if there is one. Returns `Some(false)` if it failed, `None` while
    /// the memory is still writing.
    pub(crate) fn complete_save(&mut self) -> Option<bool> {
        if self.is_saving() {
            self.end_save(true)
        } else {
            Some(true)
        }
    }

    /// Ends a save. `begun`: all is written except the commit word; otherwise the save failed.
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

    /// Waits for the memory, which has not confirmed the written bytes yet.
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

    /// Returns whether a save is in progress.
    fn is_saving(&self) -> bool {
        let saving = self.saving.as_ref().filter(|_| D::STORAGE);
        saving.is_some_and(|saving| saving.due.is_set())
    }

    /// Time when the save in progress is complete.
    pub(crate) fn save_due(&self) -> Deadline {
        let saving = self.saving.as_ref().filter(|_| D::STORAGE);
        saving.map_or(Deadline::NEVER, |saving| saving.due)
    }

    /// Drops the save in progress.
    pub(crate) fn forget_save(&mut self) {
        if let Some(saving) = &mut self.saving {
            saving.due = Deadline::NEVER;
        }
    }

    /// Lets the application report the end of an error that it found at the start.
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
