//! Common parts of the size programs: start-up, the board, and a master that measures.
//!
//! Each program is a complete firmware for `lm3s6965evb`, an emulated Cortex-M3, except for the CAN
//! controller: a script replaces it. `cargo xtask size` builds the programs and prints their
//! output.
#![no_std]

pub mod board;
pub mod master;

use od_thumb as _;
