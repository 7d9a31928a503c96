//! Common parts of the size programs: start-up, the board, and a master that measures.
//!
//! Each program is a complete firmware for `lm3s6965evb`, an emulated Cortex-M3, but for the CAN
//! controller: a script takes its place. `cargo xtask size` builds them and prints what they report.
#![no_std]

pub mod board;
pub mod master;

use od_thumb as _;
