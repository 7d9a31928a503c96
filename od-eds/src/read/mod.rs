//! From the sections of a text to a [`Description`].

use alloc::vec::Vec;

use crate::description::Description;
use crate::finding::Finding;

mod compact;
mod compact_pdo;
mod entry;
mod faults;
pub(crate) mod fields;
mod lists;
pub(crate) mod modules;
mod object;
mod other;
mod own_types;
pub(crate) mod sorted;
pub(crate) mod values;
mod words;

/// What a text says, and what is to be said about the text.
#[derive(Clone, PartialEq, Debug, Default)]
pub struct Parsed {
    /// Everything that was understood.
    pub description: Description,
    /// Everything else, in file order.
    pub diagnostics: Vec<Finding>,
}
