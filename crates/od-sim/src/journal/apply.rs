//! Applies an input to the bench.

use std::format;
use std::prelude::v1::*;

use od_wire::NodeId;

use super::input::{Input, frame};
use super::limits::MOST_DEVICES;
use super::parts::{Dip, Rate, Source};
use super::{AddedDevice, Journal};
use crate::device::VirtualDevice;
use crate::grammar::problem::Problem;
use crate::script::Limits;
#[cfg(feature = "lessons")]
use crate::script::{Bare, Limited};

/// Result of an input that adds a device, starts a lesson or runs a script.
#[derive(Debug, Default)]
pub struct Applied {
    /// Number of the device, 0 for a lesson; `None` if it cannot run.
    pub node: Option<usize>,
    /// The findings or problems of the text.
    pub problem: InputProblem,
}

/// Findings of an EDS text, problems of a lesson or a script.
#[derive(Debug, Default)]
#[non_exhaustive]
pub enum InputProblem {
    /// Nothing.
    #[default]
    None,
    /// A sentence.
    Message(String),
    /// Findings in the text of a device.
    #[cfg(feature = "eds")]
    Findings(Vec<od_eds::Finding>),
    /// Problems in the text of a lesson.
    Problems(Vec<Problem>),
}

impl InputProblem {
    /// Returns why an input could not be carried out; `None` if it could.
    pub(super) fn why(&self, is_done: bool) -> Option<String> {
        match self {
            Self::Message(why) => Some(why.clone()),
            Self::Problems(all) if !is_done => all.first().map(|one| format!("{one}")),
            _ => None,
        }
    }
}

impl Applied {
    fn failed(why: impl Into<String>) -> Self {
        Self {
            node: None,
            problem: InputProblem::Message(why.into()),
        }
    }
}

impl Journal {
    pub(super) fn apply(&mut self, input: &Input) -> Applied {
        let rig = &mut self.rig;
        // A script says itself which of its lines act.
        if !matches!(input, Input::Script { .. } | Input::Seed { .. }) {
            rig.note_act();
        }
        match *input {
            Input::Add {
                ref source,
                node_id,
                place,
            } => return self.add(source, node_id, place.map(usize::from)),
            Input::Remove { node } => {
                rig.remove(node.into());
                if usize::from(node) < self.devices.len() {
                    self.devices.remove(node.into());
                }
            }
            Input::Send {
                id,
                ref data,
                extended,
                remote,
            } => {
                if let Some(frame) = frame(id, data, extended, remote) {
                    rig.send(&frame);
                }
            }
            Input::Repeat {
                key,
                id,
                ref data,
                extended,
                remote,
                micros,
            } => {
                if let Some(frame) = frame(id, data, extended, remote) {
                    rig.repeat(key, frame, micros.into());
                }
            }
            Input::Power { node, on } => rig.set_power(node.into(), on),
            Input::Turn { node, turns } => {
                rig.with(node.into(), |device, now| device.turn_to(turns, now));
            }
            Input::Rpm { node, rpm } => {
                rig.follow(node.into(), &[], false);
                rig.with(node.into(), |device, now| device.set_rpm(rpm, now));
            }
            Input::Follow {
                node,
                ref steps,
                repeats,
            } => rig.follow(node.into(), steps, repeats),
            Input::Switches { node, id, dip } => {
                rig.with(node.into(), |device, now| {
                    let (before, rate) = device.switches();
                    let rate = match dip {
                        Some(Dip { bit, on: true }) => rate | bit,
                        Some(Dip { bit, on: false }) => rate & !bit,
                        None => rate,
                    };
                    device.set_node_switch(id.unwrap_or(before), now);
                    device.set_bitrate_switch(rate, now);
                });
            }
            Input::Fault { node, ref name, on } => {
                rig.with(node.into(), |device, now| device.set_fault(name, on, now));
            }
            Input::Line {
                real,
                terminators,
                rate: Rate(rate),
            } => {
                let line = &mut rig.bus.line;
                line.set_real(real);
                line.terminators = terminators;
                line.bit_rate = rate.map(|rate| rate as u16);
            }
            Input::Seed { seed } => rig.bus.line.set_seed(seed.into()),
            Input::Plug { station, on } => rig.bus.line.set_plugged(station.into(), on),
            Input::Restart { station } => {
                rig.bus.restart_controller(station.into());
                rig.collect_frames();
            }
            Input::Cut { node, bytes } => {
                let cut = |device: &mut VirtualDevice, _| device.cut_power_after(bytes as usize);
                rig.bus.with(node.into(), cut);
            }
            Input::Eeprom { node, ref bytes } => {
                rig.bus
                    .with(node.into(), |device, _| device.set_eeprom(bytes));
            }
            Input::Deliver { node, id, ref data } => {
                if let Some(frame) = frame(id, data, false, false) {
                    rig.with(node.into(), |device, now| device.handle_frame(now, &frame));
                }
            }
            Input::Lesson { ref text } => return self.start_lesson(text),
            Input::Leave {} => self.end_lesson(),
            Input::Script { ref text } => return self.run_script(text),
        }
        Applied::default()
    }

    fn add(&mut self, source: &Source, node_id: u8, place: Option<usize>) -> Applied {
        let Some(id) = NodeId::new(node_id) else {
            return Applied::failed("a node ID is 1 to 127");
        };
        let there = self.rig.bus.devices().len();
        let needed = |channels: u8| match place {
            Some(place) if place < there => usize::from(channels) - 1,
            _ => usize::from(channels),
        };
        let full = |channels| there + needed(channels) > MOST_DEVICES;
        let mut added = match source {
            Source::Builtin { name } => match self.roster.iter().find(|kind| kind.name == name) {
                Some(kind) if full(kind.channels) => Applied::failed(Limits::PAGE.room()),
                Some(kind) => Applied {
                    node: Some(self.rig.put_kind(kind, id, place)),
                    problem: InputProblem::None,
                },
                None => Applied::failed(format!("device `{name}` does not exist")),
            },
            #[cfg(feature = "eds")]
            Source::Eds { .. } if full(1) => Applied::failed(Limits::PAGE.room()),
            #[cfg(feature = "eds")]
            Source::Eds { text, lenient, .. } => {
                let options = crate::device::loaded::EdsOptions {
                    node_id: Some(id),
                    lenient: *lenient,
                };
                let (device, findings) = VirtualDevice::read_eds(text, options);
                Applied {
                    node: device.map(|device| self.rig.put(device, place)),
                    problem: InputProblem::Findings(findings),
                }
            }
            #[cfg(not(feature = "eds"))]
            Source::Eds { .. } => Applied::failed("EDS texts are not supported"),
        };
        let devices = self.rig.bus.devices();
        if let Some(node) = added.node {
            let name = match source {
                Source::Builtin { name } => name.clone(),
                Source::Eds { .. } => devices.get(node).map_or("", |one| one.title()).into(),
            };
            let source = source.clone();
            let placed = AddedDevice {
                source,
                node_id: id,
                name,
            };
            match self.devices.get_mut(node) {
                Some(there) => *there = placed,
                None => self.devices.push(placed),
            }
            // The further channels of a redundant encoder are separate nodes.
            for (channel, device) in (2..).zip(devices.iter().skip(self.devices.len())) {
                self.devices.push(AddedDevice {
                    source: source_of(&self.devices, node),
                    node_id: device.node_id(),
                    name: format!("{}.{channel}", self.devices[node].name),
                });
            }
            added.node = Some(node);
        }
        added
    }
}

fn source_of(devices: &[AddedDevice], node: usize) -> Source {
    devices[node].source.clone()
}

#[cfg(feature = "lessons")]
impl Journal {
    fn start_lesson(&mut self, text: &str) -> Applied {
        match self
            .rig
            .start_lesson(text, &mut Limited(&mut Bare(self.roster), Limits::PAGE))
        {
            Ok(lesson) => self.lesson = Some(lesson),
            Err(problems) => {
                return Applied {
                    node: None,
                    problem: InputProblem::Problems(problems),
                };
            }
        }
        let own = self
            .lesson
            .as_ref()
            .map_or(Vec::new(), |lesson| lesson.eds.clone());
        let kind_of = |title: &str| self.roster.iter().find(|kind| kind.title == title);
        let placed = |device: &VirtualDevice| {
            let name = kind_of(device.title()).map_or(device.title(), |kind| kind.name);
            let name = String::from(name);
            // The title of a device of an EDS is its product name.
            let is_own = |(_, text): &&(String, String)| {
                let mut lines = text.lines();
                kind_of(&name).is_none() && lines.any(|line| line == format!("ProductName={name}"))
            };
            let source = match own.iter().find(is_own) {
                Some((file, text)) => Source::Eds {
                    name: file.clone(),
                    text: text.clone(),
                    lenient: false,
                },
                None => Source::Builtin { name: name.clone() },
            };
            AddedDevice {
                source,
                node_id: device.node_id(),
                name,
            }
        };
        self.devices = self.rig.bus.devices().iter().map(placed).collect();
        Applied {
            node: Some(0),
            problem: InputProblem::None,
        }
    }

    fn end_lesson(&mut self) {
        self.rig.end_lesson();
        self.lesson = None;
    }

    fn run_script(&mut self, text: &str) -> Applied {
        match self
            .rig
            .run_script(text, &mut Limited(&mut Bare(self.roster), Limits::PAGE))
        {
            Ok(()) => Applied::default(),
            Err(why) => Applied::failed(why),
        }
    }
}

#[cfg(not(feature = "lessons"))]
impl Journal {
    fn start_lesson(&mut self, _: &str) -> Applied {
        Applied::failed("lessons are not supported")
    }

    fn end_lesson(&mut self) {}

    fn run_script(&mut self, _: &str) -> Applied {
        Applied::failed("scripts are not supported")
    }
}
