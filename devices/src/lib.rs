//! odkit.
#![no_std]
