//! Sizes and codes of a bank; [`image`](super) has the table.

use od_model::Address;

use crate::storage::{Geometry, Storage};

/// The longest value that is saved, in bytes.
pub const MAX_VALUE: usize = 1024;
/// Greatest length of a word of a storage, in bytes. The fields of a header fit into one.
pub(super) const MAX_WORD: usize = 32;

/// Number of bytes of the fields that describe the records: device, length, CRC.
pub(super) const FIELDS: usize = 12;
/// Number of bytes of a record before its value.
pub(super) const RECORD: usize = 5;
/// Index of the records that are not objects: node ID (sub-index 1) and bit rate (2) of LSS.
pub(super) const OWN: u16 = 0;
/// Version of the layout; a part of the device number of a set.
pub(super) const VERSION: u8 = 2;
/// First bytes of a bank in version 1.
pub(super) const MAGIC_1: &[u8] = b"\x69odk";

/// Value of an erased byte.
pub(super) const ERASED: u8 = 0xFF;
/// Codes of the words of a header. Any two differ in four bits. This includes words of flash whose
/// write was interrupted.
static CODES: [u8; 10] = [ERASED, 0, 0xF0, 0xA5, 0xC3, 0x0F, 0x33, 0x3C, 0x55, 0x5A];

/// Content of a word of a header: a position in [`CODES`].
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Debug)]
pub(super) struct Code(u8);

impl Code {
    /// Nothing was written.
    pub(super) const ERASED: Self = Self(0);
    /// Commit word of a save that failed while power was on: the set before it is valid.
    pub(super) const GIVEN_UP: Self = Self(2);
    /// Mark: a save that replaces this set began; until it is complete, this set is valid.
    pub(super) const REPLACED: Self = Self(3);
    /// Mark: a save that replaces this set began; until it is complete, the factory values are
    /// valid.
    pub(super) const WITHDRAWN: Self = Self(4);
    /// The first commit word of a complete set. Four more follow, each newer than the one before
    /// it; after the last one follows the first again.
    pub(super) const FIRST: Self = Self(5);
    const PHASES: u8 = 5;
    /// A word with more than one bit different from every code.
    pub(super) const UNCLEAR: Self = Self(10);

    /// Reads a word; `false` if one bit is wrong.
    pub(super) fn read(word: &[u8]) -> (Self, bool) {
        for (place, code) in (0..).zip(&CODES) {
            let mut wrong = 0;
            for byte in word {
                let bits = byte ^ code;
                // Words with one wrong bit are accepted.
                wrong += u8::from(bits != 0) + u8::from(bits & bits.wrapping_sub(1) != 0);
            }
            if wrong <= 1 {
                // An EEPROM of zeros counts as erased.
                let place = if place == 1 { 0 } else { place };
                return (Self(place), wrong == 0);
            }
        }
        (Self::UNCLEAR, false)
    }

    pub(super) fn byte(self) -> u8 {
        CODES.get(usize::from(self.0)).map_or(ERASED, |code| *code)
    }

    /// Returns whether it is the commit word of a complete set.
    pub(super) fn is_complete(self) -> bool {
        self >= Self::FIRST && self < Self::UNCLEAR
    }

    /// Returns the commit word of a complete set `later` saves after this one.
    pub(super) fn plus(self, later: u8) -> Self {
        Self(Self::FIRST.0 + (self.0 - Self::FIRST.0 + later) % Self::PHASES)
    }

    /// Returns how many saves after another a set was completed: 1, or 2 if the other was not valid
    /// any more. 0: not after it, or not complete.
    pub(super) fn later_than(self, other: Self) -> u8 {
        match () {
            () if !self.is_complete() => 0,
            () if !other.is_complete() => 1,
            () => match (self.0 + Self::PHASES - other.0) % Self::PHASES {
                later @ ..=2 => later,
                _ => 0,
            },
        }
    }
}

/// Sizes of the banks of a storage.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) struct Layout {
    pub(super) page: usize,
    pub(super) word: usize,
    /// Number of bytes of a header: commit word, mark, fields.
    pub(super) header: usize,
    /// Number of bytes of a bank; 0: the storage has no room for one.
    pub(super) size: usize,
}

impl Layout {
    /// A storage without room.
    pub(super) const NONE: Self = Self {
        page: 0,
        word: 0,
        header: 0,
        size: 0,
    };

    pub(super) fn of(storage: &dyn Storage) -> Self {
        let Geometry {
            capacity,
            page,
            word,
        } = storage.geometry();
        let mut layout = Self {
            page,
            word,
            header: header(word),
            size: 0,
        };
        if word.is_power_of_two() && word <= MAX_WORD && page & (word - 1) == 0 {
            let half = capacity / 2;
            let size = half - half % page.max(word).max(1);
            if size >= layout.header {
                layout.size = size;
            }
        }
        layout
    }
}

/// Returns the bytes of a record before its value, for this address.
pub(super) const fn head(key: u32, len: u16) -> [u8; RECORD] {
    let [sub, index_low, index_high, _] = key.to_le_bytes();
    let [len_low, len_high] = len.to_le_bytes();
    [index_low, index_high, sub, len_low, len_high]
}

/// Returns the records of node ID and bit rate, and their length in bytes.
pub(crate) const fn own_records(node_id: u8, bit_rate: Option<u8>) -> ([u8; 12], usize) {
    let [a, b, c, d, e] = head(Address::new(OWN, 1).key(), 1);
    let [f, g, h, i, j] = head(Address::new(OWN, 2).key(), 1);
    let (rate, len) = match bit_rate {
        Some(rate) => (rate, 12),
        None => (0, 6),
    };
    ([a, b, c, d, e, node_id, f, g, h, i, j, rate], len)
}

/// Number of bytes of a header on a storage with words of this size.
pub(super) const fn header(word: usize) -> usize {
    2usize
        .wrapping_mul(word)
        .wrapping_add(whole_words(FIELDS, word))
}

/// Rounds `len` bytes up to whole words; the word length is a power of two.
pub(super) const fn whole_words(len: usize, word: usize) -> usize {
    let rest = word.wrapping_sub(1);
    len.wrapping_add(rest) & !rest
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::storage::StorageError;

    /// A storage of which only the sizes are used.
    struct Sizes(Geometry);

    impl Storage for Sizes {
        fn capacity(&self) -> usize {
            self.0.capacity
        }

        fn geometry(&self) -> Geometry {
            self.0
        }

        fn read(&mut self, _: usize, _: &mut [u8]) -> Result<(), StorageError> {
            Err(StorageError::Device)
        }

        fn write(&mut self, _: usize, _: &[u8]) -> Result<(), StorageError> {
            Err(StorageError::Device)
        }
    }

    #[test]
    fn two_banks_share_a_storage_in_whole_pages_and_words() {
        for (capacity, page, word, size) in [
            (256, 0, 1, 128),
            (258, 0, 4, 128),
            (262, 0, 4, 128),
            (264, 0, 4, 132),
            (1000, 64, 8, 448),
            (1024, 64, 8, 512),
            (4096, 32, 32, 2048),
            // As small as a header, and smaller.
            (28, 0, 1, 14),
            (27, 0, 1, 0),
            (64, 32, 8, 32),
            (63, 32, 8, 0),
            (0, 0, 1, 0),
            // Words that cannot be written.
            (4096, 0, 3, 0),
            (4096, 0, 0, 0),
            (4096, 64, 64, 0),
            (4096, 6, 4, 0),
            (4096, 8, 4, 2048),
        ] {
            let storage = Sizes(Geometry {
                capacity,
                page,
                word,
            });
            let layout = Layout::of(&storage);
            assert_eq!((layout.page, layout.size), (page, size), "{word}");
            assert_eq!(layout.word, word);
        }
        assert_eq!([1, 2, 4, 8, 16, 32].map(header), [14, 16, 20, 32, 48, 96]);
    }

    #[test]
    fn a_complete_set_is_one_or_two_saves_later_than_another() {
        let codes: [Code; 5] = core::array::from_fn(|later| Code::FIRST.plus(later as u8));
        for (at, code) in codes.into_iter().enumerate() {
            assert!(code.is_complete());
            assert_eq!(code.plus(5), code);
            for (other_at, other) in codes.into_iter().enumerate() {
                let expected = [0, 1, 2, 0, 0][(at + 5 - other_at) % 5];
                assert_eq!(code.later_than(other), expected, "{at} {other_at}");
            }
            for other in [Code::ERASED, Code::GIVEN_UP, Code::UNCLEAR] {
                assert_eq!((code.later_than(other), other.later_than(code)), (1, 0));
                assert!(!other.is_complete());
            }
        }
    }

    #[test]
    fn a_word_may_have_one_wrong_bit() {
        let byte = Code::FIRST.byte();
        for (word, seen) in [
            ([byte, byte], (Code::FIRST, true)),
            ([byte ^ 1, byte], (Code::FIRST, false)),
            ([byte ^ 3, byte], (Code::UNCLEAR, false)),
            ([byte ^ 1, byte ^ 1], (Code::UNCLEAR, false)),
            ([0, 0], (Code::ERASED, true)),
            ([0xFF, 0xFF], (Code::ERASED, true)),
        ] {
            assert_eq!(Code::read(&word), seen);
        }
    }
}
