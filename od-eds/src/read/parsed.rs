//! What comes of reading a text.

use alloc::vec::Vec;

use crate::description::Description;
use crate::finding::Finding;

/// What a text says, and what is to be said about the text.
#[derive(Clone, PartialEq, Debug, Default)]
pub struct Parsed {
    /// Everything that was understood.
    pub description: Description,
    /// Everything else, in file order.
    pub diagnostics: Vec<Finding>,
}
