//! A built-in device as text: its EDS file and its datasheet.

pub mod datasheet;
mod export;

pub use export::{eds, eds_name};
