//! Process data (CiA 301, chapter 7.2.2): TPDOs, RPDOs and their mapping.

mod mapping;
mod rpdo;
mod tpdo;

pub use mapping::Mapped;
pub(crate) use rpdo::Received;
pub use rpdo::Rpdo;
pub use tpdo::Tpdo;

/// Most PDOs of one direction that the standard knows.
pub(crate) const MAX: u16 = 512;
