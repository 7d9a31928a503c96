//! Faults of an encoder, and their reports in a family, as const data.

use od_model::Address;

/// Something that can break.
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug)]
pub enum Fault {
    /// The sensor's position is not to be trusted.
    Position,
    /// The battery of the multiturn counter is nearly empty.
    Battery,
    /// The last reset was by the watchdog; seen after the next reset.
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

    /// Its name in kebab-case.
    pub fn name(self) -> &'static str {
        let named = Self::NAMES.iter().find(|(fault, _)| *fault == self);
        // Every fault is in the list, which a test checks.
        named.map_or("", |(_, name)| name)
    }

    /// The fault with this name.
    pub fn from_name(name: &str) -> Option<Self> {
        let named = Self::NAMES.iter().find(|(_, known)| *known == name);
        named.map(|(fault, _)| *fault)
    }
}

/// When a fault is seen.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Appears {
    /// As long as it is there.
    Always,
    /// By the check at the start: if it is there then.
    Startup,
    /// While the device runs: if it came since the start. What was there before is seen
    /// too, unless another report of the same fault sees it at the start.
    Runtime,
    /// Only where it is injected.
    Injected,
}

/// When a report goes.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Until {
    /// As soon as the fault ends.
    Repaired,
    /// At the next start (power-on, NMT reset node) that does not find the fault.
    Reboot,
    /// Never: neither a start nor the end of the fault ends it.
    Ever,
}

/// Report of a fault in a family. A fault can have several, each its own source of errors.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct Report {
    /// Which.
    pub fault: Fault,
    /// EMCY code.
    pub code: u16,
    /// Bits of 1001h.
    pub register: u8,
    /// Bits of 6503h.
    pub alarm: u16,
    /// Bits of 6505h.
    pub warning: u16,
    /// Object that counts how often it came.
    pub counter: Option<Address>,
    /// When it is seen.
    pub appears: Appears,
    /// When it goes.
    pub until: Until,
    /// With [`Appears::Startup`]: seen only where power was off this long, in milliseconds
    /// (a battery that is tested during that time); 0: at every start.
    pub off_ms: u32,
    /// Code that injects it ([`Role::InjectedError`](super::Role::InjectedError)).
    pub injection: Option<u32>,
}

impl Report {
    /// A fault that is seen as long as it is there and says nothing; for `..Report::BASE`.
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
    use super::*;

    #[test]
    fn every_fault_has_a_name_of_its_own() {
        for (at, (fault, name)) in Fault::NAMES.into_iter().enumerate() {
            // Bits and counters go by the number of a fault.
            assert_eq!(fault as usize, at);
            assert_eq!((fault.name(), Fault::from_name(name)), (name, Some(fault)));
            let kebab = |c: char| c.is_ascii_lowercase() || c == '-';
            assert!(name.chars().all(kebab), "{name}");
        }
        assert_eq!(Fault::from_name(""), None);
    }
}
