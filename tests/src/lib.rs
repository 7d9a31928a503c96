//! What the tests of odkit share.

pub mod corpus;
pub mod scripts;
