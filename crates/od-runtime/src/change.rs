//! Errors that came or went, on their way from the application to the node.

use od_wire::emcy::Emcy;

/// An error came or went.
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug)]
pub enum Change {
    /// It came.
    Raised(Emcy),
    /// The one with this code went; `info` goes into the frame that says so.
    Cleared {
        /// Emergency error code.
        code: u16,
        /// The bits of 1001h that it set, where several errors have this code.
        register: Option<u8>,
        /// Manufacturer-specific bytes 3–7 of the frame.
        info: [u8; 5],
    },
}

impl Change {
    /// Content of an empty place.
    pub(crate) const NONE: Self = Self::Raised(Emcy {
        code: 0,
        register: 0,
        info: [0; 5],
    });
}
