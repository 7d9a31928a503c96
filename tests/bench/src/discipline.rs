//! Disciplines (what is measured) and their sizes.

use std::fmt;
use std::num::ParseIntError;
use std::str::FromStr;

use crate::objects::SIZES;

/// A measured operation.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Discipline {
    /// One expedited SDO upload from a dictionary of this size.
    Upload(usize),
    /// One SYNC in, one TPDO out.
    Pdo,
    /// One SDO upload of a position that is computed at that moment.
    Live,
    /// One SYNC in, one TPDO with such a position out.
    LivePdo,
    /// One second of virtual time of a device with a 1 ms PDO.
    Simulation(Simulated),
}

/// A device in virtual time, and the content of its PDO.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Simulated {
    /// The device's name, as for `odkit sim`.
    pub device: &'static str,
    /// Whether speed and acceleration follow the position.
    pub is_moving: bool,
}

impl Simulated {
    const fn new(device: &'static str, is_moving: bool) -> Self {
        Self { device, is_moving }
    }
}

/// One device of each manual; those with a speed also with it.
pub const SIMULATED: [Simulated; 5] = [
    Simulated::new("gxmm", false),
    Simulated::new("eam_mt", false),
    Simulated::new("eam_mt", true),
    Simulated::new("en580c", false),
    Simulated::new("en580c", true),
];

impl fmt::Display for Discipline {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Upload(size) => write!(f, "{size}"),
            Self::Pdo => f.write_str("pdo"),
            Self::Live => f.write_str("live"),
            Self::LivePdo => f.write_str("live-pdo"),
            Self::Simulation(Simulated { device, is_moving }) => {
                let what = if *is_moving { "-moving" } else { "" };
                write!(f, "{device}{what}")
            }
        }
    }
}

impl FromStr for Discipline {
    type Err = ParseIntError;

    fn from_str(text: &str) -> Result<Self, Self::Err> {
        let named = disciplines().find(|discipline| discipline.to_string() == text);
        named.map_or_else(|| text.parse().map(Self::Upload), Ok)
    }
}

/// All disciplines, in the order of the table.
pub fn disciplines() -> impl Iterator<Item = Discipline> {
    let uploads = SIZES.into_iter().map(Discipline::Upload);
    let simulations = SIMULATED.into_iter().map(Discipline::Simulation);
    let others = [Discipline::Pdo, Discipline::Live, Discipline::LivePdo];
    uploads.chain(others).chain(simulations)
}
