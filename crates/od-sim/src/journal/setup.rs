//! A bench without its history: the inputs that bring an empty bench into the present state.
//! They are shorter than a long run, and faster to repeat.

use std::prelude::v1::*;
use std::vec;

use od_wire::Instant;
use od_wire::nmt::{Command, State};

use super::input::{Entry, Input};
use super::parts::{Dip, Rate};
use super::{AddedDevice, Journal};

/// The present state of a device.
struct Station {
    turns: Option<f64>,
    rpm: f64,
    image: Vec<u8>,
    eeprom: Vec<u8>,
    /// Switches of the node ID and of the bit rate.
    switches: (u8, u8),
    is_powered: bool,
    broken: Vec<&'static str>,
    state: State,
    /// The profile of its shaft.
    profile: Option<Input>,
}

impl Journal {
    /// Returns the inputs that make this bench from an empty one; `None` if adding the devices
    /// one after the other cannot give their order.
    pub fn setup(&mut self) -> Option<Vec<Entry>> {
        if !self.is_regular() {
            return None;
        }
        let stations: Vec<_> = (0..self.devices.len())
            .filter_map(|node| self.station(node))
            .collect();
        let mut inputs = Vec::new();
        // During the set-up every frame arrives.
        inputs.push(Input::Line {
            real: false,
            terminators: 2,
            rate: Rate(None),
        });
        let firsts = self.devices.iter().filter(|device| !is_channel(device));
        inputs.extend(firsts.map(|device| Input::Add {
            source: device.source.clone(),
            node_id: device.node_id.raw(),
            place: None,
        }));
        let mut each = |made: &dyn Fn(u8, &Station) -> Vec<Input>| {
            let all = (0..).zip(&stations);
            inputs.extend(all.flat_map(|(node, station)| made(node, station)));
        };
        each(&|node, one| {
            one.turns
                .map(|turns| Input::Turn { node, turns })
                .into_iter()
                .collect()
        });
        // Values that are not saved come from a memory in which they are saved; the true memory follows
        // later, and acts at the next start.
        each(&|node, one| {
            vec![Input::Eeprom {
                node,
                bytes: one.image.clone(),
            }]
        });
        each(&switches);
        each(&|node, _| vec![Input::Power { node, on: false }]);
        each(&|node, one| {
            if one.is_powered {
                vec![Input::Power { node, on: true }]
            } else {
                Vec::new()
            }
        });
        each(&|node, one| {
            vec![Input::Eeprom {
                node,
                bytes: one.eeprom.clone(),
            }]
        });
        each(&|node, one| {
            let broken = one.broken.iter().map(|name| String::from(*name));
            broken
                .map(|name| Input::Fault {
                    node,
                    name,
                    on: true,
                })
                .collect()
        });
        each(&|node, one| {
            let data = match one.state {
                State::Operational if one.is_powered => vec![Command::Start as u8, 0],
                State::Stopped if one.is_powered => vec![Command::Stop as u8, 0],
                _ => return Vec::new(),
            };
            vec![Input::Deliver { node, id: 0, data }]
        });
        // A shaft with a profile begins it again.
        each(&|node, one| match &one.profile {
            Some(profile) => vec![profile.clone()],
            None if one.rpm != 0.0 => vec![Input::Rpm { node, rpm: one.rpm }],
            None => Vec::new(),
        });
        let past = self.past();
        inputs.extend(cyclic_frames(&past));
        let line = &self.rig.bus.line;
        inputs.push(Input::Line {
            real: line.is_real(),
            terminators: line.terminators,
            rate: Rate(line.bit_rate.map(u32::from)),
        });
        inputs.extend(self.training());
        let is_seed = |input: &&&Input| matches!(input, Input::Seed { .. });
        inputs.extend(past.iter().rev().find(is_seed).map(|seed| (*seed).clone()));
        let all = (1..=self.devices.len()).chain([0]);
        let unplugged = all.filter(|station| !line.is_plugged(*station));
        inputs.extend(unplugged.map(|station| Input::Plug {
            station: station as u8,
            on: false,
        }));
        let at = Instant::ZERO;
        let entry = |input| Entry { at, input };
        Some(inputs.into_iter().map(entry).collect())
    }

    /// The list of the master with the nodes that it has started, and the physics of the line, as lines of a script; `None` if both are those of an empty bench.
    #[cfg(feature = "training")]
    fn training(&self) -> Option<Input> {
        use crate::master::{Boot, BootState};

        let bus = &self.rig.bus;
        let devices = bus.devices().len();
        if devices == 0 {
            return None;
        }
        let (cable, new) = (&bus.line.cable, crate::line::cable::Cable::default());
        let mut lines = Vec::new();
        if cable.length != new.length {
            lines.push(std::format!("line length {}", cable.length));
        }
        if cable.shorted != new.shorted {
            lines.push("line short".into());
        }
        if cable.sample_point != new.sample_point {
            let percent = f64::from(cable.sample_point) / 10.0;
            lines.push(std::format!("line sample-point {percent}"));
        }
        if cable.jump != new.jump {
            lines.push(std::format!("line sjw {}", cable.jump));
        }
        for station in (1..=devices).filter(|station| cable.deviation(*station) != 0) {
            let percent = f64::from(cable.deviation(station)) / 10_000.0;
            lines.push(std::format!("use {station}"));
            lines.push(std::format!("line clock {percent}"));
        }
        if let Some(master) = bus.master() {
            let plan = master.plan().lines();
            lines.extend(plan.iter().map(|line| std::format!("master {line}")));
            let is_started = |one: &&Boot| one.state == BootState::Started;
            let started = master.boots().iter().filter(is_started);
            lines.extend(started.map(|one| std::format!("master started {}", one.node)));
        }
        let text = lines.join("\n");
        (!lines.is_empty()).then_some(Input::Script { text })
    }

    /// Without the feature `training` a bench has neither.
    #[cfg(not(feature = "training"))]
    fn training(&self) -> Option<Input> {
        None
    }

    fn station(&mut self, node: usize) -> Option<Station> {
        let is_its = |input: &&&Input| matches!(input, Input::Follow { node: one, .. } if usize::from(*one) == node);
        let profile = if self.rig.moves(node) {
            self.past()
                .iter()
                .rev()
                .find(is_its)
                .map(|input| (*input).clone())
        } else {
            None
        };
        self.rig.bus.with(node, |device, now| {
            let shaft = device.shaft(now);
            let broken = device.faults().into_iter();
            Station {
                turns: shaft.as_ref().map(|shaft| shaft.turns),
                rpm: shaft.map_or(0.0, |shaft| shaft.rpm),
                image: device.image(),
                eeprom: device.eeprom(),
                switches: device.switches(),
                is_powered: device.is_powered(),
                broken: broken.filter(|name| device.is_broken(name)).collect(),
                state: device.state(),
                profile,
            }
        })
    }

    /// Inputs so far.
    fn past(&self) -> Vec<&Input> {
        let done = self.entries.iter().take(self.done);
        done.map(|entry| &entry.input).collect()
    }

    /// The channels of an encoder come with its first one, after all existing devices.
    fn is_regular(&self) -> bool {
        let devices = &self.devices;
        let is_in_place = |at: usize| {
            !is_channel(&devices[at])
                || at > 0 && devices[at - 1].source.name() == devices[at].source.name()
        };
        let moved = |input: &&Input| {
            matches!(
                input,
                Input::Remove { .. } | Input::Add { place: Some(_), .. }
            )
        };
        !devices.iter().any(is_channel)
            || (0..devices.len()).all(is_in_place) && !self.past().iter().any(moved)
    }
}

fn switches(node: u8, station: &Station) -> Vec<Input> {
    let (id, rate) = station.switches;
    let switches = |id, dip| Input::Switches { node, id, dip };
    let dip = |bit| {
        let on = rate & bit != 0;
        switches(None, Some(Dip { bit, on }))
    };
    vec![switches(Some(id), None), dip(1), dip(2), dip(4)]
}

fn is_channel(device: &AddedDevice) -> bool {
    let rest = device.name.strip_prefix(device.source.name());
    rest.is_some_and(|rest| rest.starts_with('.'))
}

/// Cyclic frames, in the order in which they began.
fn cyclic_frames(past: &[&Input]) -> Vec<Input> {
    let mut latest: Vec<(u32, &Input)> = Vec::new();
    for input in past {
        let Input::Repeat { key, .. } = input else {
            continue;
        };
        match latest.iter_mut().find(|(one, _)| one == key) {
            Some((_, there)) => *there = input,
            None => latest.push((*key, input)),
        }
    }
    let goes = |input: &Input| matches!(input, Input::Repeat { micros, .. } if *micros > 0);
    let going = latest.into_iter().filter(|(_, input)| goes(input));
    going.map(|(_, input)| input.clone()).collect()
}
