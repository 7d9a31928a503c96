//! The foreign contenders, each driven as its documentation says.

pub mod canopen_rs;
pub mod canopen_sdo;
pub mod zencan;
