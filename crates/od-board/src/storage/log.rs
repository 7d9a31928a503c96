//! Saved values in a log on NOR flash, by `sequential-storage`.

use core::cell::{Cell, RefCell};
use core::future::poll_fn;
use core::ops::Range;
use core::task::Poll;

use embedded_storage_async::nor_flash::NorFlash;
use od_runtime::storage::StorageError;
use sequential_storage::cache::{Cache, Uncached};
use sequential_storage::map::{MapConfig, MapStorage, SerializationError, Value};

use super::guard::Guard;
use super::mirror::Mirror;
use super::steps::pause;

type Map<F> = MapStorage<u8, Guard<F>, Cache<Uncached, Uncached, Uncached, u8>>;

/// The only key.
const SET: u8 = 0;

/// Number of bytes of a set that are compared in one lock.
const STEP: usize = 128;

/// Attempts to store a set, each after the remains of the one before.
const ATTEMPTS: usize = 3;

/// Pages of flash that contain the newest set of a [`Mirror`], among older ones. A save appends a
/// set, and a page is erased when all are full, so the pages wear evenly. A new set is valid when
/// its checksum is written.
///
/// `B` is the size of the buffer for a set: half of the mirror's size plus 64. The driver is
/// asynchronous; [`Steps`](super::Steps) makes such a driver of a blocking one.
pub struct Log<F: NorFlash, const B: usize> {
    map: Map<F>,
    buffer: [u8; B],
}

/// Calls its argument with the mirror.
type With<'w, const N: usize, const V: usize> =
    &'w mut dyn FnMut(&mut dyn FnMut(&mut Mirror<N, V>));

/// The newest set of a mirror, which is copied into the buffer for writing.
struct Newest<'w, const N: usize, const V: usize> {
    with: RefCell<With<'w, N, V>>,
    number: Cell<u32>,
}

impl<const N: usize, const V: usize> Newest<'_, N, V> {
    /// Calls `act` with the set and its number.
    fn set(&self, act: &mut dyn FnMut(&[u8], u32)) {
        (self.with.borrow_mut())(&mut |mirror| {
            let (bytes, number) = mirror.newest();
            act(bytes, number);
        });
    }

    /// Returns whether `stored` is the set that was written. If the mirror has a newer set by now,
    /// the rest is not compared.
    fn is(&self, stored: &[u8]) -> bool {
        let (mut at, mut is_same) = (0, true);
        // Each lock is short.
        while is_same && at <= stored.len() {
            let part = stored.get(at..).unwrap_or_default();
            let part = part.get(..STEP).unwrap_or(part);
            self.set(&mut |bytes, number| {
                let own = bytes.get(at..).and_then(|bytes| bytes.get(..part.len()));
                let is_equal = bytes.len() == stored.len() && own == Some(part);
                is_same = number != self.number.get() || is_equal;
            });
            at += STEP;
        }
        is_same
    }
}

impl<const N: usize, const V: usize> Value<'_> for Newest<'_, N, V> {
    fn serialize_into(&self, buffer: &mut [u8]) -> Result<usize, SerializationError> {
        let mut result = Err(SerializationError::BufferTooSmall);
        self.set(&mut |bytes, number| {
            if let Some(to) = buffer.get_mut(..bytes.len()) {
                to.copy_from_slice(bytes);
                self.number.set(number);
                result = Ok(bytes.len());
            }
        });
        result
    }

    fn deserialize_from(_: &[u8]) -> Result<(Self, usize), SerializationError> {
        Err(SerializationError::InvalidFormat)
    }
}

impl<F: NorFlash, const B: usize> Log<F, B> {
    /// The pages from `range.start` to `range.end`, three or more.
    ///
    /// # Panics
    /// In a constant: does not compile. The range must be at least three whole pages, and a set
    /// must fit into a page.
    pub const fn new(flash: F, range: Range<u32>) -> Self {
        const {
            assert!(
                B + 64 <= F::ERASE_SIZE,
                "a set fits into a page of the flash: `Joined` makes one of several"
            )
        };
        assert!(
            (range.end - range.start) as usize >= 3 * F::ERASE_SIZE,
            "a log has three pages or more"
        );
        Self {
            map: Map::new(Guard(flash), MapConfig::new(range), Cache::new_uncached()),
            buffer: [0; B],
        }
    }

    /// Loads the newest set into a mirror, before the node has power. After an error the set is
    /// [lost](Mirror::lose), and the node starts with its defaults.
    ///
    /// # Errors
    /// [`StorageError::Device`] if the flash cannot be read or repaired; [`StorageError::OutOfRange`] as in
    /// [`Mirror::load`].
    pub async fn load<const N: usize, const V: usize>(
        &mut self,
        mirror: &mut Mirror<N, V>,
    ) -> Result<(), StorageError> {
        let set = self.map.fetch_item::<&[u8]>(&mut self.buffer, &SET).await;
        match set {
            Ok(set) => mirror.load(set.unwrap_or(&[])),
            Err(_) => {
                mirror.lose(StorageError::Device);
                Err(StorageError::Device)
            }
        }
    }

    /// Stores what the node saves, and never returns. `with` calls its argument with the mirror,
    /// inside the lock of the node; the lock is held while a set is copied.
    pub async fn run<const N: usize, const V: usize>(
        &mut self,
        mut with: impl FnMut(&mut dyn FnMut(&mut Mirror<N, V>)),
    ) {
        loop {
            poll_fn(|cx| {
                let mut changed = Poll::Pending;
                with(&mut |mirror| changed = mirror.poll_changed(cx));
                changed
            })
            .await;
            self.save(&mut with).await;
        }
    }

    /// Stores what the node has saved by now, unless it is stored already.
    pub async fn save<const N: usize, const V: usize>(
        &mut self,
        mut with: impl FnMut(&mut dyn FnMut(&mut Mirror<N, V>)),
    ) {
        const { assert!(N / 2 + 64 <= B, "the buffer has room for a set and its key") };
        // The set is made in steps, between which other tasks can use the node.
        loop {
            let mut goes_on = false;
            with(&mut |mirror| goes_on = mirror.step());
            if !goes_on {
                break;
            }
            pause().await;
        }
        let newest = Newest {
            with: RefCell::new(&mut with),
            number: Cell::new(0),
        };
        let mut is_empty = true;
        newest.set(&mut |bytes, number| {
            is_empty = bytes.is_empty();
            newest.number.set(number);
        });
        let result = if is_empty {
            Ok(())
        } else {
            self.append(&newest).await
        };
        let number = newest.number.get();
        with(&mut |mirror| mirror.stored(number, result));
    }

    /// Appends a set, and reads it back: after a word that a power failure left half-written, the
    /// next set may not be found (sequential-storage 136).
    async fn append<const N: usize, const V: usize>(
        &mut self,
        set: &Newest<'_, N, V>,
    ) -> Result<(), StorageError> {
        let mut result = Err(StorageError::Device);
        for _ in 0..ATTEMPTS {
            let stored = self.map.store_item(&mut self.buffer, &SET, set).await;
            let found = match stored {
                Ok(()) => self.map.fetch_item::<&[u8]>(&mut self.buffer, &SET).await,
                Err(error) => Err(error),
            };
            match found {
                Ok(Some(bytes)) if set.is(bytes) => return Ok(()),
                Ok(_) => result = Err(StorageError::NotWritten),
                Err(_) => result = Err(StorageError::Device),
            }
        }
        result
    }
}
