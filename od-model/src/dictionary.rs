//! The dictionary: one type for compiled tables and for files loaded at run time.

mod text;

use core::ops::Range as Span;

use crate::address::Address;
use crate::entry::{Entry, Missing, Object};
use crate::index::{self, Buckets};
use crate::real::Reals;
use crate::row::Row;
use crate::value::Range;
use crate::varying::{Arenas, Varying};

/// A view over sorted tables; the same for a compiled device and for a loaded file.
///
/// Copied freely: it is a few slices. The tables are sorted by address, and each object's
/// entries are adjacent.
///
/// Names are there with the feature `names`; without it they are empty, and a firmware does not
/// hold their text.
#[derive(Clone, Copy, Debug)]
pub struct Dictionary<'a> {
    buckets: Buckets<'a>,
    rows: &'a [Row],
    arenas: Arenas<'a>,
    store_len: usize,
    reals: Option<&'static Reals>,
    varying: Option<&'static Varying>,
    #[cfg(feature = "names")]
    names: Names<'a>,
}

/// Names of the objects and entries of a dictionary.
#[derive(Clone, Copy, Debug)]
pub struct Names<'a> {
    /// For each entry its own name and its object's.
    pub rows: &'a [[Range; 2]],
    /// The text of the names, each once.
    pub text: &'a str,
}

/// Bit of [`Range::start`] that distinguishes a name from a text of the dictionary.
const NAME: u32 = 1 << 31;

impl<'a> Dictionary<'a> {
    /// The dictionary without objects.
    pub const EMPTY: Self = Self::trusted(
        Buckets::Words(&[]),
        &[],
        &[],
        "",
        &[],
        0,
        None,
        None,
        Names {
            rows: &[],
            text: "",
        },
    );

    /// A view over tables that are sound by the way they were made: by `od_eds::Tables`.
    #[doc(hidden)]
    #[allow(clippy::too_many_arguments)] // each is a table
    pub const fn trusted(
        buckets: Buckets<'a>,
        rows: &'a [Row],
        pool: &'a [u32],
        text: &'a str,
        blob: &'a [u8],
        store_len: usize,
        reals: Option<&'static Reals>,
        varying: Option<&'static Varying>,
        names: Names<'a>,
    ) -> Self {
        #[cfg(not(feature = "names"))]
        let _ = names;
        Self {
            buckets,
            rows,
            arenas: Arenas { pool, text, blob },
            store_len,
            reals,
            varying,
            #[cfg(feature = "names")]
            names,
        }
    }

    /// The objects, by ascending index.
    pub const fn objects(&self) -> Objects<'a> {
        Objects {
            dictionary: *self,
            next: 0,
        }
    }

    /// All values, by ascending address.
    pub const fn entries(&self) -> Entries<'a> {
        Entries {
            dictionary: *self,
            range: 0..self.rows.len(),
        }
    }

    /// Bytes that a store of this dictionary's values needs.
    pub const fn store_len(&self) -> usize {
        self.store_len
    }

    /// Number of values.
    pub const fn len(&self) -> usize {
        self.rows.len()
    }

    /// Returns whether it contains no values.
    pub const fn is_empty(&self) -> bool {
        self.rows.is_empty()
    }

    /// Returns whether both are views over the same tables.
    pub fn is_same(&self, other: &Self) -> bool {
        core::ptr::eq(self.rows, other.rows)
    }

    /// The value at a position, below [`len`](Self::len).
    ///
    /// # Panics
    /// If `position` is not less than the number of values.
    pub const fn at(&self, position: usize) -> Entry {
        self.unpack(position, self.rows[position])
    }

    const fn unpack(&self, position: usize, row: Row) -> Entry {
        let mut entry = row.entry(self.arenas.pool);
        entry.name = self.names_at(position)[0];
        entry
    }

    /// The names of an entry and of its object.
    #[cfg(feature = "names")]
    const fn names_at(&self, position: usize) -> [Range; 2] {
        let [entry, object] = self.names.rows[position];
        [
            Range::new(entry.start | NAME, entry.len),
            Range::new(object.start | NAME, object.len),
        ]
    }

    #[cfg(not(feature = "names"))]
    const fn names_at(&self, _: usize) -> [Range; 2] {
        [Range::new(NAME, 0); 2]
    }

    /// The row of the value at a position.
    #[doc(hidden)]
    pub fn row(&self, position: usize) -> Option<&'a Row> {
        self.rows.get(position)
    }

    /// The rows, by ascending address.
    #[doc(hidden)]
    pub const fn rows(&self) -> &'a [Row] {
        self.rows
    }

    /// Parts of rows that do not fit into them.
    #[doc(hidden)]
    pub const fn pool(&self) -> &'a [u32] {
        self.arenas.pool
    }

    /// Limits, texts and bytes that rows refer to.
    #[doc(hidden)]
    pub const fn arenas(&self) -> &Arenas<'a> {
        &self.arenas
    }

    /// Functions for REALs; `None` if it has no REALs.
    #[doc(hidden)]
    pub const fn reals(&self) -> Option<&'static Reals> {
        self.reals
    }

    /// Functions for values whose length varies; `None` if it has none.
    #[doc(hidden)]
    pub const fn varying(&self) -> Option<&'static Varying> {
        self.varying
    }

    /// The object at `index`.
    pub fn object(&self, index: u16) -> Option<Object> {
        let first = self.first(index);
        self.object_at(first).filter(|object| object.index == index)
    }

    /// Position of the first entry of an object, or of what comes after where it would be.
    pub(crate) const fn first(&self, index: u16) -> usize {
        index::first(self.rows, (index as u32) << 8)
    }

    /// Index of the object of the value at a position.
    pub(crate) const fn index_at(&self, position: usize) -> u16 {
        if position < self.rows.len() {
            self.rows[position].index()
        } else {
            0
        }
    }

    /// The object whose entries begin at a position.
    fn object_at(&self, first: usize) -> Option<Object> {
        let row = self.rows.get(first)?;
        let rest = self.rows.get(first..).unwrap_or_default();
        let count = rest.iter().take_while(|other| other.index() == row.index());
        Some(Object {
            index: row.index(),
            code: row.code(),
            name: self.names_at(first)[1],
            first: first as u32,
            // An object has 256 sub-indices at most.
            count: count.count() as u16,
        })
    }

    /// The entries of an object, by ascending sub-index.
    pub fn members(&self, object: &Object) -> Entries<'a> {
        let first = (object.first as usize).min(self.rows.len());
        let end = (first + usize::from(object.count)).min(self.rows.len());
        Entries {
            dictionary: *self,
            range: first..end,
        }
    }

    /// The entry at an address.
    ///
    /// # Errors
    /// [`Missing`] says whether the object or only the sub-index is absent.
    pub fn find(&self, address: Address) -> Result<Entry, Missing> {
        match self.locate(address) {
            Some((position, row)) => Ok(self.unpack(position, *row)),
            None => Err(self.missing(address)),
        }
    }

    /// The position of an address and its row, if there is one; in registers.
    #[doc(hidden)]
    pub fn locate(&self, address: Address) -> Option<(usize, &'a Row)> {
        index::position(self.buckets, self.rows, address.key())
    }

    /// The row of an address, if there is one.
    #[doc(hidden)]
    pub fn row_at(&self, address: Address) -> Option<&'a Row> {
        self.locate(address).map(|(_, row)| row)
    }

    /// Returns what is absent, the object or its sub-object, where [`row_at`](Self::row_at) finds none.
    #[doc(hidden)]
    pub fn missing(&self, address: Address) -> Missing {
        match self.rows.get(self.first(address.index)) {
            Some(row) if row.index() == address.index => Missing::SubIndex,
            _ => Missing::Object,
        }
    }

    /// The entry at index and sub-index, if there is one.
    #[inline]
    pub fn entry(&self, index: u16, sub: u8) -> Option<Entry> {
        self.find(Address::new(index, sub)).ok()
    }
}

/// Values of a dictionary, by ascending address.
#[derive(Clone, Debug)]
pub struct Entries<'a> {
    dictionary: Dictionary<'a>,
    range: Span<usize>,
}

impl<'a> Entries<'a> {
    /// All that are left.
    #[must_use]
    pub fn iter(&self) -> Self {
        self.clone()
    }

    /// The value `at` places after the first.
    pub fn get(&self, at: usize) -> Option<Entry> {
        self.range.clone().nth(at).map(|at| self.dictionary.at(at))
    }

    /// Returns whether none is left.
    pub fn is_empty(&self) -> bool {
        self.range.is_empty()
    }
}

impl Iterator for Entries<'_> {
    type Item = Entry;

    fn next(&mut self) -> Option<Entry> {
        self.range.next().map(|at| self.dictionary.at(at))
    }

    fn size_hint(&self) -> (usize, Option<usize>) {
        self.range.size_hint()
    }
}

impl DoubleEndedIterator for Entries<'_> {
    fn next_back(&mut self) -> Option<Entry> {
        self.range.next_back().map(|at| self.dictionary.at(at))
    }
}

impl ExactSizeIterator for Entries<'_> {}

/// Objects of a dictionary, by ascending index.
#[derive(Clone, Debug)]
pub struct Objects<'a> {
    dictionary: Dictionary<'a>,
    next: usize,
}

impl Objects<'_> {
    /// All that are left.
    #[must_use]
    pub fn iter(&self) -> Self {
        self.clone()
    }

    /// Number of those that are left.
    pub fn len(&self) -> usize {
        self.clone().count()
    }

    /// Returns whether none is left.
    pub fn is_empty(&self) -> bool {
        self.next >= self.dictionary.len()
    }
}

impl Iterator for Objects<'_> {
    type Item = Object;

    fn next(&mut self) -> Option<Object> {
        let object = self.dictionary.object_at(self.next)?;
        self.next += usize::from(object.count);
        Some(object)
    }
}
