//! The states of the CAN controller, and the times in which the node is silent.

use od_wire::Instant;

/// State change or frame loss of the CAN controller (CiA 301, table 26, codes 81xxh).
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug)]
#[non_exhaustive]
pub enum BusEvent {
    /// Error active, with error counters below the warning limit; no further frames are lost. After
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
    /// End of the silence; [`Instant::MAX`]: until the CAN controller restarts.
    pub(super) until: Instant,
    /// LSS: 1 plus the bit rate that is active from `until`; 0: the bit rate stays. A number
    /// instead of an `Option`, so that a node without power is all zeros.
    pub(super) bit_rate: u16,
    /// LSS: further silence after `until`, in milliseconds.
    pub(super) silence_ms: u16,
}

impl Mute {
    /// Returns the bit rate that is active from `until`, if LSS changes it.
    pub(super) fn bit_rate(self) -> Option<u8> {
        self.bit_rate.checked_sub(1).map(|rate| rate as u8)
    }

    pub(super) const BUS_OFF: Self = Self {
        until: Instant::MAX,
        bit_rate: 0,
        silence_ms: 0,
    };
}
