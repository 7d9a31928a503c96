//! Sizes that a node needs to serve a dictionary, known at compile time.

use crate::dictionary::Dictionary;
use crate::entry::Entry;
use crate::value::Literal;

impl Dictionary<'_> {
    /// Number of TPDOs that a node needs: up to the last object of 1800h–19FFh, 0–512.
    pub const fn tpdos(&self) -> usize {
        self.pdos(0x1800)
    }

    /// Number of RPDOs that a node needs: up to the last object of 1400h–15FFh, 0–512.
    pub const fn rpdos(&self) -> usize {
        self.pdos(0x1400)
    }

    /// Number of objects from the communication parameter `first` to the last of its kind.
    const fn pdos(&self, first: u16) -> usize {
        let objects = self.objects();
        let mut at = objects.len();
        while at > 0 {
            at -= 1;
            let index = objects[at].index;
            if index < first {
                return 0;
            }
            if index - first < 512 {
                return (index - first) as usize + 1;
            }
        }
        0
    }

    /// Bytes of the longest value, which one SDO transfer carries: the size of a number, the
    /// capacity of a string or domain, the length of a `const` one.
    pub const fn longest(&self) -> usize {
        let entries = self.entries();
        let mut longest = 0;
        let mut at = 0;
        while at < entries.len() {
            let len = entries[at].longest();
            if len > longest {
                longest = len;
            }
            at += 1;
        }
        longest
    }
}

impl Entry {
    /// Bytes of the longest value that the entry can have, without the two of a string's length
    /// in the store.
    pub const fn longest(&self) -> usize {
        if let Some(size) = self.data_type.size() {
            return size;
        }
        let capacity = self.slot.len.saturating_sub(2) as usize;
        match self.default {
            Literal::Text(range) | Literal::Bytes(range) if range.len as usize > capacity => {
                range.len as usize
            }
            _ => capacity,
        }
    }
}
