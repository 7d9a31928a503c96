//! Absolute encoder (CiA 406): angle, scaling, speed, and the objects around them.
//!
//! An [`Encoder`] sits on a shaft, which is a [`Motion`]: [`Sampled`] for a sensor, the exact
//! shaft of `od-bench` for a simulation. It works with any dictionary that has 6004h; what its
//! family does differently is an [`EncoderProfile`].

mod angle;
mod application;
mod configure;
mod family;
mod fault;
mod faults;
mod motion;
mod movement;
mod object;
mod position;
mod power;
mod profile;
mod rate;
mod sampled;
mod state;
mod timer;

pub use angle::Angle;
pub use configure::{REVERSED, SCALING};
pub use family::{AnyFamily, Family};
pub use fault::{Appears, Fault, Report, Until};
pub use motion::{Gain, Motion};
pub use object::{Mirror, Movement, Quantity, Role, Source};
pub use position::{Scale, Sensor};
pub use profile::{Counter, EncoderProfile, Gear, GearKind, Options, RangeRule, Total};
pub use sampled::{PositionSource, Sampled};
pub use state::{Encoder, Switches};

#[cfg(test)]
mod tests;
