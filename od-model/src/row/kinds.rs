//! Kind of a value, by the number of its data type.

use super::Row;
use crate::types::{DataType, Kind};

/// Kind of each data type, with an element for every number that a row can contain.
static KINDS: [Kind; 32] = {
    let mut kinds = [Kind::Unsigned; 32];
    let mut i = 0;
    while i < DataType::ALL.len() {
        kinds[i] = DataType::ALL[i].kind();
        i += 1;
    }
    kinds
};

impl Row {
    /// Meaning of the bytes, as [`DataType::kind`](crate::DataType::kind) returns it.
    pub const fn kind(self) -> Kind {
        KINDS[(self.0[0] >> 3 & 31) as usize]
    }
}
