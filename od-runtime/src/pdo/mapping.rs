//! Mapping of a PDO, read from its object once and kept.

use od_model::row::Row;

use crate::device::Device;
use crate::objects::{Objects, check_mapped};

/// Entries that are kept; a mapping of more (of BOOLEANs, say) is read from its object each time.
const KEPT: usize = 8;

/// One mapped value: the position of its entry in the dictionary, and its length.
#[derive(Clone, Copy, PartialEq, Debug)]
struct Mapped {
    /// One more than the position in the dictionary's entries; [`DUMMY`] for bits that nobody reads.
    entry: u32,
    bits: u8,
}

const DUMMY: u32 = 0;

const NOTHING: Mapped = Mapped {
    entry: DUMMY,
    bits: 0,
};

/// The mapping of one PDO.
#[derive(Clone, Copy, PartialEq, Debug)]
pub(super) struct Mapping {
    object: u16,
    count: u8,
    /// Length of the frame in bytes.
    len: u8,
    kept: [Mapped; KEPT],
}

impl Mapping {
    /// Nothing is mapped.
    pub(super) const NONE: Self = Self {
        object: 0,
        count: 0,
        len: 0,
        kept: [NOTHING; KEPT],
    };

    /// Reads the mapping object at `object`. One that does not hold (an EDS that maps what
    /// is not there) is an empty one: the PDO is off.
    pub(super) fn load<D: Device>(objects: &Objects<'_, D>, object: u16) -> Self {
        let count = objects.store.unsigned(object, 0).min(64) as u8;
        let mut mapping = Self {
            object,
            count,
            ..Self::NONE
        };
        let mut bits = 0u32;
        for sub in 1..=count {
            let Some(mapped) = mapping.mapped(objects, sub) else {
                return Self::NONE;
            };
            bits += u32::from(mapped.bits);
            if let Some(kept) = mapping.kept.get_mut(usize::from(sub) - 1) {
                *kept = mapped;
            }
        }
        if bits > 64 {
            return Self::NONE;
        }
        mapping.len = bits.div_ceil(8) as u8;
        mapping
    }

    /// Length of the frame in bytes; 0 where nothing is mapped.
    #[inline]
    pub(super) fn len(&self) -> u8 {
        self.len
    }

    fn mapped<D: Device>(&self, objects: &Objects<'_, D>, sub: u8) -> Option<Mapped> {
        let raw = objects.store.try_unsigned(self.object, sub)? as u32;
        let repr = check_mapped(&objects.store, self.object, raw).ok()?;
        let entry = match objects.store.dictionary().locate(repr.address) {
            Ok((at, _)) => at as u32 + 1,
            Err(_) => DUMMY,
        };
        Some(Mapped {
            entry,
            bits: repr.bits,
        })
    }

    /// Every mapped value in the order of the frame, with its first bit.
    #[inline]
    fn each<'c, D: Device>(
        &self,
        objects: &mut Objects<'c, D>,
        mut each: impl FnMut(&mut Objects<'c, D>, Option<(usize, Row)>, usize, usize),
    ) {
        let mut first = 0;
        for at in 0..usize::from(self.count) {
            let mapped = match self.kept.get(at) {
                Some(kept) => *kept,
                // The object has not changed since `load`, so the entry is still there.
                None => self.mapped(objects, at as u8 + 1).unwrap_or(NOTHING),
            };
            let at = (mapped.entry as usize).wrapping_sub(1);
            let row = objects.store.dictionary().row(at);
            let bits = usize::from(mapped.bits);
            each(objects, row.map(|row| (at, row)), first, bits);
            first += bits;
        }
    }

    /// Returns the frame's bytes with the current values, live ones updated.
    #[inline]
    pub(super) fn sample<D: Device>(&self, objects: &mut Objects<'_, D>) -> [u8; 8] {
        let mut data = 0u64;
        self.each(objects, |objects, row, first, bits| {
            let Some((_, row)) = row else { return };
            // A PDO has no way to say that a value could not be had; it takes the last one.
            let _ = objects.refresh(row.address());
            let value = objects.store.number_of(row);
            data |= (value & mask(bits)) << first.min(63);
        });
        data.to_le_bytes()
    }

    /// Writes the frame's bytes into the objects, each by the rules of its own; one that
    /// refuses its value keeps the old one.
    pub(super) fn apply<D: Device>(&self, objects: &mut Objects<'_, D>, data: [u8; 8]) {
        let data = u64::from_le_bytes(data);
        self.each(objects, |objects, row, first, bits| {
            let Some((_, row)) = row else { return };
            let value = data >> first.min(63) & mask(bits);
            let size = bits.div_ceil(8).min(8);
            let _ = objects.write(row.address(), &value.to_le_bytes()[..size]);
        });
    }
}

/// The low `bits` bits.
#[inline]
const fn mask(bits: usize) -> u64 {
    if bits >= 64 {
        u64::MAX
    } else {
        (1 << bits) - 1
    }
}
