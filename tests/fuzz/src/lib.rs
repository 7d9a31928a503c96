//! Fuzz targets, and the harness that needs no nightly compiler.
//!
//! A [`Target`](target::Target) is defined once. `tests/fuzz/main.rs` mutates inputs without
//! coverage to steer it; `tests/fuzz/coverage` gives the same targets to libFuzzer
//! (`cargo xtask fuzz`).
#![forbid(unsafe_code)]

pub mod choices;
pub mod files;
pub mod found;
pub mod generate;
pub mod harness;
pub mod made;
pub mod mutate;
pub mod plan;
pub mod random;
pub mod target;
pub mod targets;
pub mod trace;
mod watch;
