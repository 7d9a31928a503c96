//! The result of reading a text.

use alloc::vec::Vec;

use crate::description::Description;
use crate::finding::Finding;

/// A description, and the findings about its text.
#[derive(Clone, PartialEq, Debug, Default)]
pub struct Parsed {
    /// All that odkit understood.
    pub description: Description,
    /// All that it did not, in file order.
    pub findings: Vec<Finding>,
}
