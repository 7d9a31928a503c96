//! The conformance test: no false failure on what is right, and what is wrong is found.

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
