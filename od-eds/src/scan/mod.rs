//! The ground of every reader: lines, sections, names, numbers and encodings of a text, with their
//! places.

pub(crate) mod encoding;
pub(crate) mod find;
pub(crate) mod known;
pub(crate) mod lines;
pub(crate) mod names;
pub(crate) mod number;
pub(crate) mod placed;
