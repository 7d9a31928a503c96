//! Calls of `object_dictionary!` in Rust sources, with the objects of the file after `eds =`.

pub(crate) mod base;
pub(crate) mod call;
pub(crate) mod check;
pub(crate) mod features;
pub(crate) mod scan;
