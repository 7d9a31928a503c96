//! The tables of a compiled dictionary, as they come out of the macro: numbers and bytes.
//!
//! A row is one literal, and a `const fn` that turns them into a table is compiled once: the compiler runs it for each
//! row, where a call costs as much as twenty operators. An expression for each row costs ten times as much, and an IDE
//! keeps each of its tokens. Names are bytes, which nothing turns into anything.

pub use crate::dictionary::{Dictionary, Names, Shape};
pub use crate::index::{Buckets, bucket_count, buckets, small_buckets};
pub use crate::real::Reals;
pub use crate::row::Row;
pub use crate::value::Range;
pub use crate::varying::Varying;

/// The rows of numbers, of which each has the words of a row, the first one lowest.
#[rustfmt::skip] // a row is a row
pub const fn rows<const N: usize>(numbers: &[u128; N]) -> [Row; N] {
    let mut rows = [Row([0; 4]); N];
    let mut at = 0;
    while at < N {
        let n = numbers[at];
        rows[at] = Row([n as u32, (n >> 32) as u32, (n >> 64) as u32, (n >> 96) as u32]);
        at += 1;
    }
    rows
}

/// The names of a literal.
pub const fn names(bytes: &'static [u8]) -> &'static [[u8; 16]] {
    bytes.as_chunks().0
}
