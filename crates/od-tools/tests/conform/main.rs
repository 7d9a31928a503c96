//! The conformance test: no false failures, and faults are found.

mod devices;
mod late;
mod learn;
mod living;
mod mutant;
mod mutants;
mod scripts;
mod simulated;
mod stopped;
mod traits;
mod twin;
