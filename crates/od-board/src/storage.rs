//! Memory for saved values.
//!
//! An EEPROM or FRAM implements [`Storage`](od_runtime::storage::Storage) directly. For NOR flash
//! there are two ways, for drivers with the traits of `embedded-storage` (feature `flash`):
//!
//! | | [`Nor`] | [`Mirror`] and [`Log`] |
//! |---|---|---|
//! | RAM | none | three times the set of saved values, and once all values |
//! | a save | inside the call of the node that received the command: erases a page of each bank,
//! which takes tens of milliseconds | the call copies the values; a task of low priority makes the
//! set and writes flash, in steps of 64 bytes, eight values or one erasure |
//! | erasures | one per save if a bank is one page | less than one per save, spread over all pages
//! |
//! | needs | two banks of pages | three pages or more. A set has to fit into one page; [`Joined`]
//! makes larger pages of several |
//!
//! Both respond to 1010h when the flash contains the values. A power failure in any step leaves the
//! old set or the new one.

#[cfg(feature = "flash")]
mod guard;
#[cfg(feature = "flash")]
mod joined;
#[cfg(feature = "flash")]
mod log;
mod mirror;
#[cfg(feature = "flash")]
mod nor;
#[cfg(feature = "flash")]
mod steps;

#[cfg(feature = "flash")]
pub use joined::Joined;
#[cfg(feature = "flash")]
pub use log::Log;
pub use mirror::Mirror;
#[cfg(feature = "flash")]
pub use nor::Nor;
#[cfg(feature = "flash")]
pub use steps::Steps;
