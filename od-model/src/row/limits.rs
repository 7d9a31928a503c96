//! Limits of a value: their kinds and words are in the pool.

use super::{RANGE, Row, bits, number, word, words};

impl Row {
    /// Returns whether the value has limits besides those of its type.
    pub const fn has_limits(self) -> bool {
        self.0[3] >> 14 != 0
    }

    /// Lower or upper limit in the form of [`default`](Self::default); `None` if only the type limits the value.
    pub const fn limit(&self, is_upper: bool, pool: &[u32], node_id: u8) -> Option<u64> {
        let mut at = (self.0[3] >> 14) as usize;
        if at == 0 {
            return None;
        }
        let mut kind = word(pool, at - 1);
        if is_upper {
            at += words(kind & 7);
            kind >>= 3;
        }
        match kind & 7 {
            0 | RANGE => None,
            kind => Some(number(kind, bits(pool, at, kind), node_id)),
        }
    }
}
