//! Process data (CiA 301, chapter 7.2.2): TPDOs, RPDOs and their mapping.

mod mapping;
mod rpdo;
mod tpdo;

pub use mapping::Mapped;
pub use rpdo::Rpdo;
pub use tpdo::Tpdo;

/// Greatest number of PDOs of one direction in CiA 301.
pub(crate) const MAX: u16 = 512;
