//! Progress of a learner in a lesson.

use std::collections::VecDeque;
use std::format;
use std::prelude::v1::*;

use od_runtime::{Frame, Instant};

use super::condition::{Alternative, Line, Seen, What};
use super::content::{Lesson, Step};
use crate::bench::Bench;
use crate::bus::{Bus, UNTIL_QUIET};
use crate::device::VirtualDevice;
use crate::grammar::fact::Fact;
use crate::script::Origin;

/// A condition of the current step.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct Requirement {
    /// It holds.
    pub holds: bool,
    /// It held when the step began, and has held since.
    pub already: bool,
    /// It held since the step began but no longer does; the learner may be unable to restore it.
    pub lost: bool,
    /// The condition in words; while it does not hold, its present state follows in parentheses.
    pub text: String,
}

/// Observations of one alternative since the step began.
#[derive(Clone, Copy, Default, Debug)]
struct Note {
    /// Number of matching frames.
    count: u32,
    /// Time of the last one.
    last: Option<Instant>,
    /// Time when there were enough.
    done: Option<Instant>,
    /// Time since which the condition holds.
    since: Option<Instant>,
    /// The condition was checked, and held at some time.
    looked: bool,
    held: bool,
    /// It held when the step began, and at each check since.
    already: bool,
}

/// Watches a bench during a lesson.
///
/// Pass every frame to it, then call its check; neither changes the bench.
pub struct Progress {
    lesson: Lesson,
    /// Number of each device in the lesson.
    devices: Vec<(String, usize)>,
    step: usize,
    began: Instant,
    /// Position of each shaft when the step began.
    turns: Vec<Option<f64>>,
    notes: Vec<Vec<Note>>,
    /// Time since which all conditions hold.
    met: Option<Instant>,
    /// The learner has acted in this step.
    acted: bool,
    /// All conditions held before the learner acted.
    idle: bool,
    /// Microseconds by which a frame may come late because the line is not free.
    late: u64,
    /// Time of a disturbed frame.
    disturbed: Option<Instant>,
    reached: Vec<Instant>,
    news: VecDeque<usize>,
}

impl Progress {
    /// Begins with the first step, on the bench after its set-up.
    pub fn new(lesson: Lesson, bench: &mut Bench) -> Self {
        let mut devices = Vec::new();
        for name in lesson.devices_named() {
            if let Some(number) = bench.device(name) {
                devices.push((name.to_owned(), number));
            }
        }
        let mut progress = Self {
            lesson,
            devices,
            step: 0,
            began: Instant::ZERO,
            turns: Vec::new(),
            notes: Vec::new(),
            met: None,
            acted: false,
            idle: false,
            late: 0,
            disturbed: None,
            reached: Vec::new(),
            news: VecDeque::new(),
        };
        progress.begin(0, &mut bench.bus);
        progress
    }

    /// The lesson.
    pub fn lesson(&self) -> &Lesson {
        &self.lesson
    }

    /// The current step, counted from 0; the number of steps when all are done.
    pub fn step(&self) -> usize {
        self.step
    }

    /// Returns whether every checkpoint is reached.
    pub fn is_done(&self) -> bool {
        self.step >= self.lesson.steps.len()
    }

    /// Time when each checkpoint was reached.
    pub fn reached(&self) -> &[Instant] {
        &self.reached
    }

    /// Returns the step of a checkpoint that was reached since the last call.
    pub fn poll(&mut self) -> Option<usize> {
        self.news.pop_front()
    }

    /// Goes to a step as if the previous ones had just been done; earlier frames do
    /// not count for it.
    pub fn begin(&mut self, step: usize, bus: &mut Bus) {
        self.step = step.min(self.lesson.steps.len());
        self.reached.truncate(self.step);
        while self.reached.len() < self.step {
            self.reached.push(bus.now());
        }
        self.began = bus.now();
        self.late = bus.longest_wait();
        self.met = None;
        (self.acted, self.idle) = (false, false);
        let turns = |device: &VirtualDevice| device.shaft(bus.now()).map(|shaft| shaft.turns);
        self.turns = bus.devices().iter().map(turns).collect();
        self.forget();
        let since = (self.began, self.disturbed);
        let step = self.lesson.steps.get(self.step);
        for (line, notes) in step
            .iter()
            .flat_map(|step| &step.checkpoint)
            .zip(&mut self.notes)
        {
            for (one, note) in line.alternatives.iter().zip(notes) {
                let device = device_of(&self.devices, one);
                let turns = self.turns.get(device).copied().flatten();
                note.already = holds(one, note, bus, device, turns, since).0;
            }
        }
    }

    /// Notes that the learner acts on the bench. A step is done only after that, because its
    /// conditions may hold when it begins.
    pub fn note_act(&mut self) {
        self.acted = true;
    }

    /// Returns whether all conditions of this step held at some time, and the learner has not acted in it.
    pub fn is_idle(&self) -> bool {
        self.idle && !self.acted
    }

    fn forget(&mut self) {
        let notes = |line: &Line| line.alternatives.iter().map(|_| Note::default()).collect();
        let step = self.lesson.steps.get(self.step);
        self.notes = step.map_or(Vec::new(), |step| {
            step.checkpoint.iter().map(notes).collect()
        });
    }

    /// Notes an error frame.
    pub fn disturbed(&mut self, at: Instant) {
        self.disturbed = Some(at);
        let Some(step) = self.lesson.steps.get(self.step) else {
            return;
        };
        for (line, notes) in step.checkpoint.iter().zip(&mut self.notes) {
            for (one, note) in line.alternatives.iter().zip(notes) {
                if let What::Disturbed(times) = one.what {
                    note.count(at, times, None, 0);
                }
            }
        }
    }

    /// Notes a frame.
    pub fn frame(&mut self, at: Instant, origin: Origin, frame: &Frame) {
        let Some(step) = self.lesson.steps.get(self.step) else {
            return;
        };
        // A missing device sends nothing.
        let device = |name: &Option<String>| {
            let name = name.as_deref()?;
            Some(number(&self.devices, Some(name)).unwrap_or(usize::MAX))
        };
        let mut again = false;
        // Go from the last line to the first, so that one frame counts for only one line of a sequence.
        for (number, line) in step.checkpoint.iter().enumerate().rev() {
            let before = number.checked_sub(1).and_then(|above| {
                self.notes
                    .get(above)?
                    .iter()
                    .filter_map(|note| note.done)
                    .max()
            });
            for (place, one) in line.alternatives.iter().enumerate() {
                let Some(note) = self
                    .notes
                    .get_mut(number)
                    .and_then(|row| row.get_mut(place))
                else {
                    continue;
                };
                match &one.what {
                    What::Seen(seen) if seen.matches(origin, device(&one.device), frame) => {
                        if one.not {
                            again = true;
                            continue;
                        }
                        if line.then {
                            let Some(before) = before else { continue };
                            let late = |within| at.micros_since(before) > within;
                            if seen.within.is_some_and(late) {
                                continue;
                            }
                        }
                        note.count(at, seen.times, seen.every, self.late);
                    }
                    What::Quiet(pattern) if pattern.matches(frame) => note.last = Some(at),
                    _ => {}
                }
            }
        }
        if again {
            self.forget();
        }
    }

    /// Checks the bench, after each frame and after every other event. Returns whether the
    /// current step is done; then the next one has begun.
    pub fn look(&mut self, bus: &mut Bus) -> bool {
        let Some(step) = self.lesson.steps.get(self.step) else {
            return false;
        };
        let mut all = true;
        let since = (self.began, self.disturbed);
        for (line, notes) in step.checkpoint.iter().zip(&mut self.notes) {
            let mut any = false;
            for (one, note) in line.alternatives.iter().zip(notes) {
                // Check lasting conditions each time, the others once, when the frames are complete.
                if one.lasting > 0 || !note.looked || (all && !any) {
                    let device = device_of(&self.devices, one);
                    let turns = self.turns.get(device).copied().flatten();
                    any |= holds(one, note, bus, device, turns, since).0;
                }
            }
            all &= any;
        }
        // The last frames of a step, such as the response to a download, belong to it.
        let now = bus.now();
        let met = self.met.filter(|_| all).unwrap_or(now);
        self.met = all.then_some(met);
        self.idle |= all && !self.acted;
        let is_complete = !bus.is_busy() || now.micros_since(met) >= UNTIL_QUIET;
        let is_done = all && is_complete && self.acted;
        if is_done {
            let done = self.step;
            self.news.push_back(done);
            self.reached.push(now);
            self.begin(done + 1, bus);
        }
        is_done
    }

    /// Returns the conditions of the current step, with their state.
    pub fn requirements(&mut self, bus: &mut Bus) -> Vec<Requirement> {
        let Some(step) = self.lesson.steps.get(self.step) else {
            return Vec::new();
        };
        let devices = &self.devices;
        let since = (self.began, self.disturbed);
        let mut requirements = Vec::new();
        for (line, notes) in step.checkpoint.iter().zip(&mut self.notes) {
            let named = |name: &str| number(devices, Some(name)).unwrap_or(0);
            let mut text = line.words(bus.devices(), named);
            let (mut met, mut held, mut already) = (false, false, false);
            let mut state = String::new();
            for (one, note) in line.alternatives.iter().zip(notes) {
                let device = device_of(devices, one);
                let turns = self.turns.get(device).copied().flatten();
                let (holds, now) = holds(one, note, bus, device, turns, since);
                let now = now.words(&self.lesson.language);
                met |= holds;
                held |= note.held;
                already |= holds && note.already;
                if !now.is_empty() {
                    state = now;
                }
            }
            if !met && !state.is_empty() {
                text.push_str(&format!(" ({state})"));
            }
            requirements.push(Requirement {
                holds: met,
                already,
                lost: held && !met,
                text,
            });
        }
        requirements
    }

    /// Returns conditions that this bench cannot meet: the line number, and the reason.
    pub(super) fn impossible(&self, bus: &mut Bus) -> Vec<(u32, String)> {
        let mut found = Vec::new();
        for line in self.lesson.steps.iter().flat_map(|step| &step.checkpoint) {
            for one in &line.alternatives {
                if let Some(name) = &one.device
                    && number(&self.devices, Some(name)).is_none()
                {
                    found.push((line.line, format!("the set-up has no device `{name}`")));
                } else if let What::Fact(fact) = &one.what
                    && let Err(why) = fact.look(bus, device_of(&self.devices, one), None)
                {
                    found.push((line.line, why));
                }
            }
        }
        found
    }
}

impl Note {
    fn count(&mut self, at: Instant, times: u32, every: Option<(u64, u64)>, late: u64) {
        let in_time = match (every, self.last) {
            (Some((low, high)), Some(last)) => {
                (low.saturating_sub(late)..=high + late).contains(&at.micros_since(last))
            }
            _ => true,
        };
        self.count = if in_time {
            self.count.saturating_add(1)
        } else {
            1
        };
        self.last = Some(at);
        if self.count >= times {
            self.done = Some(at);
        }
    }
}

impl Lesson {
    fn devices_named(&self) -> impl Iterator<Item = &str> {
        let lines = self.steps.iter().flat_map(|step: &Step| &step.checkpoint);
        lines
            .flat_map(|line| &line.alternatives)
            .filter_map(|one| one.device.as_deref())
    }
}

fn number(devices: &[(String, usize)], name: Option<&str>) -> Option<usize> {
    let name = name?;
    let (_, number) = devices.iter().find(|(known, _)| known == name)?;
    Some(*number)
}

/// The device of a condition; the first if it names none.
fn device_of(devices: &[(String, usize)], one: &Alternative) -> usize {
    number(devices, one.device.as_deref()).unwrap_or(0)
}

/// The present state of a condition.
enum Now {
    Nothing,
    /// Number of frames so far, and how many are needed.
    Count(u32, u32),
    WithoutPower,
    /// The value or state.
    Is(String),
    /// The reason why it cannot be looked at.
    Other(String),
}

impl Now {
    /// The state in words, in German for a lesson in German.
    fn words(self, language: &str) -> String {
        match (self, language) {
            (Self::Nothing, _) => String::new(),
            (Self::Count(count, times), "de") => format!("bisher {count} von {times}"),
            (Self::Count(count, times), _) => format!("{count} of {times} so far"),
            (Self::WithoutPower, "de") => "das Gerät hat keine Versorgung".into(),
            (Self::WithoutPower, _) => "the device has no power".into(),
            (Self::Is(now), "de") => format!("jetzt {}", german(&now)),
            (Self::Is(now), _) => format!("it is {now}"),
            (Self::Other(why), _) => why,
        }
    }
}

/// A state of a condition in German; numbers and terms of CiA and ISO stay.
fn german(now: &str) -> String {
    let words = match now {
        "on" => "an",
        "off" => "aus",
        "flashing" => "blinkend",
        "active" => "aktiv",
        "not active" => "nicht aktiv",
        "not booted yet" => "noch nicht gebootet",
        "being booted" => "beim Booten",
        "started" => "gestartet",
        "lost" => "verloren",
        "not known: read the object" => "nicht bekannt: lies das Objekt",
        now => {
            return now.replacen("failed", "aufgegeben", 1).replacen(
                "error status",
                "Fehlerstatus",
                1,
            );
        }
    };
    words.into()
}

/// Returns whether it holds, and its present state.
fn holds(
    one: &Alternative,
    note: &mut Note,
    bus: &mut Bus,
    device: usize,
    turns: Option<f64>,
    (began, disturbed): (Instant, Option<Instant>),
) -> (bool, Now) {
    let now = bus.now();
    note.looked = true;
    let fact = match &one.what {
        What::Seen(_) if one.not => return (true, Now::Nothing),
        What::Seen(Seen { times, .. }) | What::Disturbed(times) => {
            let state = match (note.count, *times) {
                (0, _) | (_, 1) => Now::Nothing,
                (count, times) => Now::Count(count, times),
            };
            return (note.done.is_some(), state);
        }
        What::Quiet(_) | What::Undisturbed => {
            let last = match one.what {
                What::Undisturbed => disturbed,
                _ => note.last,
            };
            let since = last.map_or(began, |last| last.max(began));
            let quiet = now.micros_since(since) >= one.lasting;
            return (quiet != one.not, Now::Nothing);
        }
        What::Fact(fact) => fact,
    };
    let is_powered = |device: &VirtualDevice| device.is_powered();
    let without_power = !bus.devices().get(device).is_none_or(is_powered);
    let (is, state) = match fact.look(bus, device, turns) {
        Ok(_) if without_power && matches!(fact, Fact::Value(..)) => (one.not, Now::WithoutPower),
        Ok(found) => (found.holds != one.not, Now::Is(found.now)),
        Err(why) => (false, Now::Other(why)),
    };
    note.held |= is;
    note.already &= is;
    if !is {
        note.since = None;
        return (false, state);
    }
    let since = *note.since.get_or_insert(now);
    (now.micros_since(since) >= one.lasting, state)
}

#[cfg(test)]
mod tests;
