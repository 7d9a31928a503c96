//! Process data (CiA 301, chapter 7.2.2): TPDOs, RPDOs and their mapping.

mod config;
mod fixed;
mod mapping;
mod rpdo;
mod tpdo;

pub(crate) use fixed::Fixed;
pub(crate) use rpdo::{Received, Rpdo};
pub(crate) use tpdo::Tpdo;

/// Most PDOs of one direction that the standard knows.
pub(crate) const MAX: u16 = 512;
