//! Bytes to meaning and back, one module a service; nothing here has state.

pub mod emcy;
pub mod lss;
pub mod nmt;
pub mod pdo;
pub mod sdo;
