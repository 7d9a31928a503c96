//! The node from outside, one module per service. It is one program, since each program takes time
//! to link.

mod absent;
mod bus;
mod cob_ids;
mod emcy;
mod encoder;
mod error_behaviour;
mod flash;
mod frequent;
mod guarding;
mod lss;
mod lss_own;
mod nmt;
mod nor;
mod own;
mod pdo;
mod program;
mod random;
mod rooms;
mod save;
mod sdo;
mod servers;
mod store;
mod stream;
mod support;
mod sync_producer;
mod table;
mod time;
mod told;
mod values;
mod watching;
