//! Limits of a value: their kinds and words are in the pool.

use super::{RANGE, Row, bits, number, word, words};

impl Row {
    /// Lower limit, as [`default`](Self::default) has numbers; `None`: the type limits the value.
    #[inline]
    pub const fn low(self, pool: &[u32], node_id: u8) -> Option<u64> {
        match (self.0[3] >> 14) as usize {
            0 => None,
            at => limit(pool, at, word(pool, at - 1) & 7, node_id),
        }
    }

    /// Upper limit, as [`low`](Self::low).
    #[inline]
    pub const fn high(self, pool: &[u32], node_id: u8) -> Option<u64> {
        let at = (self.0[3] >> 14) as usize;
        if at == 0 {
            return None;
        }
        let kinds = word(pool, at - 1);
        limit(pool, at + words(kinds & 7), kinds >> 3, node_id)
    }
}

#[inline(never)]
const fn limit(pool: &[u32], at: usize, kind: u32, node_id: u8) -> Option<u64> {
    match kind {
        0 | RANGE => None,
        _ => Some(number(kind, bits(pool, at, kind), node_id)),
    }
}
