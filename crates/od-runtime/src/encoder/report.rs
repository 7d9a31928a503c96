//! Faults of an encoder, and the reports of a family about them, as const data.

use core::fmt;

use od_model::Address;

/// Fault of an encoder: a defect, or a condition outside its limits.
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug)]
#[non_exhaustive]
pub enum Fault {
    /// The position of the sensor is not valid.
    Position,
    /// The battery of the multiturn counter is nearly empty.
    Battery,
    /// The watchdog reset the device; seen after the next reset.
    Watchdog,
    /// The non-volatile memory failed.
    Memory,
    /// The electronics cannot reach the sensor.
    Internal,
    /// The battery of the multiturn counter is empty.
    BatteryEmpty,
    /// The temperature is out of its range.
    Temperature,
    /// The multiturn sensor saw its magnetic fields in a wrong order.
    MultiturnSequence,
    /// The magnetic field at the multiturn sensor is too weak.
    MultiturnStrength,
    /// The electronics cannot reach the multiturn sensor.
    MultiturnCommunication,
    /// The shaft turned faster than the encoder can follow.
    Speed,
    /// The magnetic field at the singleturn sensor is out of its range.
    SingleturnStrength,
    /// Singleturn and multiturn sensor do not agree.
    Supervision,
    /// The multiturn counter lost its power and started again.
    MultiturnReset,
}

impl Fault {
    /// All faults and their names in scripts and on pages. A name never changes.
    pub const NAMES: [(Self, &'static str); 14] = [
        (Self::Position, "position-error"),
        (Self::Battery, "battery-low"),
        (Self::Watchdog, "watchdog"),
        (Self::Memory, "eeprom"),
        (Self::Internal, "internal"),
        (Self::BatteryEmpty, "battery-empty"),
        (Self::Temperature, "temperature"),
        (Self::MultiturnSequence, "multiturn-sequence"),
        (Self::MultiturnStrength, "multiturn-strength"),
        (Self::MultiturnCommunication, "multiturn-communication"),
        (Self::Speed, "overspeed"),
        (Self::SingleturnStrength, "singleturn-strength"),
        (Self::Supervision, "supervision"),
        (Self::MultiturnReset, "multiturn-reset"),
    ];

    /// Returns the name in kebab-case.
    pub fn name(self) -> &'static str {
        let named = Self::NAMES.iter().find(|(fault, _)| *fault == self);
        // Every fault is in the list, which a test checks.
        named.map_or("", |(_, name)| name)
    }

    /// Returns the fault with this name.
    pub fn from_name(name: &str) -> Option<Self> {
        let named = Self::NAMES.iter().find(|(_, known)| *known == name);
        named.map(|(fault, _)| *fault)
    }
}

impl fmt::Display for Fault {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Position => "the position of the sensor is not valid",
            Self::Battery => "the battery of the multiturn counter is nearly empty",
            Self::Watchdog => "the watchdog reset the device",
            Self::Memory => "the non-volatile memory failed",
            Self::Internal => "the electronics cannot reach the sensor",
            Self::BatteryEmpty => "the battery of the multiturn counter is empty",
            Self::Temperature => "the temperature is out of its range",
            Self::MultiturnSequence => {
                "the magnetic fields of the multiturn sensor came in a wrong order"
            }
            Self::MultiturnStrength => "the magnetic field at the multiturn sensor is too weak",
            Self::MultiturnCommunication => "the electronics cannot reach the multiturn sensor",
            Self::Speed => "the shaft turned faster than the encoder can follow",
            Self::SingleturnStrength => {
                "the magnetic field at the singleturn sensor is out of its range"
            }
            Self::Supervision => "singleturn and multiturn sensor do not agree",
            Self::MultiturnReset => "the multiturn counter lost its power and started again",
        })
    }
}

impl core::error::Error for Fault {}

/// Phase in which a report detects its fault.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Appears {
    /// At any time, while the fault lasts.
    Always,
    /// By the check at the start: a fault that is present then.
    Startup,
    /// While the device runs: a fault that appeared since the start. A fault that was present
    /// before is detected, too, unless another report of the same fault detects it at the start.
    Runtime,
    /// Does not occur in operation: only a test injects it.
    Injected,
}

/// Event that ends a report.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Until {
    /// End of the fault.
    Repaired,
    /// Next start (power-on, NMT reset node) without the fault.
    Reboot,
    /// None: neither a start nor the end of the fault ends the report.
    Ever,
}

/// Report of a fault in a family. A fault can have several reports, each with its own errors.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct Report {
    /// Fault that it reports.
    pub fault: Fault,
    /// EMCY code.
    pub code: u16,
    /// Bits of 1001h.
    pub register: u8,
    /// Bits of the alarms (CiA 406, object 6503h).
    pub alarm: u16,
    /// Bits of the warnings (CiA 406, object 6505h).
    pub warning: u16,
    /// Object that counts how often the fault appeared.
    pub counter: Option<Address>,
    /// Phase in which it detects the fault.
    pub appears: Appears,
    /// Event that ends the report.
    pub until: Until,
    /// With [`Appears::Startup`]: time without power, in milliseconds, that the check at a start
    /// needs (a battery is tested during this time; MANUALS.md C-EAM-37). 0: every start checks.
    pub off_ms: u32,
    /// Code that injects the fault ([`Role::InjectedError`](super::Role::InjectedError)).
    pub injection: Option<u32>,
}

impl Report {
    /// Report of [`Fault::Position`] without code and bits, for `..Report::BASE`.
    pub const BASE: Self = Self {
        fault: Fault::Position,
        code: 0,
        register: 0,
        alarm: 0,
        warning: 0,
        counter: None,
        appears: Appears::Always,
        until: Until::Repaired,
        off_ms: 0,
        injection: None,
    };
}

#[cfg(test)]
mod tests {
    use std::string::ToString;

    use super::*;

    #[test]
    fn every_fault_has_a_name_of_its_own() {
        for (at, (fault, name)) in Fault::NAMES.into_iter().enumerate() {
            // Bits and counters go by the number of a fault.
            assert_eq!(fault as usize, at);
            assert_eq!((fault.name(), Fault::from_name(name)), (name, Some(fault)));
            let kebab = |c: char| c.is_ascii_lowercase() || c == '-';
            assert!(name.chars().all(kebab), "{name}");
            let others = Fault::NAMES.iter().filter(|(other, _)| *other != fault);
            let text = fault.to_string();
            assert!(
                text.starts_with("the ") || fault == Fault::Supervision,
                "{text}"
            );
            assert!(
                others
                    .map(|(other, _)| other.to_string())
                    .all(|other| other != text)
            );
        }
        assert_eq!(Fault::from_name(""), None);
    }
}
