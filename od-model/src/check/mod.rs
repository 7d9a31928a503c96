//! What must hold in a description before a device is made of it.

use alloc::vec::Vec;

use crate::{Description, Diagnostic};

/// All that is wrong with a description, in file order.
pub fn check(description: &Description) -> Vec<Diagnostic> {
    let _ = description;
    Vec::new()
}
