//! Absolute encoder (CiA 406): position, scaling, speed, and the objects around them.
//!
//! An [`Encoder`] sits on a shaft, which is a [`Motion`]: [`Sampled`] for a sensor, the exact
//! shaft of `od-sim` for a simulation. It works with any dictionary that has 6004h. What
//! differs between encoder families is data: an [`EncoderProfile`].

mod application;
mod arithmetic;
mod configure;
mod faults;
mod motion;
mod movement;
mod position;
mod power;
mod profile;
mod report;
mod sampled;
mod state;
mod timer;

pub use configure::{REVERSED, SCALING};
pub use motion::{Gain, Motion};
pub use position::{Angle, Scale, Sensor};
pub use profile::{AnyFamily, Counter, EncoderProfile, Family, Gear, GearKind, Mirror, Movement};
pub use profile::{OptionObject, Quantity, RangeRule, Role, Source, Total};
pub use report::{Appears, Fault, Report, Until};
pub use sampled::{PositionSource, Sampled};
pub use state::{Encoder, Switches};

#[cfg(test)]
mod tests;
