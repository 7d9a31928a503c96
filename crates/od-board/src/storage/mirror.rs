//! Saved values in RAM, from where a task writes them to flash.

use core::ops::Range;
use core::task::{Context, Poll, Waker};

use od_model::Dictionary;
use od_runtime::storage::{Save, Storage, StorageError, image};

/// Storage of a node whose saves are written to flash in the background. A save copies the values,
/// and a task of lower priority makes the set and stores it: [`Log`](super::Log), or your own task
/// with [`poll_changed`](Self::poll_changed), [`step`](Self::step), [`newest`](Self::newest) and
/// [`stored`](Self::stored).
///
/// `N` is [`image::capacity_needed`] of the dictionary, plus [`image::OWN_CAPACITY`] if LSS stores
/// the node ID. `V` is the number of bytes of all values, `STORE_LEN` of the dictionary's module.
/// Without such a task the node never responds to 1010h.
#[derive(Debug)]
pub struct Mirror<const N: usize, const V: usize> {
    dictionary: &'static Dictionary<'static>,
    device: u32,
    sets: Sets<N>,
    /// Values of a save; the next steps make a set of them.
    values: [u8; V],
    job: Option<image::Job>,
    /// Range of the newest set, if it is known.
    newest: Option<Range<usize>>,
    /// Number of saves and writes so far.
    changes: u32,
    /// `changes` when the newest set was made.
    made: u32,
    /// `changes` of the set that is in the flash.
    kept: u32,
    failed: bool,
    /// Reason why the stored set could not be loaded.
    lost: Option<StorageError>,
    waker: Option<Waker>,
}

/// Two banks.
#[derive(Debug)]
struct Sets<const N: usize>([u8; N]);

impl<const N: usize, const V: usize> Mirror<N, V> {
    /// A mirror without saved values, for a node with this dictionary.
    ///
    /// # Panics
    /// In a constant: does not compile. `V` must be enough for the values.
    pub const fn new(dictionary: &'static Dictionary<'static>) -> Self {
        assert!(
            dictionary.store_len() <= V,
            "a mirror has room for all values of its dictionary: `STORE_LEN`"
        );
        Self {
            dictionary,
            device: image::device(dictionary),
            sets: Sets([0xFF; N]),
            values: [0; V],
            job: None,
            newest: Some(0..0),
            changes: 0,
            made: 0,
            kept: 0,
            failed: false,
            lost: None,
            waker: None,
        }
    }

    /// Loads a set that [`newest`](Self::newest) returned earlier; call it before the node has
    /// power.
    ///
    /// # Errors
    /// [`StorageError::OutOfRange`] if it is longer than `N / 2` bytes, as the set of a firmware
    /// with more values can be. It is [lost](Self::lose) then.
    pub fn load(&mut self, set: &[u8]) -> Result<(), StorageError> {
        self.sets.0.fill(0xFF);
        (self.newest, self.job, self.lost) = (None, None, None);
        (self.made, self.kept) = (self.changes, self.changes);
        match self.sets.0.get_mut(..set.len()) {
            Some(to) if set.len() <= N / 2 => {
                to.copy_from_slice(set);
                Ok(())
            }
            _ => {
                self.lose(StorageError::OutOfRange);
                Err(StorageError::OutOfRange)
            }
        }
    }

    /// Reports that the stored set cannot be loaded; call it before the node has power. The node
    /// starts with its defaults and tells its application that the storage is damaged
    /// ([`storage_is`](od_runtime::Application::storage_is)). Only a master's 1010h replaces the
    /// set; 1011h is refused, since it would leave the set in place.
    pub fn lose(&mut self, error: StorageError) {
        self.lost = Some(error);
    }

    /// Waits until there is something to store.
    pub fn poll_changed(&mut self, cx: &mut Context<'_>) -> Poll<()> {
        if self.changes != self.kept {
            return Poll::Ready(());
        }
        self.waker = Some(cx.waker().clone());
        Poll::Pending
    }

    /// Makes a part of the set: at most 64 bytes or eight values. Returns whether there is more to
    /// do; until then [`newest`](Self::newest) returns the set before it.
    pub fn step(&mut self) -> bool {
        let Some(job) = &mut self.job else {
            return false;
        };
        let Some(result) = job.step(&mut self.sets, self.dictionary, &mut self.values) else {
            return true;
        };
        self.newest = Some(job.newest());
        self.job = None;
        self.made = self.changes;
        if result.is_err() {
            self.stored(self.made, result);
        }
        false
    }

    /// Returns the newest set, at most `N / 2` bytes, and its number for [`stored`](Self::stored);
    /// no bytes if nothing was ever saved.
    pub fn newest(&mut self) -> (&[u8], u32) {
        let place = match self.newest.take() {
            Some(place) => place,
            None => image::newest(&mut self.sets).ok().flatten().unwrap_or(0..0),
        };
        self.newest = Some(place.clone());
        (self.sets.0.get(place).unwrap_or_default(), self.made)
    }

    /// Notes that the set with this number is stored, or could not be; the node then responds to
    /// its master.
    pub fn stored(&mut self, number: u32, result: Result<(), StorageError>) {
        self.failed = result.is_err();
        self.kept = match result {
            Ok(()) => number,
            // The next change starts the next attempt.
            Err(_) => self.made,
        };
    }

    /// Counts a change, and wakes the task that stores it.
    fn change(&mut self) {
        self.changes = self.changes.wrapping_add(1);
        if let Some(waker) = self.waker.take() {
            waker.wake();
        }
    }

    /// Completes a waiting save before anything else is read or written.
    fn finish(&mut self) {
        while self.step() {}
    }
}

impl<const N: usize, const V: usize> Storage for Mirror<N, V> {
    fn capacity(&self) -> usize {
        N
    }

    fn read(&mut self, offset: usize, to: &mut [u8]) -> Result<(), StorageError> {
        self.finish();
        self.lost.map_or(Ok(()), Err)?;
        self.sets.read(offset, to)
    }

    fn write(&mut self, offset: usize, bytes: &[u8]) -> Result<(), StorageError> {
        self.finish();
        self.lost.map_or(Ok(()), Err)?;
        self.sets.write(offset, bytes)?;
        self.newest = None;
        self.change();
        self.made = self.changes;
        Ok(())
    }

    fn take(&mut self, save: &Save<'_>) -> bool {
        let is_kept = self.lost.is_some() && !save.is_of_settings();
        if is_kept || !save.is_of(self.device, self.dictionary) {
            return false;
        }
        self.finish();
        self.job = Some(image::Job::new(save, &mut self.values));
        (self.failed, self.lost) = (false, None);
        self.change();
        true
    }

    fn is_writing(&mut self) -> bool {
        self.changes != self.kept
    }

    fn flush(&mut self) -> Result<(), StorageError> {
        if self.is_writing() {
            return Ok(());
        }
        if core::mem::take(&mut self.failed) {
            Err(StorageError::Device)
        } else {
            Ok(())
        }
    }
}

impl<const N: usize> Sets<N> {
    fn range(offset: usize, len: usize) -> Result<Range<usize>, StorageError> {
        let end = offset.checked_add(len).filter(|end| *end <= N);
        end.map(|end| offset..end).ok_or(StorageError::OutOfRange)
    }
}

impl<const N: usize> Storage for Sets<N> {
    fn capacity(&self) -> usize {
        N
    }

    fn read(&mut self, offset: usize, to: &mut [u8]) -> Result<(), StorageError> {
        to.copy_from_slice(&self.0[Self::range(offset, to.len())?]);
        Ok(())
    }

    fn write(&mut self, offset: usize, bytes: &[u8]) -> Result<(), StorageError> {
        self.0[Self::range(offset, bytes.len())?].copy_from_slice(bytes);
        Ok(())
    }
}
