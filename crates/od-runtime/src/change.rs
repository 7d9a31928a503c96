//! Errors that began or ended, as the application reports them to the node.

use od_wire::emcy::Emcy;

/// An error began or ended.
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug)]
pub enum Change {
    /// The error began.
    Raised(Emcy),
    /// The error with this code ended; `info` is in the EMCY message that reports it.
    Cleared {
        /// EMCY error code.
        code: u16,
        /// The bits of 1001h that the error set, if several errors have this code.
        register: Option<u8>,
        /// Manufacturer-specific bytes 3 to 7 of the message.
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
