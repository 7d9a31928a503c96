//! The language of `odkit run` and of the conformance tests: frames, the surroundings of the
//! bus, and expectations, one line after the other, in virtual time.
//!
//! `crates/od-cli/SCRIPTS.md` describes it for authors of scripts.
//!
//! ```
//! use od_sim::script::{run, Bare, Script};
//! # let text = "";
//! let script = Script::parse(text).expect("a script without mistakes");
//! assert!(run(&script, &mut Bare(od_devices::DEVICES)).is_ok());
//! ```

pub mod campaign;
mod console;
mod expect;
mod host;
mod limits;
mod line;
mod outcome;
mod read;
mod run;
mod sdo;
pub mod typed;

pub use campaign::Campaign;
pub use console::Console;
pub(crate) use host::Recorder;
pub use host::{Bare, Host, Limited, Origin};
pub use limits::Limits;
pub use line::{LineContext, frame_of};
pub use outcome::{Reason, Stop, Summary};
pub use read::{Reader, Script, Statement};
pub use run::{run, run_on};

pub use crate::bench::Bench;
pub use crate::grammar::action::{Action, Draw, Expect, NewDevice, Outcome, Timing, When};
pub use crate::grammar::deed::{Deed, LineChange, ShaftChange};
pub use crate::grammar::frames::Frames;
pub use crate::grammar::named_frame::{NamedFrame, Write, resolve};
pub use crate::grammar::pattern::Pattern;
pub use crate::grammar::problem::Problem;
