//! A slave with faults: a bench whose frames are changed on their way to the test.
//!
//! A rule is `[in STATE] [since <PATTERN>] [until <PATTERN>] from PATTERN: [once|after N] DEED`,
//! the same with `to`, or `[in STATE] [since …] [until …] every MILLIS FRAME`. In a pattern `.` is
//! any digit, `+` any but 0, and `*` any further text. A frame of either side that matches `since` or `until`
//! begins or ends the time of the rule.

use std::collections::VecDeque;

use od_sim::bus::Bus;
use od_sim::logs::candump::parse_frame;
use od_tools::Error;
use od_tools::bench::OnBench;
use od_tools::conform::rig::Rig;
use od_tools::link::{Heard, Link};
use od_wire::{CanId, Frame, Instant};

#[derive(Clone, Debug)]
enum Deed {
    Drop,
    Twice,
    Late(u64),
    Set(Vec<(usize, u8)>),
    Xor(Vec<(usize, u8)>),
    Cut(usize),
    Id(u16),
    Abort(u32),
    /// For an abort: the confirmation of the download.
    Accept,
    Becomes(Frame),
    /// Responds instead of the device.
    Reply(Frame),
    Also(Frame),
    Before(Frame),
    /// The device is silent from now on.
    Hang,
    /// For an RPDO: writes its bytes by SDO.
    Write,
    /// For an expedited download: confirms it and returns it in uploads, but without an effect.
    Shadow,
}

#[derive(Clone, Debug)]
enum Way {
    From(String),
    To(String),
    Every(u64, Frame),
}

#[derive(Clone, Debug)]
struct Rule {
    state: Option<u8>,
    since: Option<String>,
    until: Option<String>,
    is_active: bool,
    way: Way,
    skip: usize,
    once: bool,
    deed: Deed,
    seen: usize,
    due: Instant,
}

/// A bench with rules.
pub(crate) struct Spoiled {
    bench: OnBench<Bus>,
    rules: Vec<Rule>,
    out: VecDeque<Heard>,
    hangs: bool,
    /// Objects whose writes have no effect: index and sub-index as in a request, command and bytes of an upload.
    shadows: Vec<([u8; 3], [u8; 5])>,
}

fn frame(text: &str) -> Frame {
    parse_frame(text).unwrap_or_else(|_| panic!("a frame: {text}"))
}

fn bytes(text: &str) -> Vec<(usize, u8)> {
    let pair = |word: &str| {
        let (at, byte) = word.split_once('=').expect("at=byte");
        let byte = u8::from_str_radix(byte, 16).expect("a byte");
        (at.parse().expect("a place"), byte)
    };
    text.split_whitespace().map(pair).collect()
}

fn deed(text: &str) -> Deed {
    let (word, rest) = text.split_once(' ').unwrap_or((text, ""));
    match word {
        "drop" => Deed::Drop,
        "twice" => Deed::Twice,
        "late" => Deed::Late(rest.parse().expect("milliseconds")),
        "set" => Deed::Set(bytes(rest)),
        "xor" => Deed::Xor(bytes(rest)),
        "cut" => Deed::Cut(rest.parse().expect("a length")),
        "id" => Deed::Id(u16::from_str_radix(rest, 16).expect("a CAN-ID")),
        "abort" => Deed::Abort(u32::from_str_radix(rest, 16).expect("a code")),
        "accept" => Deed::Accept,
        "becomes" => Deed::Becomes(frame(rest)),
        "reply" => Deed::Reply(frame(rest)),
        "also" => Deed::Also(frame(rest)),
        "before" => Deed::Before(frame(rest)),
        "hang" => Deed::Hang,
        "write" => Deed::Write,
        "shadow" => Deed::Shadow,
        other => panic!("deed `{other}`"),
    }
}

fn rule(text: &str) -> Rule {
    let mut text = text.trim();
    let mut state = None;
    if let Some(rest) = text.strip_prefix("in ") {
        let (name, rest) = rest.split_once(' ').expect("a state");
        state = Some(match name {
            "stopped" => 4,
            "operational" => 5,
            _ => 0x7F,
        });
        text = rest;
    }
    let mut bound = |word: &str| {
        let rest = text.strip_prefix(word)?.strip_prefix(" <")?;
        let (pattern, rest) = rest.split_once("> ").expect("a pattern in < >");
        text = rest;
        Some(pattern.replace(' ', ""))
    };
    let since = bound("since");
    let until = bound("until");
    let mut made = Rule {
        state,
        is_active: since.is_none(),
        since,
        until,
        way: Way::From(String::new()),
        skip: 0,
        once: false,
        deed: Deed::Drop,
        seen: 0,
        due: Instant::ZERO,
    };
    if let Some(rest) = text.strip_prefix("every ") {
        let (millis, rest) = rest.split_once(' ').expect("a frame");
        made.way = Way::Every(millis.parse().expect("milliseconds"), frame(rest));
        return made;
    }
    let (pattern, mut rest) = text.split_once(": ").expect("a deed");
    if let Some(after) = rest.strip_prefix("after ") {
        let (count, deed) = after.split_once(' ').expect("a deed");
        made.skip = count.parse().expect("a number");
        rest = deed;
    }
    if let Some(deed) = rest.strip_prefix("once ") {
        made.once = true;
        rest = deed;
    }
    made.deed = deed(rest);
    made.way = match pattern.split_once(' ').expect("from or to") {
        ("from", pattern) => Way::From(pattern.replace(' ', "")),
        ("to", pattern) => Way::To(pattern.replace(' ', "")),
        other => panic!("{other:?}"),
    };
    made
}

/// Returns whether a frame matches the pattern; the length of a remote frame does not count.
fn fits(pattern: &str, frame: &Frame) -> bool {
    let text = frame.to_string();
    let text = if frame.is_remote() {
        text.split('R').next().unwrap_or("").to_owned() + "R"
    } else {
        text
    };
    let (pattern, open) = match pattern.strip_suffix('*') {
        Some(pattern) => (pattern, true),
        None => (pattern, false),
    };
    let long = text.len() == pattern.len() || (open && text.len() >= pattern.len());
    long && pattern
        .bytes()
        .zip(text.bytes())
        .all(|(p, c)| p == b'.' || p == c || (p == b'+' && c != b'0'))
}

fn with(frame: &Frame, change: impl FnOnce(&mut Vec<u8>)) -> Frame {
    let mut data = frame.data().to_vec();
    change(&mut data);
    Frame::new(frame.id(), &data).expect("a frame")
}

impl Spoiled {
    pub(crate) fn new(bus: Bus, rules: &str) -> Self {
        let rules = rules.split(" ; ").filter(|text| !text.starts_with("eds "));
        Self {
            bench: OnBench(bus),
            rules: rules.filter(|text| !text.is_empty()).map(rule).collect(),
            out: VecDeque::new(),
            hangs: false,
            shadows: Vec::new(),
        }
    }

    pub(crate) fn into_bus(self) -> Bus {
        self.bench.0
    }

    fn state(&self) -> u8 {
        self.bench.0.devices()[0].state() as u8
    }

    /// The action of the first rule for this frame.
    fn deed(&mut self, frame: &Frame, is_from: bool) -> Option<Deed> {
        let state = self.state();
        for rule in &mut self.rules {
            let is_bound =
                |bound: &Option<String>| bound.as_ref().is_some_and(|it| fits(it, frame));
            if is_bound(&rule.since) {
                rule.is_active = true;
            } else if is_bound(&rule.until) {
                rule.is_active = false;
            }
        }
        for rule in &mut self.rules {
            let pattern = match (&rule.way, is_from) {
                (Way::From(pattern), true) | (Way::To(pattern), false) => pattern,
                _ => continue,
            };
            let is_now = rule.is_active && rule.state.is_none_or(|wanted| wanted == state);
            if !is_now || !fits(pattern, frame) {
                continue;
            }
            rule.seen += 1;
            if rule.seen <= rule.skip || (rule.once && rule.seen > rule.skip + 1) {
                continue;
            }
            return Some(rule.deed.clone());
        }
        None
    }

    fn say(&mut self, frame: Frame, at: Instant) {
        self.out.push_back(Heard { at, frame });
    }

    /// The frame after an action that changes it.
    fn spoil(frame: &Frame, deed: &Deed) -> Frame {
        match deed {
            Deed::Set(all) => with(frame, |data| {
                for (at, byte) in all.iter().filter(|(at, _)| *at < frame.data().len()) {
                    data[*at] = *byte;
                }
            }),
            Deed::Xor(all) => with(frame, |data| {
                for (at, byte) in all.iter().filter(|(at, _)| *at < frame.data().len()) {
                    data[*at] ^= byte;
                }
            }),
            Deed::Cut(len) => with(frame, |data| data.truncate(*len)),
            Deed::Id(id) => Frame::new(CanId::standard(*id), frame.data()).expect("a frame"),
            Deed::Abort(code) => with(frame, |data| {
                data[0] = 0x80;
                data[4..].copy_from_slice(&code.to_le_bytes());
            }),
            Deed::Accept => with(frame, |data| {
                data[0] = 0x60;
                data[4..].fill(0);
            }),
            Deed::Becomes(other) => *other,
            _ => *frame,
        }
    }

    /// Passes on the frames of a device that the rules leave.
    fn hear(&mut self, heard: Heard) {
        let Heard { at, frame } = heard;
        if self.hangs {
            return;
        }
        let Some(deed) = self.deed(&frame, true) else {
            return self.say(frame, at);
        };
        match deed {
            Deed::Drop => {}
            Deed::Hang => self.hangs = true,
            Deed::Twice => {
                self.say(frame, at);
                self.say(frame, at);
            }
            Deed::Late(millis) => self.say(frame, at.plus_millis(millis)),
            Deed::Also(other) => {
                self.say(frame, at);
                self.say(other, at);
            }
            Deed::Before(other) => {
                self.say(other, at);
                self.say(frame, at);
            }
            deed => self.say(Self::spoil(&frame, &deed), at),
        }
    }

    /// Returns whether the value of an expedited download is beyond the limits of the object.
    fn is_beyond(&self, frame: &Frame) -> bool {
        let [command, low, high, sub, rest @ ..] = *frame.bytes();
        let device = &self.bench.0.devices()[0];
        let address = od_model::Address::new(u16::from_le_bytes([low, high]), sub);
        let Ok(entry) = device.dictionary().find(address) else {
            return false;
        };
        let len = 4 - usize::from(command >> 2 & 3);
        let mut bytes = [0; 4];
        bytes[..len].copy_from_slice(&rest[..len]);
        let value = i128::from(u32::from_le_bytes(bytes));
        let unused = 128 - 8 * len as u32;
        let is_signed = entry
            .data_type
            .integer_range()
            .is_some_and(|(least, _)| least < 0);
        let value = if is_signed {
            value << unused >> unused
        } else {
            value
        };
        let node = device.node_id().raw();
        let is_below = entry.low.integer(node).is_some_and(|low| value < low);
        is_below || entry.high.integer(node).is_some_and(|high| value > high)
    }

    /// Accepts an expedited download without an effect; returns its confirmation.
    fn shadow(&mut self, frame: &Frame) -> Frame {
        let [command, low, high, sub, rest @ ..] = *frame.bytes();
        let key = [low, high, sub];
        self.shadows.retain(|(known, _)| *known != key);
        let [a, b, c, d] = rest;
        let upload = command & 0x1F | 0x40;
        self.shadows.push((key, [upload, a, b, c, d]));
        let id = CanId::standard(frame.id().as_standard().unwrap_or(0) - 0x80);
        Frame::full(id, [0x60, low, high, sub, 0, 0, 0, 0])
    }

    /// The response to the upload of such an object.
    fn shadowed(&self, frame: &Frame) -> Option<Frame> {
        let [0x40, low, high, sub, ..] = *frame.bytes() else {
            return None;
        };
        let id = frame.id().as_standard().filter(|id| id & 0x780 == 0x600)?;
        let (_, upload) = self
            .shadows
            .iter()
            .find(|(key, _)| *key == [low, high, sub])?;
        let [command, a, b, c, d] = *upload;
        Some(Frame::full(
            CanId::standard(id - 0x80),
            [command, low, high, sub, a, b, c, d],
        ))
    }

    /// The next frame that a rule sends.
    fn due(&mut self, until: Instant) -> Option<Instant> {
        let (state, now) = (self.state(), self.bench.now());
        let mut next: Option<Instant> = None;
        for rule in &mut self.rules {
            if let Way::Every(millis, frame) = rule.way
                && rule.is_active
                && rule.state.is_none_or(|wanted| wanted == state)
            {
                if rule.due <= now {
                    if rule.due > Instant::ZERO {
                        self.out.push_back(Heard { at: now, frame });
                    }
                    rule.due = now.plus_millis(millis);
                }
                next = Some(next.map_or(rule.due, |next| next.min(rule.due)));
            }
        }
        next.filter(|next| *next <= until)
    }
}

impl Link for Spoiled {
    fn now(&self) -> Instant {
        self.bench.now()
    }

    fn send(&mut self, frame: &Frame) -> Result<(), Error> {
        let at = self.now();
        // After a reset the device has its own values.
        if matches!(frame.bytes()[0], 0x81 | 0x82) && frame.id() == CanId::standard(0) {
            self.shadows.clear();
        }
        if let Some(answer) = self.shadowed(frame) {
            self.say(answer, at);
            return Ok(());
        }
        match self.deed(frame, false) {
            None => self.bench.send(frame),
            Some(Deed::Drop) => Ok(()),
            Some(Deed::Hang) => {
                self.hangs = true;
                Ok(())
            }
            Some(Deed::Reply(answer)) => {
                self.say(answer, at);
                Ok(())
            }
            Some(Deed::Also(answer)) => {
                self.say(answer, at);
                self.bench.send(frame)
            }
            // The device itself refuses a value beyond its limits.
            Some(Deed::Shadow) if self.is_beyond(frame) => self.bench.send(frame),
            Some(Deed::Shadow) => {
                let answer = self.shadow(frame);
                self.say(answer, at);
                Ok(())
            }
            Some(Deed::Write) => {
                self.bench.0.with(0, |device, now| {
                    let address = od_model::Address::new(0x6200, 1);
                    device.set_value(address, &frame.data()[..1], now)
                });
                Ok(())
            }
            Some(deed) => self.bench.send(&Self::spoil(frame, &deed)),
        }
    }

    fn receive(&mut self, until: Instant) -> Result<Option<Heard>, Error> {
        loop {
            let soon = self.due(until);
            let now = self.now();
            let first = self.out.iter().position(|heard| heard.at <= now);
            if let Some(heard) = first.and_then(|at| self.out.remove(at)) {
                return Ok(Some(heard));
            }
            let later = self.out.iter().map(|heard| heard.at).min();
            let to = [soon, later.filter(|at| *at <= until)];
            let to = to.into_iter().flatten().min().unwrap_or(until);
            match self.bench.receive(to)? {
                Some(heard) => self.hear(heard),
                None if to == until || to <= now => return Ok(None),
                None => {}
            }
        }
    }
}

impl Rig for Spoiled {
    fn has_power(&self) -> bool {
        true
    }

    fn power(&mut self, on: bool) -> Result<(), Error> {
        self.bench.power(on)
    }
}
