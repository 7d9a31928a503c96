//! Lessons on a real bus: those that need only frames, objects and states.

use std::format;
use std::prelude::v1::*;

use od_wire::NodeId;

use super::condition::{Alternative, What};
use super::content::Lesson;
use crate::bench::Bench;
use crate::bus::Bus;
use crate::device::VirtualDevice;
use crate::grammar::fact::Fact;
use crate::grammar::problem::Problem;
use crate::script::Host;

impl Lesson {
    /// Makes the bench of a lesson on a real bus; its devices describe the nodes of the learner.
    ///
    /// # Errors
    /// The first line that needs a virtual bench, with its reason; or the problem of the set-up.
    pub(crate) fn describe(&self, mut bus: Bus, host: &mut dyn Host) -> Result<Bench, Problem> {
        let mut bench = self.set_up_on(Bench::default(), host)?;
        if let Some(problem) = self.virtual_line(&bench.bus) {
            return Err(problem);
        }
        while let Some(device) = bench.bus.remove(0) {
            bus.add(device.describing());
        }
        bench.bus = bus;
        Ok(bench)
    }

    /// Returns the first line that needs a virtual bench.
    fn virtual_line(&self, bus: &Bus) -> Option<Problem> {
        let help = "take it on the virtual bench: leave the real bus first";
        let needs = |line, what| {
            Problem::new(
                line,
                format!("this lesson needs a virtual bench: {what}"),
                help,
            )
        };
        for (line, text) in (self.set_up.line + 1..).zip(self.set_up.text.lines()) {
            let text = text.split('#').next().unwrap_or_default().trim();
            let is_kept = text.is_empty() || text.starts_with("device ") || text == "line ideal";
            // A device without power boots when the learner switches it on.
            if !is_kept || text.ends_with(" off") {
                return Some(needs(line, format!("`{text}` in its set-up")));
            }
        }
        let mut nodes: Vec<NodeId> = bus.devices().iter().map(VirtualDevice::node_id).collect();
        nodes.sort_unstable();
        if nodes.windows(2).any(|two| two[0] == two[1]) {
            return Some(needs(self.set_up.line, "two nodes have one node ID".into()));
        }
        let lines = self.steps.iter().flat_map(|step| &step.checkpoint);
        let conditions =
            lines.flat_map(|line| line.alternatives.iter().map(|one| (line.line, one)));
        let mut wrong = conditions.filter_map(|(line, one)| Some((line, virtual_thing(one)?)));
        let (line, what) = wrong.next()?;
        Some(needs(line, what.into()))
    }
}

/// Subject of a condition that no frame shows.
fn virtual_thing(one: &Alternative) -> Option<&'static str> {
    let What::Fact(fact) = &one.what else {
        let is_line = matches!(one.what, What::Undisturbed | What::Disturbed(_));
        return is_line.then_some("a step looks at the bus line");
    };
    Some(match fact {
        Fact::Value(..) | Fact::State(Some(_)) | Fact::NodeId(_) => return None,
        Fact::Saved(..) => "a step looks into the EEPROM",
        Fact::State(None) => "a step switches the power",
        Fact::Led { .. } => "a step looks at an LED",
        Fact::BitRate(_)
        | Fact::Terminators(_)
        | Fact::ErrorCounter { .. }
        | Fact::Controller(_)
        | Fact::Cable(..) => "a step looks at the bus line",
        Fact::Turned(_) | Fact::Rpm(_) => "a step turns the shaft",
        Fact::Broken(_) => "a step looks at a fault",
        Fact::Pin(..) => "a step looks at a connection",
        Fact::Master(..) => "the bench has a master",
    })
}
