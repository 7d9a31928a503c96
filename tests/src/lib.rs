//! Shared parts of odkit's tests.

pub mod corpus;
pub mod scripts;
