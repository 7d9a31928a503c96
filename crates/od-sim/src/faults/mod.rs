//! Fault cases: a machine with one of several faults, and probes that tell which one it is.
//!
//! A text (`playground/cases/en.md`) has the causes, and the cases: a story, a bench, its causes and its probes. A seed draws the
//! cause and its details, so the same seed is the same case everywhere. Each probe is made on a copy of the bench: its
//! [`Reading`](probe::Reading) does not depend on the probes before it. Which causes fit a reading is played too, so no
//! text says what a probe would show.
//!
//! ```
//! use od_sim::faults::{Collection, Trial};
//! use od_sim::script::Bare;
//! # let text = include_str!("../../../../playground/cases/en.md");
//! let collection = Collection::parse(text).expect("a text without mistakes");
//! let mut host = Bare(od_devices::DEVICES);
//! let trial = Trial::new(&collection, "no-answer", 7).expect("this case exists");
//! let reading = trial.probe(0, &mut host).expect("its bench can be made");
//! assert!(!reading.sights.is_empty());
//! ```

mod collection;
pub mod probe;
pub mod sight;
mod trial;

pub use collection::{Case, Cause, Collection};
pub use trial::{Mark, Trial, UsedProbe};
