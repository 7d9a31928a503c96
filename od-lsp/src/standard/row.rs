//! A row of the tables.

/// An index, or the first and last one of a range, and the name of the objects there.
pub(super) type Row = (u16, u16, &'static str);
