//! Faults, by the names that scripts and pages use.

use od_runtime::encoder::Fault;

/// The names. A device has those that its family reports.
pub const NAMES: [&str; Fault::NAMES.len()] = {
    let mut names = [""; Fault::NAMES.len()];
    let mut at = 0;
    while at < names.len() {
        names[at] = Fault::NAMES[at].1;
        at += 1;
    }
    names
};

/// The fault with this name. `watchdog` shows after the next reset; with `eeprom` nothing can
/// be saved.
pub fn from_name(name: &str) -> Option<Fault> {
    Fault::from_name(name)
}
