//! The error counters of one CAN controller, and its error state (ISO 11898-1).

use od_runtime::{BusEvent, Instant};

/// Error warning limit.
const WARNING: u16 = 97;
/// Error passive limit.
pub(super) const PASSIVE: u16 = 128;
/// Bus-off limit of the transmit errors.
const BUS_OFF: u16 = 256;
/// Bits that a controller waits after bus-off: 128 times 11 recessive bits (ISO 11898-1).
const RECOVERY: u64 = 128 * 11;

/// Error state of a controller.
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug)]
pub enum ErrorState {
    /// It takes part without restrictions.
    ErrorActive,
    /// It no longer destroys the frames of others.
    ErrorPassive,
    /// It takes no part until it is restarted.
    BusOff,
}

impl ErrorState {
    /// `error active`, `error passive`, `bus-off`.
    pub const fn name(self) -> &'static str {
        match self {
            Self::ErrorActive => "error active",
            Self::ErrorPassive => "error passive",
            Self::BusOff => "bus-off",
        }
    }
}

/// The error counters of one CAN controller (ISO 11898-1).
#[derive(Clone, Copy, PartialEq, Eq, Debug, Default)]
pub struct Controller {
    /// Transmit error counter.
    pub transmit: u16,
    /// Receive error counter.
    pub receive: u16,
    /// Bus-off: the time from which a restart is allowed.
    pub(super) recovers: Option<Instant>,
}

impl Controller {
    /// Error state.
    pub const fn error_state(self) -> ErrorState {
        if self.transmit >= BUS_OFF {
            ErrorState::BusOff
        } else if self.transmit >= PASSIVE || self.receive >= PASSIVE {
            ErrorState::ErrorPassive
        } else {
            ErrorState::ErrorActive
        }
    }

    /// Event for its device when the state changes to the present one.
    pub(crate) const fn event(self) -> BusEvent {
        match self.error_state() {
            ErrorState::BusOff => BusEvent::Off,
            ErrorState::ErrorPassive => BusEvent::Passive,
            ErrorState::ErrorActive if self.transmit >= WARNING || self.receive >= WARNING => {
                BusEvent::Warning
            }
            ErrorState::ErrorActive => BusEvent::Active,
        }
    }

    pub(super) fn erred_sending(&mut self) {
        self.transmit = (self.transmit + 8).min(BUS_OFF);
    }

    pub(super) fn erred_receiving(&mut self, by: u16) {
        self.receive = (self.receive + by).min(PASSIVE);
    }

    pub(super) fn sent(&mut self) {
        self.transmit = self.transmit.saturating_sub(1);
    }

    pub(super) fn received(&mut self) {
        self.receive = self.receive.min(PASSIVE).saturating_sub(1);
    }

    /// Goes bus-off at a bit rate in kbit/s: the bus must be recessive for some time.
    pub(super) fn waits(&mut self, since: Instant, rate: Option<u16>) {
        let rate = rate.unwrap_or(500).max(1);
        let micros = (RECOVERY * 1000).div_ceil(rate.into());
        self.recovers = Some(since.plus_micros(micros));
    }
}
