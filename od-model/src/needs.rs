//! Sizes that a node with a dictionary needs, computed at compile time.

use crate::access::Access;
use crate::dictionary::Dictionary;
use crate::entry::Entry;
use crate::index;
use crate::row::Row;

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
        let end = self.first(first + 512);
        match end.checked_sub(1) {
            Some(last) if self.index_at(last) >= first => {
                (self.index_at(last) - first) as usize + 1
            }
            _ => 0,
        }
    }

    /// Returns whether there is an object at `index`.
    pub const fn has(&self, index: u16) -> bool {
        let first = self.first(index);
        first < self.len() && self.index_at(first) == index
    }

    /// Number of SDO servers that a node needs besides the default one: up to the last object of
    /// 1201h–127Fh, 0–127.
    pub const fn servers(&self) -> usize {
        let end = self.first(0x1280);
        match end.checked_sub(1) {
            Some(last) if self.index_at(last) > 0x1200 => (self.index_at(last) - 0x1200) as usize,
            _ => 0,
        }
    }

    /// Number of bytes of the longest value that one SDO transfer carries: the size of a number,
    /// the capacity of a string or DOMAIN, the length of a `const` one, and one segment for a
    /// streamed value.
    pub const fn longest(&self) -> usize {
        self.shape.longest
    }

    /// Returns whether an application has to stream one of the values ([`Entry::is_streamed`]).
    pub const fn has_streams(&self) -> bool {
        self.shape.has_streams
    }

    /// The position of the value whose address has this [key](crate::Address::key).
    #[doc(hidden)]
    pub const fn position(&self, key: u32) -> Option<usize> {
        let position = index::first(self.rows(), key);
        if position < self.len() && self.rows()[position].key() == key {
            Some(position)
        } else {
            None
        }
    }

    /// Last sub-index of an object; 0 if the object is missing.
    #[doc(hidden)]
    pub const fn last_sub(&self, index: u16) -> u8 {
        match self.first(index + 1).checked_sub(1) {
            Some(last) if last < self.len() && self.index_at(last) == index => {
                self.rows()[last].address().sub
            }
            _ => 0,
        }
    }
}

impl Row {
    /// As [`Entry::is_streamed`].
    pub const fn is_streamed(&self) -> bool {
        self.is_variable() && !self.is_stored() && !self.is_const()
    }

    /// Number of bytes of the longest value of the entry, without the two bytes of a string's
    /// length in the store; seven (a segment) if the value is streamed.
    pub(crate) const fn longest(&self, pool: &[u32]) -> usize {
        if !self.is_variable() {
            return self.size();
        }
        let capacity = self.slot(pool).len.saturating_sub(2) as usize;
        match self.range(pool).len as usize {
            len if len > capacity => len,
            _ if self.is_streamed() => 7,
            _ => capacity,
        }
    }
}

impl Entry {
    /// Returns whether it is a string or DOMAIN without a place in the store, which an application
    /// streams.
    pub const fn is_streamed(&self) -> bool {
        self.is_variable() && self.slot.len == 0 && !matches!(self.access, Access::Const)
    }
}
