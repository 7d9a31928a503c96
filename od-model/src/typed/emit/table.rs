//! The tables of a compiled dictionary, as they come out of the macro: bytes.
//!
//! A literal of bytes is one token, however many rows it has, and a `const fn` that
//! turns it into a table is compiled once. An expression for each row costs the compiler
//! ten times as much, and an IDE keeps each of its tokens.

pub use crate::dictionary::{Dictionary, Names};
pub use crate::index::{Buckets, bucket_count, buckets, small_buckets};
use crate::real::Reals;
pub use crate::row::Row;
pub use crate::value::Range;
use crate::varying::Varying;

/// A number of its bytes, little-endian. Not `from_le_bytes`: the compiler runs this for
/// every row of every dictionary, and there a call costs as much as twenty operators.
macro_rules! number {
    ($a:ident $b:ident $c:ident $d:ident) => {
        $a as u32 | ($b as u32) << 8 | ($c as u32) << 16 | ($d as u32) << 24
    };
}

/// The words of a literal.
///
/// # Panics
/// If there are not `N` of them. In a `const` that is a compile error.
pub const fn words<const N: usize>(bytes: &[u8]) -> [u32; N] {
    let chunks = bytes.as_chunks::<4>().0;
    assert!(chunks.len() == N, "four bytes a word");
    let mut words = [0; N];
    let mut at = 0;
    while at < N {
        let [a, b, c, d] = chunks[at];
        words[at] = number!(a b c d);
        at += 1;
    }
    words
}

/// The rows of a literal.
///
/// # Panics
/// As for [`words`].
#[rustfmt::skip] // a row is a row
pub const fn rows<const N: usize>(bytes: &[u8]) -> [Row; N] {
    let chunks = bytes.as_chunks::<16>().0;
    assert!(chunks.len() == N, "16 bytes a row");
    let mut rows = [Row([0; 4]); N];
    let mut at = 0;
    while at < N {
        let [a, b, c, d, e, f, g, h, i, j, k, l, m, n, o, p] = chunks[at];
        rows[at] = Row([number!(a b c d), number!(e f g h), number!(i j k l), number!(m n o p)]);
        at += 1;
    }
    rows
}

/// The names of a literal.
///
/// # Panics
/// As for [`words`].
pub const fn names<const N: usize>(bytes: &[u8]) -> [[Range; 2]; N] {
    let rows: [Row; N] = rows(bytes);
    let mut names = [[Range::new(0, 0); 2]; N];
    let mut at = 0;
    while at < N {
        let Row([start, len, start_of_object, len_of_object]) = rows[at];
        names[at] = [
            Range::new(start, len),
            Range::new(start_of_object, len_of_object),
        ];
        at += 1;
    }
    names
}

/// The view over tables that the macro takes out of `od_eds::Tables`.
pub const fn dictionary(
    buckets: Buckets<'static>,
    rows: &'static [Row],
    pool: &'static [u32],
    text: &'static str,
    blob: &'static [u8],
    store_len: usize,
    names: Names<'static>,
) -> Dictionary<'static> {
    let (reals, varying) = (Reals::of(rows), Varying::of(rows));
    Dictionary::trusted(
        buckets, rows, pool, text, blob, store_len, reals, varying, names,
    )
}
