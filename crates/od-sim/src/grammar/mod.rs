//! The grammar of a line. Scripts, `odkit sim --link -`, `odkit lesson run`, checkpoints of lessons
//! and the console of the page share it.
//!
//! | file | what it reads |
//! |---|---|
//! | `tokens` | the words of a line, numbers |
//! | `duration`, `size` | times with a unit; numbers of bytes with a unit |
//! | `verbs` | the table of verbs, one row per first word; `world` has those outside the bus |
//! | `line` | a complete line: its time, then a verb or a frame |
//! | `draw` | the numbers that a `random` line draws |
//! | `named_frame` | frames by name: `nmt start`, `sync`, `guard`, `read 1017h` |
//! | `master` | lines about the master on the bench |
//! | `pattern`, `frames` | expected frames |
//! | `fact`, `comparison` | conditions about one moment |

pub(crate) mod action;
pub(crate) mod comparison;
pub(crate) mod deed;
pub(crate) mod draw;
pub(crate) mod duration;
pub(crate) mod fact;
pub(crate) mod frames;
pub(crate) mod line;
pub(crate) mod master;
pub(crate) mod named_frame;
pub mod pattern;
pub mod problem;
pub(crate) mod shown;
pub(crate) mod size;
#[cfg(test)]
mod tests;
pub(crate) mod tokens;
mod verbs;
mod world;
