//! The records of the next set in steps; [`Set::records`] writes them at once.

use super::covered::is_saved;
use super::layout::RECORD;
use super::medium::Medium;
use super::merge::{Origin, Set, Source};
use super::survey::{END, Records};
use crate::profile::StoreProfile;

/// Greatest number of bytes that a step reads or writes, besides some headers.
pub(super) const STEP: usize = 64;

/// Number of rows of the dictionary that a step handles.
const ROWS: usize = 8;

/// Position in the dictionary and in the newest set, both sorted by address.
#[derive(Clone, Debug)]
pub(super) struct Walk {
    row: usize,
    old: Records,
    piece: Option<Piece>,
}

/// The rest of a record that is being written.
#[derive(Clone, Debug)]
struct Piece {
    /// A position in the storage, or the row number of a value of the store.
    from: From,
    done: usize,
    len: usize,
}

#[derive(Clone, Copy, Debug)]
enum From {
    Storage(usize),
    Row(usize),
}

impl Walk {
    pub(super) const NONE: Self = Self {
        row: 0,
        old: Records::NONE,
        piece: None,
    };

    /// Begins at the first record.
    pub(super) fn new(medium: &mut Medium<'_>) -> Self {
        let mut old = medium.records();
        old.next(medium);
        Self { old, ..Self::NONE }
    }

    /// Writes some of the records. Returns whether these were the last.
    pub(super) fn step(&mut self, set: &mut Set<'_, '_>, profile: &StoreProfile) -> bool {
        for _ in 0..ROWS {
            if let Some(mut piece) = self.piece.take() {
                piece.put(set, profile);
                if piece.done < piece.len {
                    self.piece = Some(piece);
                }
                return false;
            }
            if self.next(set, profile) {
                return true;
            }
        }
        false
    }

    /// Goes to the next row or the next record of the newest set. Returns whether that was the last
    /// one.
    fn next(&mut self, set: &mut Set<'_, '_>, profile: &StoreProfile) -> bool {
        let row = set.store.dictionary().rows().get(self.row);
        if row.is_some_and(|row| !is_saved(row)) {
            self.row += 1;
            return false;
        }
        let key = row.map_or(END, |row| row.key());
        let of_old = Piece {
            from: From::Storage(self.old.at.wrapping_sub(RECORD)),
            done: 0,
            len: RECORD + self.old.len,
        };
        if self.old.key < key {
            self.piece = set.keeps(self.old.key).then_some(of_old);
            self.old.next(set.medium);
            return false;
        }
        let Some(row) = row else { return true };
        let is_old = self.old.key == key;
        self.piece = match set.origin(profile, row, is_old) {
            Origin::Store => Some(Piece {
                from: From::Row(self.row),
                done: 0,
                len: set.store.stored(row).len(),
            }),
            Origin::Newest => Some(of_old),
            Origin::None => None,
        };
        if is_old {
            self.old.next(set.medium);
        }
        self.row += 1;
        false
    }
}

impl Piece {
    /// Writes the next bytes.
    fn put(&mut self, set: &mut Set<'_, '_>, profile: &StoreProfile) {
        let part = (self.len - self.done).min(STEP);
        match self.from {
            From::Storage(at) => set.put(Source::Storage(at + self.done), part),
            From::Row(row) => {
                let Some(row) = set.store.dictionary().rows().get(row) else {
                    return;
                };
                if self.len <= STEP {
                    set.value(profile, row);
                } else {
                    set.part(row, self.done, part);
                }
            }
        }
        self.done += part;
    }
}
