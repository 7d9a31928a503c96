//! The stages of the process, and the error status of CiA 302-2.

/// Stage of the process *boot NMT slave*, in its order.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Debug)]
pub enum Stage {
    /// The node is in the network list (1F81h).
    List,
    /// NMT reset communication.
    Reset,
    /// The boot-up message comes within the boot time (1F89h).
    BootUp,
    /// Device type: 1000h against 1F84h.
    DeviceType,
    /// Identity: 1018h:01 to 04 against 1F85h to 1F88h.
    Identity,
    /// Configuration: the concise DCF of 1F22h is written.
    Configuration,
    /// Error control: the first heartbeat comes within the time of 1016h.
    ErrorControl,
    /// NMT start remote node.
    Start,
}

impl Stage {
    /// All stages, in their order.
    pub const ALL: [Self; 8] = [
        Self::List,
        Self::Reset,
        Self::BootUp,
        Self::DeviceType,
        Self::Identity,
        Self::Configuration,
        Self::ErrorControl,
        Self::Start,
    ];
}

/// Error status of the process *boot NMT slave* (CiA 302-2): the reason why the master did not start a slave.
///
/// CiA 302-2 has the letters A to O. The process of this master cannot end with E, F, G, H, I and L: node guarding,
/// programs, and slaves that stay Operational are left out.
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug)]
pub enum Status {
    /// The node is not in the network list (1F81h).
    A,
    /// The node does not respond to the upload of 1000h.
    B,
    /// The device type 1000h differs from 1F84h.
    C,
    /// The vendor-ID 1018h:01 differs from 1F85h.
    D,
    /// The configuration could not be written.
    J,
    /// No heartbeat came when error control began.
    K,
    /// The product code 1018h:02 differs from 1F86h.
    M,
    /// The revision number 1018h:03 differs from 1F87h.
    N,
    /// The serial number 1018h:04 differs from 1F88h.
    O,
}

impl Status {
    /// All that this master can report.
    pub const ALL: [Self; 9] = [
        Self::A,
        Self::B,
        Self::C,
        Self::D,
        Self::J,
        Self::K,
        Self::M,
        Self::N,
        Self::O,
    ];

    /// The letter.
    pub const fn letter(self) -> &'static str {
        match self {
            Self::A => "A",
            Self::B => "B",
            Self::C => "C",
            Self::D => "D",
            Self::J => "J",
            Self::K => "K",
            Self::M => "M",
            Self::N => "N",
            Self::O => "O",
        }
    }

    /// The meaning in words.
    pub const fn text(self) -> &'static str {
        match self {
            Self::A => "the node is not in the network list (1F81h)",
            Self::B => "the node does not respond to the upload of its device type (1000h)",
            Self::C => "the device type (1000h) differs from the expected one (1F84h)",
            Self::D => "the vendor-ID (1018h:01) differs from the expected one (1F85h)",
            Self::J => "the configuration (1F22h) could not be written",
            Self::K => "no heartbeat came when error control began",
            Self::M => "the product code (1018h:02) differs from the expected one (1F86h)",
            Self::N => "the revision number (1018h:03) differs from the expected one (1F87h)",
            Self::O => "the serial number (1018h:04) differs from the expected one (1F88h)",
        }
    }

    /// The status of an identity entry, sub-index 1 to 4 of 1018h.
    pub(super) const fn of_identity(sub: u8) -> Self {
        match sub {
            1 => Self::D,
            2 => Self::M,
            3 => Self::N,
            _ => Self::O,
        }
    }
}
