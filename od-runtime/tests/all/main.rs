//! The node from outside, one module a service. One program, since each costs a link.

mod bus;
mod emcy;
mod encoder;
mod error_behaviour;
mod fits;
mod flash;
mod guarding;
mod lss;
mod lss_own;
mod nmt;
mod nor;
mod own;
mod pdo;
mod program;
mod quick;
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
