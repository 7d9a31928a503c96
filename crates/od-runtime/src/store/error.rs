//! Errors of a store that cannot be made, and of a text that does not fit.

use core::fmt;

/// The slice is shorter than [`Dictionary::store_len`](od_model::Dictionary::store_len).
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug)]
pub struct StoreTooSmall {
    /// Number of bytes that the dictionary needs.
    pub needed: usize,
}

impl fmt::Display for StoreTooSmall {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let needed = self.needed;
        write!(
            f,
            "the values of the dictionary need {needed} bytes; lend a longer slice"
        )
    }
}

impl core::error::Error for StoreTooSmall {}

/// The text is longer than the object's capacity.
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug)]
pub struct TextTooLong {
    /// Number of bytes that the object can hold.
    pub capacity: usize,
}

impl fmt::Display for TextTooLong {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(
            f,
            "the text is longer than its object; the limit is {} bytes",
            self.capacity
        )
    }
}

impl core::error::Error for TextTooLong {}
