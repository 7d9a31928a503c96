//! The dual LED of the bus cover (manual 000, chapter 7.3).

use od_wire::nmt::State;

/// State of one die of the LED.
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug)]
pub enum Led {
    /// Dark.
    Off,
    /// 200 ms on, 200 ms off, as CiA 303-3 blinks.
    Flashing,
    /// Steady.
    On,
}

impl Led {
    /// All patterns.
    pub const ALL: [Self; 3] = [Self::Off, Self::Flashing, Self::On];

    /// `off`, `flashing`, `on`.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Off => "off",
            Self::Flashing => "flashing",
            Self::On => "on",
        }
    }
}

/// The green die shows the NMT state, the red one errors; they are independent
/// (MANUALS.md U-29, C-GX-39).
pub(crate) fn dual(powered: bool, state: State, warning: bool, error: bool) -> (Led, Led) {
    if !powered {
        return (Led::Off, Led::Off);
    }
    let green = match state {
        State::Initialising => Led::Off,
        State::PreOperational => Led::Flashing,
        State::Operational | State::Stopped => Led::On,
    };
    let red = match (error, warning) {
        (true, _) => Led::On,
        (false, true) => Led::Flashing,
        (false, false) => Led::Off,
    };
    (green, red)
}
