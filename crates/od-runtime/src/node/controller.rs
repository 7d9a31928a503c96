//! The CAN controller as the node knows it: its states, and times without frames.

use od_wire::Instant;

/// State change or frame loss of the CAN controller (CiA 301, table 26, codes 81xxh).
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug)]
#[non_exhaustive]
pub enum BusEvent {
    /// Error active, with error counters below the warning limit; no more frames are lost. After
    /// bus-off: the controller can restart.
    Active,
    /// An error counter passed the warning limit (96).
    Warning,
    /// Error passive: an error counter passed 127.
    Passive,
    /// Bus-off: the transmit error counter passed 255.
    Off,
    /// A received frame was lost because the one before it was not read in time.
    Overrun,
}

impl BusEvent {
    /// Severity, 0 to 3.
    pub(super) const fn level(self) -> u8 {
        match self {
            Self::Active | Self::Overrun => 0,
            Self::Warning => 1,
            Self::Passive => 2,
            Self::Off => 3,
        }
    }
}

/// Time in which the node neither sends nor receives.
#[derive(Clone, Copy, Debug)]
pub(super) struct Mute {
    /// [`Instant::MAX`]: until the CAN controller is back.
    pub(super) until: Instant,
    /// LSS: one more than the bit rate that is in force then; 0: it stays. An `Option` here would
    /// keep a node without power from being all zeros.
    pub(super) bit_rate: u16,
    /// LSS: silence after that, in milliseconds.
    pub(super) silence_ms: u16,
}

impl Mute {
    /// The bit rate that is in force then, if LSS changes it.
    pub(super) fn bit_rate(self) -> Option<u8> {
        self.bit_rate.checked_sub(1).map(|rate| rate as u8)
    }

    pub(super) const BUS_OFF: Self = Self {
        until: Instant::MAX,
        bit_rate: 0,
        silence_ms: 0,
    };
}
