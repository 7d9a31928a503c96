//! Writes a description as the text of an EDS or a DCF.

pub(crate) mod canonical;
pub(crate) mod describe;
pub(crate) mod eds;
