//! The contenders, by discipline and size.

use crate::contender::{Cycles, Nothing, Subject, Uploads};
use crate::discipline::{Discipline, Simulated};
use crate::live::{Cycle, Reading};
use crate::objects::{PDO_SIZE, values};
use crate::odkit::{Odkit, Seconds, Turning};
use crate::peers::canopen_rs::{CanopenRs, room};
use crate::peers::canopen_sdo::CanopenSdo;
use crate::peers::zencan::Zencan;

/// The loop without a node.
pub const NOTHING: &str = "(loop only)";
/// The minimum.
pub const CANOPEN_SDO: &str = "canopen-sdo";
/// A peer.
pub const CANOPEN_RS: &str = "canopen-rs";
/// A peer, with an empty critical section.
pub const ZENCAN: &str = "zencan-node";
/// The same peer with its default features: feature `zencan-std`.
pub const ZENCAN_STD: &str = "zencan-node (std)";
/// odkit.
pub const ODKIT: &str = "odkit";

/// All contenders, in the order of the table.
pub const NAMES: [&str; 6] = [ODKIT, CANOPEN_RS, ZENCAN, ZENCAN_STD, CANOPEN_SDO, NOTHING];

/// Name of the zencan-node that was built: a program cannot contain both.
const ZENCAN_BUILT: &str = if cfg!(feature = "zencan-std") {
    ZENCAN_STD
} else {
    ZENCAN
};

/// The contender of that name, checked for right results;
/// `None` if it does not take part.
pub fn subject(name: &str, discipline: Discipline) -> Option<Box<dyn Subject>> {
    let mut subject = match discipline {
        Discipline::Upload(size) => upload(name, size)?,
        Discipline::Pdo => pdo(name)?,
        Discipline::Live if name == ODKIT => Box::new(Reading(Turning::turning())),
        Discipline::LivePdo if name == ODKIT => Box::new(Cycle(Turning::turning())),
        Discipline::Live | Discipline::LivePdo => return None,
        Discipline::Simulation(simulated) => simulation(name, simulated)?,
    };
    subject.verify();
    Some(subject)
}

/// Boxes a contender together with its load.
macro_rules! uploads {
    ($contender:expr, $size:expr) => {
        Some(Box::new(Uploads::new($contender, $size)))
    };
}

fn upload(name: &str, size: usize) -> Option<Box<dyn Subject>> {
    match (name, size) {
        (NOTHING, _) => uploads!(Nothing, size),
        (ODKIT, _) => uploads!(Odkit::new(size), size),
        (ZENCAN_BUILT, _) => uploads!(Zencan::new(size)?, size),
        (CANOPEN_RS, 16) => uploads!(CanopenRs::<{ room(16) }>::new(size), size),
        (CANOPEN_RS, 120) => uploads!(CanopenRs::<{ room(120) }>::new(size), size),
        (CANOPEN_RS, 1_000) => uploads!(CanopenRs::<{ room(1_000) }>::new(size), size),
        (CANOPEN_RS, 5_000) => uploads!(CanopenRs::<{ room(5_000) }>::new(size), size),
        (CANOPEN_SDO, 16) => uploads!(CanopenSdo::<{ values(16) }>::new(size), size),
        (CANOPEN_SDO, 120) => uploads!(CanopenSdo::<{ values(120) }>::new(size), size),
        (CANOPEN_SDO, 1_000) => uploads!(CanopenSdo::<{ values(1_000) }>::new(size), size),
        (CANOPEN_SDO, 5_000) => uploads!(CanopenSdo::<{ values(5_000) }>::new(size), size),
        _ => None,
    }
}

fn pdo(name: &str) -> Option<Box<dyn Subject>> {
    match name {
        ODKIT => Some(Box::new(Cycles(Odkit::new(PDO_SIZE)))),
        CANOPEN_RS => Some(Box::new(Cycles(CanopenRs::<{ room(PDO_SIZE) }>::new(
            PDO_SIZE,
        )))),
        ZENCAN_BUILT => Some(Box::new(Cycles(Zencan::new(PDO_SIZE)?))),
        _ => None,
    }
}

fn simulation(name: &str, simulated: Simulated) -> Option<Box<dyn Subject>> {
    match name {
        ODKIT => Some(Box::new(Seconds::new(simulated))),
        _ => None,
    }
}
