//! Calls of `object_dictionary!` in Rust source: the objects of the file that `eds =` names.

pub(crate) mod base;
pub(crate) mod call;
pub(crate) mod check;
pub(crate) mod features;
pub(crate) mod scan;
