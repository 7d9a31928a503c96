//! The fuzz targets, one file each.

mod bench;
mod candump;
mod cob_ids;
mod console;
pub mod eds;
mod eeprom;
mod fix;
mod lesson;
mod logs;
pub mod node;
mod overlay;
mod script;
mod sdo;
mod slcan;
mod socketcand;
mod structure;
mod xdd;

use crate::target::Target;

/// Every target.
pub const ALL: &[Target] = &[
    sdo::TARGET,
    node::TARGET,
    eeprom::TARGET,
    cob_ids::TARGET,
    structure::TARGET,
    eds::TARGET,
    xdd::TARGET,
    overlay::TARGET,
    fix::TARGET,
    script::TARGET,
    lesson::TARGET,
    console::TARGET,
    slcan::TARGET,
    socketcand::TARGET,
    candump::TARGET,
    logs::TARGET,
];

/// The target of this name.
pub fn of(name: &str) -> Option<&'static Target> {
    ALL.iter().find(|target| target.name == name)
}
