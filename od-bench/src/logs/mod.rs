//! Logs of a bus as text.

pub mod candump;
