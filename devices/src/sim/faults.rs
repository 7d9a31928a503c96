//! What can break, by the names that scripts and pages use.

use od_runtime::encoder::Fault;

/// The names.
pub const NAMES: [&str; 5] = [
    "position-error",
    "battery-low",
    "watchdog",
    "eeprom",
    "internal",
];

/// The fault with this name. `watchdog` shows after the next reset; with `eeprom` nothing can
/// be saved.
pub fn from_name(name: &str) -> Option<Fault> {
    let at = NAMES.iter().position(|known| *known == name)?;
    [
        Fault::Position,
        Fault::Battery,
        Fault::Watchdog,
        Fault::Memory,
        Fault::Internal,
    ]
    .get(at)
    .copied()
}
