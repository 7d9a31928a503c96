//! Fuzz targets. A [`Target`](target::Target) is defined once: `tests/fuzz/main.rs` runs it on a stable
//! compiler, `tests/fuzz/coverage` gives it to libFuzzer (`cargo xtask fuzz`).
#![forbid(unsafe_code)]

pub mod choices;
pub mod files;
pub mod generate;
pub mod harness;
pub mod made;
pub mod mutate;
pub mod random;
pub mod sent;
pub mod target;
pub mod targets;
