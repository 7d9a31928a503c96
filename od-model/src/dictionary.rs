//! The dictionary: one type for compiled tables and for files loaded at run time.

use crate::address::Address;
use crate::entry::{Entry, Missing, Object, Slot, store_len};
use crate::index::{self, Place};
use crate::value::{Literal, Range};

/// A view over sorted tables; the same for a compiled device and for a loaded file.
///
/// Copied freely: it is six slices. The tables are sorted by address, and each object's
/// entries are adjacent.
#[derive(Clone, Copy, Debug)]
pub struct Dictionary<'a> {
    buckets: &'a [u16],
    places: &'a [Place],
    objects: &'a [Object],
    entries: &'a [Entry],
    text: &'a str,
    blob: &'a [u8],
    store_len: usize,
}

impl<'a> Dictionary<'a> {
    /// A view over tables that the macro made; owned tables lend theirs by
    /// `od_eds::Tables::dictionary`. `buckets` and `places`
    /// come from the functions of these names.
    ///
    /// # Panics
    /// If the tables are not sorted, an object names entries of another object, or buckets and places are not those of the entries. In a `const` that is a compile error.
    pub const fn new(
        buckets: &'a [u16],
        places: &'a [Place],
        objects: &'a [Object],
        entries: &'a [Entry],
        text: &'a str,
        blob: &'a [u8],
    ) -> Self {
        assert!(places.len() == entries.len(), "one place an entry");
        assert!(index::are_filled(buckets, places), "the places' buckets");
        let mut next = 0;
        let mut i = 0;
        while i < objects.len() {
            let object = &objects[i];
            assert!(
                i == 0 || objects[i - 1].index < object.index,
                "objects are sorted"
            );
            assert!(
                object.first as usize == next,
                "entries are in the objects' order"
            );
            let mut sub = 0;
            while sub < object.count as usize {
                let address = entries[next + sub].address;
                assert!(
                    address.index == object.index,
                    "an object's entries are its own"
                );
                assert!(
                    sub == 0 || entries[next + sub - 1].address.sub < address.sub,
                    "entries are sorted"
                );
                assert!(
                    places[next + sub].is(&entries[next + sub]),
                    "a place is its entry's"
                );
                sub += 1;
            }
            next += sub;
            i += 1;
        }
        assert!(next == entries.len(), "every entry belongs to an object");
        let store_len = store_len(entries);
        Self::trusted(buckets, places, objects, entries, text, blob, store_len)
    }

    /// The same over tables that are sound by the way they were made.
    #[doc(hidden)]
    pub const fn trusted(
        buckets: &'a [u16],
        places: &'a [Place],
        objects: &'a [Object],
        entries: &'a [Entry],
        text: &'a str,
        blob: &'a [u8],
        store_len: usize,
    ) -> Self {
        Self {
            buckets,
            places,
            objects,
            entries,
            text,
            blob,
            store_len,
        }
    }

    /// The objects, by ascending index.
    pub const fn objects(&self) -> &'a [Object] {
        self.objects
    }

    /// All values, by ascending address.
    pub const fn entries(&self) -> &'a [Entry] {
        self.entries
    }

    /// Bytes that a store of this dictionary's values needs.
    pub const fn store_len(&self) -> usize {
        self.store_len
    }

    /// The object at `index`.
    #[inline]
    pub fn object(&self, index: u16) -> Option<&'a Object> {
        let at = self
            .objects
            .binary_search_by_key(&index, |object| object.index)
            .ok()?;
        self.objects.get(at)
    }

    /// The entries of an object, by ascending sub-index.
    #[inline]
    pub fn members(&self, object: &Object) -> &'a [Entry] {
        let first = object.first as usize;
        self.entries
            .get(first..first + object.count as usize)
            .unwrap_or(&[])
    }

    /// The entry at an address.
    ///
    /// # Errors
    /// [`Missing`] says whether the object or only the sub-index is absent.
    pub fn find(&self, address: Address) -> Result<&'a Entry, Missing> {
        let (entry, _) = self.locate(address)?;
        Ok(entry)
    }

    /// The entry at an address, and the slot of its value if a master may read it and its
    /// type gives the length; a slot of length 0 otherwise. Reading such a value needs
    /// nothing else of the entry.
    ///
    /// # Errors
    /// As for [`find`](Self::find).
    #[inline(always)] // into the one read that masters ask for all day
    pub fn locate(&self, address: Address) -> Result<(&'a Entry, Slot), Missing> {
        let found = index::position(self.buckets, self.places, address);
        let both = found.and_then(|at| Some((self.entries.get(at)?, self.places.get(at)?.plain)));
        match both {
            Some(both) => Ok(both),
            None => Err(self.missing(address)),
        }
    }

    #[cold]
    fn missing(&self, address: Address) -> Missing {
        match self.object(address.index) {
            Some(_) => Missing::SubIndex,
            None => Missing::Object,
        }
    }

    /// The entry at index and sub-index, if there is one.
    #[inline]
    pub fn entry(&self, index: u16, sub: u8) -> Option<&'a Entry> {
        self.find(Address::new(index, sub)).ok()
    }

    /// The text of a range: a name or a VISIBLE_STRING.
    pub fn text(&self, range: Range) -> &'a str {
        let start = range.start as usize;
        self.text
            .get(start..start.saturating_add(range.len as usize))
            .unwrap_or("")
    }

    /// The bytes of a range: an OCTET_STRING or a DOMAIN.
    pub fn blob(&self, range: Range) -> &'a [u8] {
        range.of(self.blob)
    }

    /// The bytes of a string-like literal; empty for numbers.
    pub fn literal_bytes(&self, literal: Literal) -> &'a [u8] {
        match literal {
            Literal::Text(range) => self.text(range).as_bytes(),
            Literal::Bytes(range) => self.blob(range),
            _ => &[],
        }
    }
}

impl PartialEq for Dictionary<'_> {
    /// Object by object: names, types, access, limits, defaults, groups. The
    /// places of texts in the arena and of values in the store do not matter.
    fn eq(&self, other: &Self) -> bool {
        let literal = |a: Literal, b: Literal| match (a, b) {
            (Literal::Text(a), Literal::Text(b)) => self.text(a) == other.text(b),
            (Literal::Bytes(a), Literal::Bytes(b)) => self.blob(a) == other.blob(b),
            (a, b) => a == b,
        };
        self.objects.len() == other.objects.len()
            && self.objects.iter().zip(other.objects).all(|(a, b)| {
                (a.index, a.code) == (b.index, b.code)
                    && a.count == b.count
                    && self.text(a.name) == other.text(b.name)
            })
            && self.entries.len() == other.entries.len()
            && self.entries.iter().zip(other.entries).all(|(a, b)| {
                (a.address, a.data_type, a.access, a.mappable, a.group)
                    == (b.address, b.data_type, b.access, b.mappable, b.group)
                    && self.text(a.name) == other.text(b.name)
                    && literal(a.default, b.default)
                    && literal(a.low, b.low)
                    && literal(a.high, b.high)
            })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::access::{Access, Group};
    use crate::index::{bucket_count, buckets, places};
    use crate::types::{DataType, ObjectCode};

    const fn entry(index: u16, sub: u8) -> Entry {
        Entry {
            address: Address::new(index, sub),
            data_type: DataType::Unsigned8,
            access: Access::Ro,
            mappable: false,
            group: Group::None,
            name: Range::new(0, 1),
            default: Literal::Unsigned(2),
            low: Literal::None,
            high: Literal::None,
            slot: Slot { offset: 0, len: 1 },
        }
    }

    const fn object(index: u16, first: u32, count: u16) -> Object {
        Object {
            index,
            code: ObjectCode::Record,
            name: Range::new(0, 1),
            first,
            count,
        }
    }

    static ENTRIES: [Entry; 5] = [
        entry(0x1001, 0),
        entry(0x1800, 0),
        entry(0x1800, 1),
        entry(0x1800, 2),
        entry(0x1800, 5),
    ];
    static PLACES: [Place; 5] = places(&ENTRIES);
    static BUCKETS: [u16; bucket_count(5)] = buckets(&PLACES);

    const TABLE: Dictionary<'static> = Dictionary::new(
        &BUCKETS,
        &PLACES,
        &[object(0x1001, 0, 1), object(0x1800, 1, 4)],
        &ENTRIES,
        "x",
        &[],
    );

    #[test]
    fn finds_entries_and_says_what_is_missing() {
        assert_eq!(
            TABLE.find(Address::new(0x1001, 0)).map(|e| e.address.index),
            Ok(0x1001)
        );
        assert_eq!(
            TABLE.find(Address::new(0x1800, 5)).map(|e| e.address.sub),
            Ok(5)
        );
        assert_eq!(TABLE.find(Address::new(0x1800, 3)), Err(Missing::SubIndex));
        assert_eq!(TABLE.find(Address::new(0x1800, 6)), Err(Missing::SubIndex));
        assert_eq!(TABLE.find(Address::new(0x1002, 0)), Err(Missing::Object));
        assert_eq!(TABLE.find(Address::new(0xFFFF, 0)), Err(Missing::Object));
    }

    #[test]
    fn equality_reads_through_the_arena() {
        let entries: [Entry; 5] = core::array::from_fn(|i| Entry {
            name: Range::new(1, 1),
            ..TABLE.entries()[i]
        });
        let objects: [Object; 2] = core::array::from_fn(|i| Object {
            name: Range::new(1, 1),
            ..TABLE.objects()[i]
        });
        let shifted = Dictionary::new(&BUCKETS, &PLACES, &objects, &entries, "yx", &[]);
        assert_eq!(TABLE, shifted);
        let other = Dictionary::new(&BUCKETS, &PLACES, &objects, &entries, "xy", &[]);
        assert_ne!(TABLE, other);
    }
}
