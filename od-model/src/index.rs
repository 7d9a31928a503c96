//! The search for an entry by its address.
//!
//! A hash table leads to a place of twelve bytes, and that to the value: reading one
//! takes as long in a large dictionary as in a small one, and most of a dictionary stays
//! out of the cache.

use crate::address::Address;
use crate::entry::{Entry, Slot};

/// The part of an entry that most reads need; has the same position as the entry.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct Place {
    pub(crate) key: u32,
    /// Slot of a value that a master may read and whose type gives its length;
    /// length 0 for any other value.
    pub(crate) plain: Slot,
}

impl Place {
    /// The place of an entry.
    #[doc(hidden)]
    pub const fn of(entry: &Entry) -> Self {
        let is_plain = entry.access.readable() && !entry.is_variable();
        let key = entry.address.key();
        let plain = if is_plain { entry.slot } else { Slot::NONE };
        Self { key, plain }
    }

    /// Returns whether this is the place of the entry.
    pub(crate) const fn is(&self, entry: &Entry) -> bool {
        let Self { key, plain } = Self::of(entry);
        self.key == key && self.plain.offset == plain.offset && self.plain.len == plain.len
    }
}

/// The places of all entries. For generated code; those of owned tables are made by
/// `od_eds::Tables`, as are their buckets.
#[must_use]
pub const fn places<const N: usize>(entries: &[Entry; N]) -> [Place; N] {
    let empty = Place {
        key: 0,
        plain: Slot::NONE,
    };
    let mut places = [empty; N];
    let mut i = 0;
    while i < N {
        places[i] = Place::of(&entries[i]);
        i += 1;
    }
    places
}

/// Content of an empty bucket: not the position of an entry.
pub const EMPTY: u16 = u16::MAX;

/// Number of buckets that [`buckets`] makes for this number of places: two to four times as many,
/// a power of two; 0 if their positions do not fit 16 bits.
#[must_use]
pub const fn bucket_count(places: usize) -> usize {
    if places > EMPTY as usize {
        return 0;
    }
    (2 * places).next_power_of_two()
}

/// A hash table of the places' positions; `N` is their [`bucket_count`].
///
/// # Panics
/// If `N` is not their bucket count. In a `const` that is a compile error.
#[must_use]
pub const fn buckets<const N: usize>(places: &[Place]) -> [u16; N] {
    assert!(N == bucket_count(places.len()), "the places' bucket count");
    let mut buckets = [EMPTY; N];
    fill(&mut buckets, places);
    buckets
}

/// Puts each place's position into the first bucket from its own on that is empty.
/// `buckets` are all empty, and as many as [`bucket_count`] says.
pub const fn fill(buckets: &mut [u16], places: &[Place]) {
    if buckets.is_empty() {
        return;
    }
    let mut i = 0;
    while i < places.len() {
        let mut at = own_bucket(places[i].key);
        while buckets[at & (buckets.len() - 1)] != EMPTY {
            at += 1;
        }
        buckets[at & (buckets.len() - 1)] = i as u16;
        i += 1;
    }
}

/// The position of the place with this address.
#[inline(always)]
pub(crate) fn position(buckets: &[u16], places: &[Place], address: Address) -> Option<usize> {
    let key = address.key();
    let Some(mask) = buckets.len().checked_sub(1) else {
        // Too many for buckets; they are sorted.
        return places.binary_search_by_key(&key, |place| place.key).ok();
    };
    let mut at = own_bucket(key);
    loop {
        let position = usize::from(*buckets.get(at & mask)?);
        // An empty bucket is past the last place.
        if places.get(position)?.key == key {
            return Some(position);
        }
        at += 1;
    }
}

/// Whether these are the buckets that [`fill`] makes.
pub(crate) const fn are_filled(buckets: &[u16], places: &[Place]) -> bool {
    if buckets.len() != bucket_count(places.len()) {
        return false;
    }
    let mut i = 0;
    while i < places.len() && !buckets.is_empty() {
        let mut at = own_bucket(places[i].key);
        while buckets[at & (buckets.len() - 1)] as usize != i {
            if buckets[at & (buckets.len() - 1)] == EMPTY {
                return false;
            }
            at += 1;
        }
        i += 1;
    }
    true
}

/// Bucket at which the search for a key begins; modulo the number of buckets, which is 2¹⁷ at most.
#[inline]
const fn own_bucket(key: u32) -> usize {
    (key.wrapping_mul(0x9E37_79B1) >> 15) as usize
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::access::{Access, Group};
    use crate::types::DataType;
    use crate::value::{Literal, Range};
    use std::vec;
    use std::vec::Vec;

    fn keyed(key: u32) -> Place {
        let plain = Slot::NONE;
        Place { key, plain }
    }

    fn address(key: u32) -> Address {
        Address::new((key >> 8) as u16, key as u8)
    }

    #[test]
    fn every_place_is_found_and_no_other() {
        for count in [0, 1, 2, 3, 128, 300, 5_000] {
            let places: Vec<Place> = (0..count).map(|i| keyed(0x20_0000 + 0x83 * i)).collect();
            let mut buckets = vec![EMPTY; bucket_count(places.len())];
            fill(&mut buckets, &places);
            assert!(are_filled(&buckets, &places));
            for (at, place) in places.iter().enumerate() {
                let found = position(&buckets, &places, address(place.key));
                assert_eq!(found, Some(at));
                let next = address(place.key + 1);
                assert_eq!(position(&buckets, &places, next), None);
            }
        }
    }

    #[test]
    fn more_places_than_buckets_can_name_are_searched() {
        let places: Vec<Place> = (0..70_000).map(|i| keyed(3 * i)).collect();
        assert_eq!(bucket_count(places.len()), 0);
        assert_eq!(position(&[], &places, address(3 * 69_999)), Some(69_999));
        assert_eq!(position(&[], &places, address(3 * 69_999 + 1)), None);
    }

    #[test]
    fn plain_is_what_can_be_read_without_the_entry() {
        let slot = Slot { offset: 8, len: 4 };
        let entry = |access, data_type| Entry {
            address: Address::new(0x2000, 1),
            data_type,
            access,
            mappable: false,
            group: Group::None,
            name: Range::new(0, 0),
            default: Literal::None,
            low: Literal::None,
            high: Literal::None,
            slot,
        };
        let plain = |access, data_type| Place::of(&entry(access, data_type)).plain;
        assert_eq!(plain(Access::Ro, DataType::Unsigned32), slot);
        assert_eq!(plain(Access::Rw, DataType::Real32), slot);
        assert_eq!(plain(Access::Wo, DataType::Unsigned32), Slot::NONE);
        assert_eq!(plain(Access::Ro, DataType::VisibleString), Slot::NONE);
    }
}
