//! What is fuzzed, one file per target.

mod bench;
mod candump;
mod console;
mod eds;
mod eeprom;
mod node;
mod script;
mod sdo;
mod slcan;
mod socketcand;

use crate::target::Target;

/// Every target.
pub(crate) const ALL: &[Target] = &[
    sdo::TARGET,
    node::TARGET,
    eeprom::TARGET,
    eds::TARGET,
    script::TARGET,
    console::TARGET,
    slcan::TARGET,
    socketcand::TARGET,
    candump::TARGET,
];
