//! The search for an entry by its address.
//!
//! A hash table leads to a row: reading a value takes as long in a large dictionary as in a small
//! one, and most of a dictionary stays out of the cache.

use crate::row::Row;

/// Content of an empty bucket, which no position has.
pub const EMPTY: u16 = u16::MAX;
/// Limit of rows whose positions fit into bytes; 255 is an empty bucket.
pub const SMALL: usize = u8::MAX as usize;

/// A hash table of positions: as bytes where there are no more than [`SMALL`].
#[derive(Clone, Copy, Debug)]
pub enum Buckets<'a> {
    /// [`small_buckets`].
    Bytes(&'a [u8]),
    /// [`buckets`].
    Words(&'a [u16]),
}

impl Buckets<'_> {
    /// Number of buckets.
    const fn len(self) -> usize {
        match self {
            Self::Bytes(all) => all.len(),
            Self::Words(all) => all.len(),
        }
    }

    /// Content of a bucket: a position after the last row if it is empty.
    fn get(self, at: usize) -> Option<usize> {
        match self {
            Self::Bytes(all) => all.get(at).copied().map(usize::from),
            Self::Words(all) => all.get(at).copied().map(usize::from),
        }
    }
}

/// Number of buckets that [`buckets`] makes for this number of rows: a power of two, 1½ to 3 times
/// the number; 0 if the positions do not fit into 16 bits.
#[must_use]
pub const fn bucket_count(rows: usize) -> usize {
    if rows > EMPTY as usize {
        return 0;
    }
    (rows + rows / 2 + 1).next_power_of_two()
}

/// A hash table of the rows' positions; `N` is their [`bucket_count`].
///
/// # Panics
/// If `N` is not their bucket count. In a `const` that is a compile error.
#[must_use]
pub const fn buckets<const N: usize>(rows: &[Row]) -> [u16; N] {
    assert!(N == bucket_count(rows.len()), "the rows' bucket count");
    let mut buckets = [EMPTY; N];
    fill(&mut buckets, rows);
    buckets
}

/// As [`buckets`], for at most [`SMALL`] rows.
///
/// # Panics
/// As [`buckets`].
#[must_use]
pub const fn small_buckets<const N: usize>(rows: &[Row]) -> [u8; N] {
    assert!(rows.len() <= SMALL, "positions that fit into bytes");
    let wide: [u16; N] = buckets(rows);
    let mut buckets = [0; N];
    let mut at = 0;
    while at < N {
        // An empty bucket stays empty.
        buckets[at] = wide[at] as u8;
        at += 1;
    }
    buckets
}

/// Writes the position of each row into its bucket, or into the next empty one.
/// All `buckets` must be empty; their number must be [`bucket_count`].
pub const fn fill(buckets: &mut [u16], rows: &[Row]) {
    let Some(mask) = buckets.len().checked_sub(1) else {
        return;
    };
    let mut i = 0;
    while i < rows.len() {
        // The key is computed without a call: the compiler evaluates this for every row, and there
        // a call takes as long as twenty operators.
        let mut at = own_bucket(rows[i].0[0] >> 8) & mask;
        while buckets[at] != EMPTY {
            at = (at + 1) & mask;
        }
        buckets[at] = i as u16;
        i += 1;
    }
}

/// The row with the address of this key, and its position.
pub(crate) fn position<'a>(
    buckets: Buckets<'_>,
    rows: &'a [Row],
    key: u32,
) -> Option<(usize, &'a Row)> {
    match buckets.len() {
        0 => search(rows, key),
        _ => hashed(buckets, rows, key),
    }
}

/// As [`position`], in the buckets only.
pub(crate) fn hashed<'a>(
    buckets: Buckets<'_>,
    rows: &'a [Row],
    key: u32,
) -> Option<(usize, &'a Row)> {
    let mask = buckets.len().checked_sub(1)?;
    let mut at = own_bucket(key);
    loop {
        let position = buckets.get(at & mask)?;
        // The position in an empty bucket is after the last row.
        let row = rows.get(position)?;
        if row.key() == key {
            return Some((position, row));
        }
        at += 1;
    }
}

/// Searches the sorted rows, if there are more than buckets can number.
fn search(rows: &[Row], key: u32) -> Option<(usize, &Row)> {
    let position = first(rows, key);
    let row = rows.get(position)?;
    (row.key() == key).then_some((position, row))
}

/// Position of the first of the sorted rows with this key or a greater one.
pub(crate) const fn first(rows: &[Row], key: u32) -> usize {
    let (mut from, mut to) = (0, rows.len());
    while from < to {
        let middle = from + (to - from) / 2;
        if middle < rows.len() && rows[middle].key() < key {
            from = middle + 1;
        } else {
            to = middle;
        }
    }
    from
}

/// Bucket at which the search for a key begins; modulo the number of buckets, which is 2¹⁷ at most.
#[inline]
const fn own_bucket(key: u32) -> usize {
    (key.wrapping_mul(0x9E37_79B1) >> 15) as usize
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::vec;
    use std::vec::Vec;

    fn keyed(key: u32) -> Row {
        Row([key << 8, 0, 0, 0])
    }

    #[test]
    fn every_row_is_found_and_no_other() {
        for count in [0, 1, 2, 3, 128, 255, 300, 5_000] {
            let rows: Vec<Row> = (0..count).map(|i| keyed(0x20_0000 + 0x83 * i)).collect();
            let mut buckets = vec![EMPTY; bucket_count(rows.len())];
            fill(&mut buckets, &rows);
            let small: Vec<u8> = buckets.iter().map(|at| *at as u8).collect();
            let mut all = vec![Buckets::Words(&buckets)];
            all.extend((rows.len() <= SMALL).then_some(Buckets::Bytes(&small)));
            for (buckets, (at, row)) in all
                .iter()
                .flat_map(|buckets| rows.iter().enumerate().map(move |row| (*buckets, row)))
            {
                let found = position(buckets, &rows, row.key());
                assert_eq!(found, Some((at, row)));
                assert_eq!(position(buckets, &rows, row.key() + 1), None);
            }
        }
    }

    #[test]
    fn small_buckets_find_the_same_rows() {
        const ROWS: [Row; 3] = [
            Row([0x20_0000 << 8; 4]),
            Row([0x20_0100 << 8; 4]),
            Row([0x60_0400 << 8; 4]),
        ];
        let (small, wide): ([u8; 8], [u16; 8]) = (small_buckets(&ROWS), buckets(&ROWS));
        for (small, wide) in small.into_iter().zip(wide) {
            let is_empty = wide == EMPTY;
            assert_eq!(
                usize::from(small),
                if is_empty { SMALL } else { wide.into() }
            );
        }
    }

    #[test]
    fn more_rows_than_buckets_can_number_are_searched() {
        let rows: Vec<Row> = (0..70_000).map(|i| keyed(3 * i)).collect();
        assert_eq!(bucket_count(rows.len()), 0);
        let none = Buckets::Words(&[]);
        let found = position(none, &rows, 3 * 69_999);
        assert_eq!(found.map(|(at, _)| at), Some(69_999));
        assert_eq!(position(none, &rows, 3 * 69_999 + 1), None);
    }
}
