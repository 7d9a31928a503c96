//! Filters of a bus of python-can.

use od_wire::CanId;

/// A CAN-ID passes if it equals `id` in the bits of `mask`.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(crate) struct Filter {
    pub(crate) id: u32,
    pub(crate) mask: u32,
    /// Only 29 bits (`true`) or 11 bits; `None`: both.
    pub(crate) extended: Option<bool>,
}

impl Filter {
    /// Returns whether a frame with this CAN-ID passes.
    pub(crate) fn passes(&self, id: CanId) -> bool {
        let length_fits = self.extended.is_none_or(|only| only == id.is_extended());
        length_fits && (id.raw() ^ self.id) & self.mask == 0
    }
}

/// Returns whether a frame with this CAN-ID passes one of the filters; without filters all do.
pub(crate) fn passes(filters: Option<&[Filter]>, id: CanId) -> bool {
    filters.is_none_or(|all| all.iter().any(|one| one.passes(id)))
}
