//! Memory for saved values.
//!
//! An EEPROM or FRAM is a [`Storage`](od_runtime::storage::Storage) as it is. Of flash there are two
//! kinds, for drivers with the traits of `embedded-storage` (feature `flash`):
//!
//! | | [`Nor`] | [`Mirror`] and [`Log`] |
//! |---|---|---|
//! | RAM | none | three times the set of saved values, and all values once |
//! | a save | inside the call of the node that got it: erases a page of each bank, so tens of milliseconds | the call copies the values; a task of low priority makes the set of them and writes flash, in steps of 64 bytes, eight values or one erasure |
//! | erasures | one a save if a bank is one page | less than one a save, spread over all pages |
//! | needs | two banks of pages | three pages or more; a set fits into one, which may be several of the flash ([`Joined`]) |
//!
//! Both answer 1010h when the flash has the values, and power that goes in any step leaves the old set
//! or the new one.

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
