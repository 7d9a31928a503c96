//! What the tests of odkit share.

pub mod scripts;
