//! The CAN controller as the node knows it: its states, and times without frames.

use od_wire::Instant;

/// News of the CAN controller (CiA 301, table 26, codes 81xxh).
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug)]
#[non_exhaustive]
pub enum BusEvent {
    /// Error active, with error counters below the warning limit: all is well, or well again,
    /// and no more frames are lost. After bus-off: the controller could begin anew.
    Active,
    /// An error counter passed the warning limit (96).
    Warning,
    /// Error passive: an error counter passed 127.
    Passive,
    /// Bus-off: the transmit error counter passed 255.
    Off,
    /// A received frame was lost, because the one before it was not taken in time.
    Overrun,
}

impl BusEvent {
    /// How bad it is.
    pub(super) const fn level(self) -> u8 {
        match self {
            Self::Active | Self::Overrun => 0,
            Self::Warning => 1,
            Self::Passive => 2,
            Self::Off => 3,
        }
    }
}

/// Nothing is sent or received.
#[derive(Clone, Copy, Debug)]
pub(super) struct Mute {
    /// [`Instant::MAX`]: until the CAN controller is back.
    pub(super) until: Instant,
    /// LSS: the bit rate that is in force then.
    pub(super) bit_rate: Option<u8>,
    /// LSS: silence after that, in milliseconds.
    pub(super) silence_ms: u16,
}

impl Mute {
    pub(super) const BUS_OFF: Self = Self {
        until: Instant::MAX,
        bit_rate: None,
        silence_ms: 0,
    };
}
