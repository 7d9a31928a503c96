//! How far somebody is in a lesson.

use std::format;
use std::prelude::v1::*;

use od_model::typed::Scalar;
use od_model::{DataType, Kind};
use od_runtime::{Frame, Instant};

use super::check::{Check, Comparison, Subject};
use super::{Lesson, Step};
use crate::sim::{Bus, VirtualDevice, values};

/// One line of the present step.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct Line {
    /// What is wanted, in the author's words or as it was written.
    pub text: String,
    /// Does it hold?
    pub done: bool,
    /// What is missing; empty if it holds.
    pub missing: String,
}

/// What was seen for one line since its step began.
#[derive(Clone, Debug, Default)]
struct Tracker {
    count: u32,
    last: Option<Instant>,
    /// It happened: what happened once has happened.
    latched: bool,
}

/// Somebody's way through a lesson.
#[derive(Clone, Debug)]
pub struct Progress {
    steps: Vec<Step>,
    step: usize,
    trackers: Vec<Tracker>,
    /// Where the shafts stood when the step began.
    shafts: Vec<f64>,
    since: Instant,
    disturbed: Option<Instant>,
}

impl Progress {
    /// At the first step of a lesson, on a bench that is set up for it.
    pub fn new(lesson: &Lesson, bus: &Bus) -> Self {
        let mut progress = Self {
            steps: lesson.steps.clone(),
            step: 0,
            trackers: Vec::new(),
            shafts: Vec::new(),
            since: bus.now(),
            disturbed: None,
        };
        progress.enter(bus);
        progress
    }

    fn enter(&mut self, bus: &Bus) {
        let checks = self.checks().len();
        self.trackers = std::vec![Tracker::default(); checks];
        self.since = bus.now();
        let turns = |device: &VirtualDevice| device.shaft(bus.now()).map_or(0.0, |one| one.turns);
        self.shafts = bus.devices().iter().map(turns).collect();
    }

    fn checks(&self) -> &[Check] {
        self.steps.get(self.step).map_or(&[], |step| &step.checks)
    }

    /// Number of the present step, from 0; the number of steps when all are done.
    pub fn step(&self) -> usize {
        self.step
    }

    /// Is there nothing left to do?
    pub fn is_done(&self) -> bool {
        self.step == self.steps.len()
    }

    /// A frame went over the bus.
    pub fn frame(&mut self, at: Instant, from_device: bool, frame: &Frame) {
        let Some(step) = self.steps.get(self.step) else {
            return;
        };
        for (check, tracker) in step.checks.iter().zip(&mut self.trackers) {
            match &check.subject {
                Subject::Frame {
                    pattern,
                    from_device: wanted,
                    times,
                    every,
                } if *wanted == from_device && pattern.matches(frame) => {
                    let fits = match (every, tracker.last) {
                        (Some(every), Some(last)) => {
                            at.micros_since(last).abs_diff(*every) <= every / 10
                        }
                        _ => true,
                    };
                    tracker.count = if fits { tracker.count + 1 } else { 1 };
                    tracker.last = Some(at);
                    tracker.latched |= tracker.count >= *times;
                }
                Subject::Abort(code) => {
                    let id = frame.id().as_standard().unwrap_or(0);
                    tracker.latched |= (0x581..=0x67F).contains(&id)
                        && frame.data().first() == Some(&0x80)
                        && frame.data().get(4..8) == Some(&code.to_le_bytes());
                }
                Subject::Emergency(code) => {
                    let id = frame.id().as_standard().unwrap_or(0);
                    tracker.latched |= (0x81..=0xFF).contains(&id)
                        && frame.data().get(..2) == Some(&code.to_le_bytes());
                }
                Subject::Quiet(pattern, _) if from_device && pattern.matches(frame) => {
                    tracker.last = Some(at);
                }
                _ => {}
            }
        }
    }

    /// A frame was disturbed on the wire.
    pub fn disturbed(&mut self, at: Instant) {
        self.disturbed = Some(at);
    }

    /// Looks at the bench; answers whether a step was done by that.
    pub fn look(&mut self, bus: &mut Bus) -> bool {
        if self.is_done() || self.lines(bus).iter().any(|line| !line.done) {
            return false;
        }
        self.step += 1;
        self.enter(bus);
        true
    }

    /// The lines of the present step.
    pub fn lines(&mut self, bus: &mut Bus) -> Vec<Line> {
        let checks = self.checks().to_vec();
        let all = checks.iter().enumerate();
        all.map(|(number, check)| {
            let missing = self.missing(number, check, bus).unwrap_or_default();
            Line {
                text: check.words.clone().unwrap_or_else(|| check.text.clone()),
                done: missing.is_empty(),
                missing,
            }
        })
        .collect()
    }

    /// What keeps a line from holding; `None` if nothing does.
    fn missing(&mut self, number: usize, check: &Check, bus: &mut Bus) -> Option<String> {
        let now = bus.now();
        let tracker = self.trackers.get(number).cloned().unwrap_or_default();
        let happened = |what: String| (!tracker.latched).then_some(what);
        let since = |last: Option<Instant>| now.micros_since(last.unwrap_or(self.since));
        let device = bus.devices().get(check.device);
        let is_about_frames = matches!(
            check.subject,
            Subject::Frame { .. }
                | Subject::Abort(_)
                | Subject::Emergency(_)
                | Subject::Quiet(..)
                | Subject::Undisturbed(_)
                | Subject::Terminators(_)
        );
        if device.is_none() && !is_about_frames {
            return Some("there is no such device".into());
        }
        match &check.subject {
            Subject::Frame { times, every, .. } => happened(match (tracker.count, every) {
                (0, _) => "no such frame yet".into(),
                (count, None) => format!("{count} of {times} so far"),
                (count, Some(_)) => format!("{count} of {times} in this rhythm"),
            }),
            Subject::Abort(code) => happened(format!("no abort {code:08X}h yet")),
            Subject::Emergency(code) => happened(format!("no emergency {code:04X}h yet")),
            Subject::Quiet(_, micros) => (since(tracker.last) < *micros).then(|| {
                format!(
                    "quiet for {} of {} ms",
                    since(tracker.last) / 1000,
                    micros / 1000
                )
            }),
            Subject::Undisturbed(micros) => {
                let last = self.disturbed.filter(|last| *last > self.since);
                (since(last) < *micros).then(|| {
                    format!(
                        "undisturbed for {} of {} ms",
                        since(last) / 1000,
                        micros / 1000
                    )
                })
            }
            Subject::Terminators(count) => (bus.line.terminators != *count)
                .then(|| format!("there are {}", bus.line.terminators)),
            Subject::State(name) => {
                let device = device?;
                let state = match device.is_powered() {
                    true => device.state().name().to_lowercase(),
                    false => "off".into(),
                };
                (state != *name).then(|| format!("it is {state}"))
            }
            Subject::Led { green, led } => {
                let (first, second) = device?.leds();
                let is = if *green { first } else { second };
                (is != *led).then(|| format!("it is {}", is.name()))
            }
            Subject::NodeId(wanted) => {
                let device = device?;
                let is = device.node_id().raw();
                (is != *wanted || !device.is_powered()).then(|| format!("it is {is}"))
            }
            Subject::BitRate(wanted) => {
                let is = device?.bit_rate();
                (is != Some(*wanted)).then(|| match is {
                    Some(is) => format!("it is {is} kbit/s"),
                    None => "it has none".into(),
                })
            }
            Subject::Turned(turns) => {
                let start = self.shafts.get(check.device).copied().unwrap_or(0.0);
                let moved = device?
                    .shaft(now)
                    .map_or(0.0, |one| (one.turns - start).abs());
                if moved >= *turns
                    && let Some(tracker) = self.trackers.get_mut(number)
                {
                    tracker.latched = true;
                    return None;
                }
                happened(format!("{moved:.2} of {turns} turns"))
            }
            Subject::Fault { name, broken } => (device?.is_broken(name) != *broken)
                .then(|| (if *broken { "it is not" } else { "it still is" }).into()),
            Subject::Saved(object) => {
                let found = values::find(device?.dictionary(), object).map(|entry| entry.address);
                let address = match found {
                    Ok(address) => address,
                    Err(why) => return Some(why),
                };
                let unsaved = bus.with(check.device, |device, _| {
                    let saved = device.saved();
                    device.is_unsaved(&saved, address)
                });
                match unsaved.flatten() {
                    Some(false) => None,
                    Some(true) => Some("a power cycle would change it".into()),
                    None => Some("it is no object that is saved".into()),
                }
            }
            Subject::Value {
                object,
                comparison,
                value,
            } => {
                let found = values::find(device?.dictionary(), object);
                let (address, data_type) = match found {
                    Ok(entry) => (entry.address, entry.data_type),
                    Err(why) => return Some(why),
                };
                if !device?.is_powered() {
                    return Some("it has no power".into());
                }
                let bytes = bus.with(check.device, |device, now| device.read(address, now))?;
                let wanted = match values::parse(data_type, value) {
                    Ok(wanted) => wanted,
                    Err(why) => return Some(why),
                };
                let holds = match comparison {
                    Comparison::Equal => bytes == wanted,
                    Comparison::Other => bytes != wanted,
                    Comparison::AtLeast => {
                        integer(data_type, &bytes) >= integer(data_type, &wanted)
                    }
                    Comparison::AtMost => integer(data_type, &bytes) <= integer(data_type, &wanted),
                };
                (!holds).then(|| format!("it is {}", values::show(data_type, &bytes)))
            }
        }
    }
}

fn integer(data_type: DataType, bytes: &[u8]) -> i128 {
    if bytes.len() > 8 {
        return 0;
    }
    match data_type.kind() {
        Kind::Signed => i64::from_wire(bytes).into(),
        _ => u64::from_wire(bytes).into(),
    }
}
