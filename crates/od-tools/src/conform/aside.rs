//! A case for one built-in device, played on a separate simulated bus, where it can also control
//! shaft, power and switches.

use od_model::Refused;
use od_sim::VirtualDevice;
use od_sim::script::{Host, Origin, Reason, Script, run};
use od_wire::{Frame, Instant, NodeId};

use super::end::{Checked, fail, skip};
use super::record::Traced;

/// Makes a new simulated device, with another node ID than its own if one is given.
pub type Fresh<'f> = &'f dyn Fn(Option<NodeId>) -> Result<VirtualDevice, Refused>;

struct Aside<'a> {
    fresh: Fresh<'a>,
    frames: Vec<Traced>,
}

impl Host for Aside<'_> {
    fn device(&mut self, name: Option<&str>, _: Option<NodeId>) -> Result<VirtualDevice, Refused> {
        match name {
            None => (self.fresh)(None),
            Some(name) => {
                Err(format!("`device {name}`: a case has the device under test only").into())
            }
        }
    }

    fn frame(&mut self, at: Instant, origin: Origin, frame: &Frame) {
        self.frames.push(Traced {
            at,
            ours: origin == Origin::Script,
            frame: *frame,
        });
    }
}

/// Plays a whole script, and returns its frames.
pub(crate) fn play(fresh: Fresh<'_>, first_line: u32, text: &str) -> (Checked, Vec<Traced>) {
    let mut host = Aside {
        fresh,
        frames: Vec::new(),
    };
    let script = match Script::parse_at(text, first_line) {
        Ok(script) => script,
        Err(problems) => {
            let first = problems.first().map(ToString::to_string);
            return (skip(first.unwrap_or_default()), Vec::new());
        }
    };
    let done = match run(&script, &mut host) {
        Ok(_) => Ok(()),
        Err(stop) => match stop.reason {
            Reason::Failed { expected, got } => {
                fail(format!("{expected} (line {})", stop.line), got)
            }
            Reason::Impossible(why) => skip(format!("line {}: {why}", stop.line)),
        },
    };
    (done, host.frames)
}
