//! odkit and its peers under the same load: one SDO upload through the whole
//! node, one PDO cycle, simulated seconds per second.
//!
//! `README.md` beside this crate describes how to run it and how to read the result. A new
//! contender implements [`contender::Upload`] (and [`contender::Pdo`]) and gets
//! a line in [`roster`].

pub mod callgrind;
pub mod contender;
pub mod discipline;
pub mod live;
pub mod objects;
pub mod odkit;
pub mod peers;
pub mod results;
pub mod roster;
pub mod stopwatch;
pub mod table;
