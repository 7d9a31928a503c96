//! The dictionary: one type for compiled tables and for files loaded at run time.

use core::ops::Range as Span;

use crate::address::Address;
use crate::entry::{Entry, Missing, Object};
use crate::index::{self, Buckets};
use crate::real::Reals;
use crate::row::Row;
use crate::value::{Literal, Range};
use crate::varying::{Arenas, Varying};

/// A view over sorted tables; the same for a compiled device and for a loaded file.
///
/// A view consists of a few slices, so copies are cheap. The tables are sorted by address, and the
/// entries of an object are adjacent.
///
/// Names need the feature `names`; without it they are empty, and a firmware does not contain their
/// text.
///
/// ```
/// # let description = od_eds::parse(include_str!("../../devices/eds/GXMM.eds")).description;
/// # let tables = od_eds::Tables::new(&description);
/// let dictionary = tables.dictionary();
/// let entry = dictionary.entry(0x1000, 0).expect("the device type");
/// assert_eq!(entry.default.integer(32), Some(0x0002_0196));
/// assert!(dictionary.has(0x6004) && !dictionary.has(0x6400));
/// ```
#[derive(Clone, Copy, Debug)]
pub struct Dictionary<'a> {
    buckets: Buckets<'a>,
    rows: &'a [Row],
    arenas: Arenas<'a>,
    pub(crate) shape: Shape,
    #[cfg(feature = "names")]
    names: Names<'a>,
}

/// Facts about all values of a dictionary, found once by `od_eds::Tables`.
#[doc(hidden)]
#[derive(Clone, Copy, Debug)]
pub struct Shape {
    /// Number of bytes that a store of the values needs.
    pub store_len: usize,
    /// Number of bytes of the longest value that one SDO transfer carries.
    pub longest: usize,
    /// Whether an application has to stream one of the values.
    pub has_streams: bool,
    /// Functions for REALs, if the dictionary has any.
    pub reals: Option<&'static Reals>,
    /// Functions for strings and DOMAINs, if the dictionary has any.
    pub varying: Option<&'static Varying>,
}

impl Shape {
    /// Facts about these rows and their pool. The functions for REALs and strings are set even if
    /// there are none.
    pub fn of(rows: &[Row], pool: &[u32], store_len: usize) -> Self {
        Self {
            store_len,
            longest: rows.iter().map(|row| row.longest(pool)).max().unwrap_or(0),
            has_streams: rows.iter().any(Row::is_streamed),
            reals: Reals::SOME,
            varying: Varying::SOME,
        }
    }
}

/// Names of the objects and entries of a dictionary.
///
/// ```
/// # let description = od_eds::parse(include_str!("../../devices/eds/GXMM.eds")).description;
/// # let tables = od_eds::Tables::new(&description);
/// let names = tables.names();
/// // A row for each entry: the names of the object and of the entry.
/// assert_eq!(names.rows.len(), tables.dictionary().len());
/// assert!(names.text.contains("Position value"));
/// ```
#[derive(Clone, Copy, Debug)]
pub struct Names<'a> {
    /// For each entry the start and length of its own name, then of the name of its object:
    /// little-endian numbers of four bytes.
    pub rows: &'a [[u8; 16]],
    /// The text of all names, each of them once.
    pub text: &'a str,
}

impl Names<'_> {
    /// The row of an entry's name and of its object's.
    pub fn row([own, object]: [Range; 2]) -> [u8; 16] {
        let words = [own.start, own.len, object.start, object.len];
        let mut row = [0; 16];
        for (to, word) in row.as_chunks_mut::<4>().0.iter_mut().zip(words) {
            *to = word.to_le_bytes();
        }
        row
    }
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
        Shape {
            store_len: 0,
            longest: 0,
            has_streams: false,
            reals: None,
            varying: None,
        },
        Names {
            rows: &[],
            text: "",
        },
    );

    /// A view over tables that are known to be valid because `od_eds::Tables` made them.
    #[doc(hidden)]
    #[allow(clippy::too_many_arguments)] // each is a table
    pub const fn trusted(
        buckets: Buckets<'a>,
        rows: &'a [Row],
        pool: &'a [u32],
        text: &'a str,
        blob: &'a [u8],
        shape: Shape,
        names: Names<'a>,
    ) -> Self {
        #[cfg(not(feature = "names"))]
        let _ = names;
        Self {
            buckets,
            rows,
            arenas: Arenas { pool, text, blob },
            shape,
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

    /// Number of bytes that a store of this dictionary's values needs.
    pub const fn store_len(&self) -> usize {
        self.shape.store_len
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
        let [start, len, start_of_object, len_of_object] =
            *self.names.rows[position].as_chunks::<4>().0
        else {
            return [Range::new(NAME, 0); 2];
        };
        let number = u32::from_le_bytes;
        [
            Range::new(number(start) | NAME, number(len)),
            Range::new(number(start_of_object) | NAME, number(len_of_object)),
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
        self.shape.reals
    }

    /// Functions for values whose length varies; `None` if it has none.
    #[doc(hidden)]
    pub const fn varying(&self) -> Option<&'static Varying> {
        self.shape.varying
    }

    /// The object at `index`.
    pub fn object(&self, index: u16) -> Option<Object> {
        let first = self.first(index);
        self.object_at(first).filter(|object| object.index == index)
    }

    /// Position of the first entry of an object, or the position where it would be.
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
            // An object has at most 256 sub-indices.
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
    /// [`Missing`] says whether the object or only the sub-index is missing.
    pub fn find(&self, address: Address) -> Result<Entry, Missing> {
        match self.locate(address) {
            Some((position, row)) => Ok(self.unpack(position, *row)),
            None => Err(self.missing(address)),
        }
    }

    /// Position and row of an address, if the dictionary has it. Both are returned in registers.
    #[doc(hidden)]
    pub fn locate(&self, address: Address) -> Option<(usize, &'a Row)> {
        index::position(self.buckets, self.rows, address.key())
    }

    /// Row of an address, if the dictionary has it.
    #[doc(hidden)]
    pub fn row_at(&self, address: Address) -> Option<&'a Row> {
        self.locate(address).map(|(_, row)| row)
    }

    /// Returns which is missing, the object or its sub-object, if [`row_at`](Self::row_at) returns
    /// `None`.
    #[doc(hidden)]
    pub fn missing(&self, address: Address) -> Missing {
        match self.rows.get(self.first(address.index)) {
            Some(row) if row.index() == address.index => Missing::SubIndex,
            _ => Missing::Object,
        }
    }

    /// Entry at index and sub-index, if the dictionary has it.
    #[inline]
    pub fn entry(&self, index: u16, sub: u8) -> Option<Entry> {
        self.find(Address::new(index, sub)).ok()
    }
}

/// Values of a dictionary, by ascending address.
///
/// ```
/// # let description = od_eds::parse(include_str!("../../devices/eds/GXMM.eds")).description;
/// # let tables = od_eds::Tables::new(&description);
/// use od_model::Access;
///
/// let read_only = tables.dictionary().entries().filter(|entry| entry.access == Access::Ro);
/// assert!(read_only.count() > 0);
/// ```
#[derive(Clone, Debug)]
pub struct Entries<'a> {
    dictionary: Dictionary<'a>,
    range: Span<usize>,
}

impl<'a> Entries<'a> {
    /// The values that are left.
    #[must_use]
    pub fn iter(&self) -> Self {
        self.clone()
    }

    /// The value `at` places after the first.
    pub fn get(&self, at: usize) -> Option<Entry> {
        self.range.clone().nth(at).map(|at| self.dictionary.at(at))
    }

    /// Returns whether no value is left.
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
///
/// ```
/// # let description = od_eds::parse(include_str!("../../devices/eds/GXMM.eds")).description;
/// # let tables = od_eds::Tables::new(&description);
/// let indices: Vec<u16> = tables.dictionary().objects().map(|object| object.index).collect();
/// assert!(indices.is_sorted() && indices.first() == Some(&0x1000));
/// ```
#[derive(Clone, Debug)]
pub struct Objects<'a> {
    dictionary: Dictionary<'a>,
    next: usize,
}

impl Objects<'_> {
    /// The objects that are left.
    #[must_use]
    pub fn iter(&self) -> Self {
        self.clone()
    }

    /// Number of objects that are left.
    pub fn len(&self) -> usize {
        self.clone().count()
    }

    /// Returns whether no object is left.
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

impl<'a> Dictionary<'a> {
    /// The text of a range: a name or a VISIBLE_STRING.
    pub fn text(&self, range: Range) -> &'a str {
        #[cfg(feature = "names")]
        let arena = if range.start & NAME != 0 {
            self.names.text
        } else {
            self.arenas.text
        };
        #[cfg(not(feature = "names"))]
        let arena = self.arenas.text;
        let start = (range.start & !NAME) as usize;
        arena
            .get(start..start.saturating_add(range.len as usize))
            .unwrap_or("")
    }

    /// The bytes of a range: an OCTET_STRING or a DOMAIN.
    pub fn blob(&self, range: Range) -> &'a [u8] {
        range.of(self.arenas.blob)
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

/// Two dictionaries are equal if a master cannot tell them apart.
impl PartialEq for Dictionary<'_> {
    /// Compares object by object: names, types, access, limits, defaults, groups. The places of
    /// texts in the arena and of values in the store do not count.
    fn eq(&self, other: &Self) -> bool {
        let literal = |a: Literal, b: Literal| match (a, b) {
            (Literal::Text(a), Literal::Text(b)) => self.text(a) == other.text(b),
            (Literal::Bytes(a), Literal::Bytes(b)) => self.blob(a) == other.blob(b),
            (a, b) => a == b,
        };
        self.len() == other.len()
            && self.objects().len() == other.objects().len()
            && self.objects().zip(other.objects()).all(|(a, b)| {
                (a.index, a.code) == (b.index, b.code)
                    && a.count == b.count
                    && self.text(a.name) == other.text(b.name)
            })
            && self.entries().zip(other.entries()).all(|(a, b)| {
                (a.address, a.data_type, a.access, a.mappable, a.group)
                    == (b.address, b.data_type, b.access, b.mappable, b.group)
                    && self.text(a.name) == other.text(b.name)
                    && literal(a.default, b.default)
                    && literal(a.low, b.low)
                    && literal(a.high, b.high)
            })
    }
}
