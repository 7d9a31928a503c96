//! Mapping of a PDO: read from its object once, and kept.

use od_model::Dictionary;
use od_model::row::Row;
use od_model::typed::MapEntry;

use crate::application::{Application, Context};
use crate::device::{Device, ROOMY};
use crate::objects::outbox::is_live;
use crate::objects::{Objects, check_mapped};
use crate::rooms::{Room, Rooms};
use crate::store::Store;

/// A mapped value: in the low 24 bits one more than the position of its row, 0 for bits that nobody
/// reads, and above them its length in bits.
type Mapped = u32;

/// The mapping of one PDO.
#[derive(Clone, Debug)]
pub(super) struct Mapping<R: Rooms> {
    object: u16,
    count: u8,
    /// Length of the frame in bytes.
    len: u8,
    kept: R::Kept<Mapped>,
    /// The application brings one of the values up to date.
    is_live: bool,
    /// All values are kept, and numbers of up to four bytes in the store, which a master may read.
    is_plain: bool,
}

impl<R: Rooms> Mapping<R> {
    /// Nothing is mapped.
    pub(super) const NONE: Self = Self {
        object: 0,
        count: 0,
        len: 0,
        kept: Room::BLANK,
        is_live: false,
        is_plain: false,
    };

    /// Reads the mapping object at `object`. Answers whether it is another one than before. One
    /// that does not hold (an EDS that maps what is not there) is an empty one: the PDO is off.
    #[inline(never)]
    pub(super) fn load<D: Device>(&mut self, objects: &Objects<'_, D>, object: u16) -> bool {
        let store = &objects.store;
        let count = store.word(object, 0, 0).min(64) as u8;
        let mut changed = self.object != object || self.count != count;
        (self.object, self.count, self.is_live) = (object, count, false);
        self.is_plain = usize::from(count) <= self.kept.all().len();
        let mut bits = 0u32;
        for sub in 1..=count {
            let raw = store.word(object, sub, 0);
            if check_mapped(store, object, raw).is_err() {
                bits = u32::MAX;
                break;
            }
            self.is_live |= objects.is_live(MapEntry::parse(raw).address);
            bits += raw & 0xFF;
            if let Some(kept) = self.kept.all_mut().get_mut(usize::from(sub) - 1) {
                let mapped = mapped(store, raw);
                self.is_plain &= ROOMY && is_plain(store, mapped);
                changed |= *kept != mapped;
                *kept = mapped;
            } else {
                // What is not kept may be another value.
                changed = true;
            }
        }
        if bits > 64 {
            changed = self.len != 0;
            (self.count, bits) = (0, 0);
        }
        self.len = bits.div_ceil(8) as u8;
        changed
    }

    /// Length of the frame in bytes; 0 where nothing is mapped.
    #[inline(always)]
    pub(super) fn len(&self) -> u8 {
        self.len
    }

    /// Whether the application brings a mapped value up to date.
    #[inline(always)]
    pub(super) fn is_live(&self) -> bool {
        self.is_live
    }

    /// The row of a mapped value, if it has one, and its bits.
    #[inline(always)]
    fn value<'a>(&self, store: &Store<'a>, at: u8) -> (Option<&'a Row>, u32) {
        let mapped = match self.kept.all().get(usize::from(at)) {
            Some(mapped) => *mapped,
            // The object has not changed since `load`, so the entry is still there.
            None => mapped(store, store.word(self.object, at + 1, 0)),
        };
        let position = (mapped as usize & 0xFF_FFFF).wrapping_sub(1);
        (store.dictionary().row(position), mapped >> 24)
    }

    /// Has the application bring the live values up to date, by the set of them.
    #[cfg_attr(target_os = "none", inline(never))]
    pub(super) fn refresh(
        &self,
        application: &mut dyn Application,
        context: &mut Context<'_, '_>,
        live: u32,
    ) {
        for at in 0..self.count {
            if let (Some(row), _) = self.value(context.store, at) {
                let address = row.address();
                if is_live(live, address) {
                    // A PDO has no way to say that a value could not be had; it takes the last one.
                    let _ = application.refresh(context, address);
                }
            }
        }
    }

    /// Returns the frame's bytes with the values of the store, as a number.
    #[inline(always)]
    pub(super) fn gather(&self, dictionary: &Dictionary<'_>, values: &[u8]) -> Option<u64> {
        if !ROOMY || !self.is_plain {
            return None;
        }
        let (mut data, mut first) = (0u64, 0);
        for mapped in self.kept.all().get(..usize::from(self.count))? {
            let row = dictionary.row((*mapped as usize & 0xFF_FFFF).wrapping_sub(1))?;
            let at = row.plain().offset as usize;
            let word = u32::from_le_bytes(*values.get(at..at + 4)?.first_chunk()?);
            let bits = *mapped >> 24;
            let unused = bits.wrapping_neg() & 31;
            data |= u64::from(word << unused >> unused) << (first & 63);
            first += bits;
        }
        Some(data)
    }

    /// Returns the frame's bytes with the values of the store.
    #[inline(never)]
    pub(super) fn read(&self, store: &Store<'_>) -> [u8; 8] {
        let (mut data, mut first) = (0u64, 0);
        for at in 0..self.count {
            let (row, bits) = self.value(store, at);
            if let Some(row) = row {
                data |= cut(store.number_of(row), bits) << (first & 63);
            }
            first += bits;
        }
        data.to_le_bytes()
    }

    /// Returns the frame's bytes with the current values, live ones updated.
    pub(super) fn sample<D: Device>(&self, objects: &mut Objects<'_, D>) -> [u8; 8] {
        if self.is_live {
            let live = objects.outbox.live;
            objects.application(|application, context| self.refresh(application, context, live));
        }
        self.read(&objects.store)
    }

    /// Writes the frame's bytes into the objects, each by the rules of its own; one that
    /// refuses its value keeps the old one.
    #[inline(never)]
    pub(super) fn apply<D: Device>(&self, objects: &mut Objects<'_, D>, data: [u8; 8]) {
        let mut data = u64::from_le_bytes(data);
        for at in 0..self.count {
            let (row, bits) = self.value(&objects.store, at);
            if let Some(row) = row {
                let value = cut(data, bits).to_le_bytes();
                let value = value.get(..row.size()).unwrap_or_default();
                let _ = objects.write(row.address(), value);
                let _ = objects.carry_out();
            }
            data = data.checked_shr(bits).unwrap_or(0);
        }
    }
}

/// Decodes an entry of a mapping object.
fn mapped(store: &Store<'_>, raw: u32) -> Mapped {
    let MapEntry { address, bits } = MapEntry::parse(raw);
    let row = match store.dictionary().locate(address) {
        Ok((at, _)) => at as u32 + 1,
        Err(_) => 0,
    };
    u32::from(bits) << 24 | row & 0xFF_FFFF
}

/// Whether a mapped value is a number of up to four bytes in the store, which a master may read.
fn is_plain(store: &Store<'_>, mapped: Mapped) -> bool {
    let row = store
        .dictionary()
        .row((mapped as usize & 0xFF_FFFF).wrapping_sub(1));
    row.is_some_and(|row| matches!(row.plain().len, 1..=4))
}

/// Cuts a value to its mapped bits; only a BOOLEAN does not fill whole bytes.
#[inline(always)]
const fn cut(value: u64, bits: u32) -> u64 {
    match bits {
        1 => value & 1,
        _ => value,
    }
}
