//! Writes a device description in the formats of other programs.

pub mod c_header;
pub mod canopennode;
pub mod dbc;
pub mod dcf;
#[cfg(feature = "json")]
pub mod json;
pub mod lost;
pub mod markdown;
