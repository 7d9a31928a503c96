//! Mapping of a PDO (CiA 301, objects 1600h to 17FFh and 1A00h to 1BFFh), resolved when it is
//! configured.

use od_model::row::Row;
use od_model::typed::MapEntry;

use crate::application::ChangeKind;
use crate::objects::{Objects, check_mapped};
use crate::services::Services;
use crate::store::Store;

/// A mapped value. The low 24 bits are 1 plus the position of its row, or 0 for dummy bits; the
/// bits above are its length in bits.
pub type Mapped = u32;

/// Mapping of one PDO. Its entries are a part of an array that all PDOs share.
#[derive(Clone, Debug)]
pub(super) struct Mapping {
    object: u16,
    /// Position of its first entry in the array.
    first: u16,
    count: u8,
    /// Length of the frame in bytes.
    len: u8,
    /// At least one of the values is live.
    is_live: bool,
}

impl Mapping {
    /// Nothing is mapped.
    pub(super) const NONE: Self = Self {
        object: 0,
        first: 0,
        count: 0,
        len: 0,
        is_live: false,
    };

    /// Reads the mapping object at `object` into the places of `mapped` from `first` on. Returns
    /// whether the mapping has changed. A mapping that is not valid (an EDS that maps a missing
    /// object) counts as empty, so the PDO is not valid.
    pub(super) fn load<D: Services>(
        &mut self,
        objects: &Objects<'_, D>,
        object: u16,
        first: usize,
        mapped: &mut [Mapped],
    ) -> bool {
        let store = &objects.store;
        let count = store.word(object, 0, 0).min(64) as u8;
        let mut changed = self.object != object || self.count != count;
        (self.object, self.first) = (object, first as u16);
        (self.count, self.is_live) = (count, false);
        let mut places = mapped.get_mut(first..).unwrap_or_default().iter_mut();
        let mut bits = 0u32;
        // At most 64.
        for sub in 1..count + 1 {
            let raw = store.word(object, sub, 0);
            let Some(place) = places
                .next()
                .filter(|_| check_mapped(store, object, raw).is_ok())
            else {
                bits = u32::MAX;
                break;
            };
            let entry = MapEntry::parse(raw);
            self.is_live |= objects.is_live(entry.address);
            let row = store.dictionary().locate(entry.address);
            let row = row.map_or(0, |(at, _)| at as u32 + 1);
            let mapped = u32::from(entry.bits) << 24 | row & 0xFF_FFFF;
            changed |= *place != mapped;
            *place = mapped;
            bits += u32::from(entry.bits);
        }
        if bits > 64 {
            changed = self.len != 0;
            (self.count, bits) = (0, 0);
        }
        self.len = bits.div_ceil(8) as u8;
        changed
    }

    /// Length of the frame in bytes; 0 if nothing is mapped.
    pub(super) fn len(&self) -> u8 {
        self.len
    }

    /// Returns whether at least one mapped value is live.
    pub(super) fn is_live(&self) -> bool {
        self.is_live
    }

    /// Its entries in the shared array.
    fn entries<'m>(&self, mapped: &'m [Mapped]) -> &'m [Mapped] {
        let first = usize::from(self.first);
        let entries = mapped.get(first..first + usize::from(self.count));
        entries.unwrap_or_default()
    }

    /// Lets the application bring the live values up to date.
    fn refresh<D: Services>(&self, objects: &mut Objects<'_, D>, mapped: &[Mapped]) {
        for entry in self.entries(mapped) {
            if let Some(row) = row(&objects.store, *entry) {
                // A PDO cannot report that a value is not available; it contains the last one.
                let _ = objects.refresh(row.address());
            }
        }
    }

    /// Returns the bytes of the frame with the values of the store.
    fn read(&self, store: &Store<'_>, mapped: &[Mapped]) -> [u8; 8] {
        let (mut data, mut first) = (0u64, 0);
        for entry in self.entries(mapped) {
            let bits = entry >> 24;
            if let Some(row) = row(store, *entry) {
                data |= cut(store.number_of(row), bits) << (first & 63);
            }
            first += bits;
        }
        data.to_le_bytes()
    }

    /// Returns the bytes of the frame with the current values; live ones are brought up to date
    /// first.
    pub(super) fn sample<D: Services>(
        &self,
        objects: &mut Objects<'_, D>,
        mapped: &[Mapped],
    ) -> [u8; 8] {
        if self.is_live {
            self.refresh(objects, mapped);
        }
        self.read(&objects.store, mapped)
    }

    /// Returns whether the application accepts a difference between two frames as an event. If not,
    /// `last` gets the values whose changes are masked.
    pub(super) fn compare<D: Services>(
        &self,
        objects: &Objects<'_, D>,
        mapped: &[Mapped],
        last: &mut [u8; 8],
        now: [u8; 8],
    ) -> bool {
        let (mut sent, now) = (u64::from_le_bytes(*last), u64::from_le_bytes(now));
        let mut from = 0;
        for entry in self.entries(mapped) {
            let bits = entry >> 24;
            let own = u64::MAX.checked_shr(64 - bits.min(64)).unwrap_or(0) << from;
            let change = (sent ^ now) & own;
            if change != 0
                && let Some(row) = row(&objects.store, *entry)
            {
                let (was, is) = ((sent & own) >> from, (now & own) >> from);
                let (store, address) = (&objects.store, row.address());
                match objects.application.change_kind(store, address, was, is) {
                    ChangeKind::Event => return true,
                    ChangeKind::BelowThreshold => {}
                    ChangeKind::Masked => sent ^= change,
                }
            }
            from = (from + bits) & 63;
        }
        *last = sent.to_le_bytes();
        false
    }

    /// Writes the bytes of the frame into the objects, each by its own rules. An object that
    /// refuses its value keeps the old one.
    pub(super) fn apply<D: Services>(
        &self,
        objects: &mut Objects<'_, D>,
        mapped: &[Mapped],
        data: [u8; 8],
    ) {
        let mut data = u64::from_le_bytes(data);
        for entry in self.entries(mapped) {
            let bits = entry >> 24;
            if let Some(row) = row(&objects.store, *entry) {
                let value = cut(data, bits).to_le_bytes();
                let value = value.get(..row.size()).unwrap_or_default();
                let _ = objects.write(row.address(), value);
                let _ = objects.carry_out();
            }
            data = data.checked_shr(bits).unwrap_or(0);
        }
    }
}

/// The row of a mapped value; `None` for dummy bits.
fn row<'a>(store: &Store<'a>, mapped: Mapped) -> Option<&'a Row> {
    let position = (mapped as usize & 0xFF_FFFF).wrapping_sub(1);
    store.dictionary().row(position)
}

/// Cuts a value to its mapped bits; only a BOOLEAN does not fill whole bytes.
const fn cut(value: u64, bits: u32) -> u64 {
    if bits == 1 { value & 1 } else { value }
}
