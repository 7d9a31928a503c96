//! Runs the statements of a script.

use std::collections::VecDeque;
use std::format;
use std::prelude::v1::*;

use od_runtime::{Frame, Instant, NodeId};

use super::host::{Host, Origin};
use super::limits::Limits;
use super::outcome::{Reason, Stop, Summary};
use super::read::{Script, Statement};
use crate::bench::Bench;
use crate::bus::Sent;
use crate::device::VirtualDevice;
use crate::grammar::action::{Action, Added, When};
use crate::grammar::deed::{Deed, Wire};
use crate::grammar::pattern::Pattern;

/// Longest wait for a frame on a line that takes time, in microseconds, where a script names no time.
pub(super) const ON_ITS_WAY: u64 = 100_000;

/// Result of a line; an error stops the script.
pub(super) type Result<T> = core::result::Result<T, Reason>;

pub(super) fn impossible<T>(why: impl Into<String>) -> Result<T> {
    Err(Reason::Impossible(why.into()))
}

pub(super) fn failed<T>(expected: impl Into<String>, got: impl Into<String>) -> Result<T> {
    Err(Reason::Failed {
        expected: expected.into(),
        got: got.into(),
    })
}

/// The bench while a script runs.
pub(super) struct Runner<'r> {
    host: &'r mut dyn Host,
    pub(super) bench: &'r mut Bench,
    /// Frames of the devices that no line has expected yet.
    pub(super) pending: VecDeque<Sent>,
    ignored: Vec<Pattern>,
    /// Boot-up messages of `device` lines, which a script need not expect.
    greetings: Vec<Sent>,
    pub(super) held: usize,
    frames: u64,
    limits: Option<Limits>,
}

/// Runs a script up to its end or its first failed line.
///
/// # Errors
/// [`Stop`] names the line and the reason.
pub fn run(script: &Script, host: &mut dyn Host) -> core::result::Result<Summary, Box<Stop>> {
    run_on(script, &mut Bench::default(), host)
}

/// Like [`run`], on an existing bench, which stays afterwards.
///
/// # Errors
/// [`Stop`] names the line and the reason; the effects of earlier lines stay.
pub fn run_on(
    script: &Script,
    bench: &mut Bench,
    host: &mut dyn Host,
) -> core::result::Result<Summary, Box<Stop>> {
    let limits = host.limits();
    if let Some(limits) = limits {
        limits.check(script, bench.bus.devices().len(), bench.bus.now())?;
    }
    let mut runner = Runner {
        host,
        bench,
        pending: VecDeque::new(),
        ignored: Vec::new(),
        greetings: Vec::new(),
        held: 0,
        frames: 0,
        limits,
    };
    for statement in &script.statements {
        let result = match (runner.statement(statement), runner.limits) {
            (_, Some(limits)) if runner.is_flooded() => impossible(limits.flood()),
            (result, _) => result,
        };
        if runner.host.waits_for_responses() {
            runner.settle();
        }
        runner.host.look(&mut runner.bench.bus);
        if let Err(reason) = result {
            return Err(Box::new(Stop {
                line: statement.line,
                text: statement.text.clone(),
                at: runner.now(),
                reason,
            }));
        }
    }
    Ok(Summary {
        held: runner.held,
        frames: runner.frames,
        end: runner.now(),
    })
}

impl Runner<'_> {
    fn statement(&mut self, statement: &Statement) -> Result<()> {
        let now = self.now();
        // The bus line exists before the first device.
        let is_before_devices = match &statement.action {
            Action::Device(_) => true,
            Action::Deed(Deed::Line(wire)) => !matches!(wire, Wire::Plugged(_)),
            _ => false,
        };
        if self.bench.bus.devices().is_empty() && !is_before_devices {
            self.add(&Added::default())?;
        }
        match statement.when {
            When::Next => {}
            When::At(at) if at < now => {
                return impossible(format!("this moment is in the past (now {now:?} s)"));
            }
            When::At(at) => self.advance(at),
            When::After(micros) => self.advance(now.plus_micros(micros)),
        }
        match &statement.action {
            Action::Deed(deed) => self.act(deed),
            Action::Device(added) => self.add(added),
            Action::Read { object, outcome } => self.read(object, outcome),
            Action::Write { write, outcome } => self.write(write, outcome),
            Action::Ignore(Some(pattern)) => {
                self.pending.retain(|sent| !pattern.matches(&sent.frame));
                self.ignored.push(pattern.clone());
                Ok(())
            }
            Action::Ignore(None) => {
                self.ignored.clear();
                Ok(())
            }
            Action::Skip => {
                self.pending.clear();
                Ok(())
            }
            Action::Expect(expect) => self.expect(expect),
        }
    }

    fn act(&mut self, deed: &Deed) -> Result<()> {
        match deed.act(self.bench).or_else(impossible)? {
            Some(frame) => self.send(&frame),
            None => self.collect(),
        }
        match deed.rest() {
            Some((micros, rest)) => {
                self.advance(self.now().plus_micros(micros));
                self.act(&rest)
            }
            None => Ok(()),
        }
    }

    /// Puts a device with all its channels on the bus.
    fn add(&mut self, wanted: &Added) -> Result<()> {
        let beside = match &wanted.beside {
            Some(label) => Some(self.bench.named(label).or_else(impossible)?),
            None => None,
        };
        let mut id = wanted.nodes.first().copied();
        let mut first = None;
        let (mut channel, mut channels) = (0, 1);
        while channel < channels {
            let mut device = self
                .host
                .device(wanted.name.as_deref(), id)
                .or_else(impossible)?;
            channels = device.channels();
            if wanted.nodes.len() > usize::from(channels) {
                return impossible(format!(
                    "{} has {channels} node ID, not {}",
                    device.title(),
                    wanted.nodes.len()
                ));
            }
            if wanted.serial.is_some() || channel > 0 {
                let serial = wanted.serial.unwrap_or(1);
                device = device.with_serial_number(serial.wrapping_add(u32::from(channel)));
            }
            if let Some(bytes) = wanted.domain_size
                && !device.set_domain_size(bytes)
            {
                return impossible(format!(
                    "`domain-size` is for devices of EDS files; {} is built in",
                    device.title()
                ));
            }
            if let Some(limits) = self.limits
                && self.bench.bus.devices().len() >= limits.devices
            {
                return impossible(limits.room());
            }
            let number = match first.or(beside) {
                Some(other) => self.bench.bus.add_beside(device, other),
                None => self.bench.bus.add(device),
            };
            first.get_or_insert(number);
            let label = wanted.label.as_ref();
            self.bench.labels.push(label.map(|label| match channel {
                0 => label.clone(),
                channel => format!("{label}.{}", channel + 1),
            }));
            channel += 1;
            // Use the next free number if the line names none.
            let next = wanted.nodes.get(usize::from(channel)).copied();
            let raw = id.unwrap_or(NodeId::ONE).raw();
            id = next.or(NodeId::new(raw + 1)).or(Some(NodeId::ONE));
        }
        self.bench.current = first.unwrap_or_default();
        if !wanted.off {
            let before = self.pending.len();
            self.bench.bus.start(self.bench.current);
            self.collect();
            // On a line that takes time, the boot-up message is still being sent.
            for station in first.unwrap_or_default() + 1..=self.bench.bus.devices().len() {
                self.send_out(station);
            }
            self.greetings.extend(self.pending.iter().skip(before));
        }
        Ok(())
    }

    /// Removes boot-up messages from the queue that do not match.
    pub(super) fn pass_greetings(&mut self, wanted: impl Fn(&Frame) -> bool) {
        while let Some(sent) = self.pending.front()
            && self.greetings.contains(sent)
            && !wanted(&sent.frame)
        {
            self.pending.pop_front();
        }
    }

    /// The device of the current lines.
    pub(super) fn device(&self) -> Result<&VirtualDevice> {
        self.bench.present().or_else(impossible)
    }

    pub(super) fn now(&self) -> Instant {
        self.bench.bus.now()
    }

    /// Puts a frame on the bus.
    pub(super) fn send(&mut self, frame: &Frame) {
        let at = self.now();
        // Answers wait in the bus until `collect`, so the frame is reported before them.
        if self.bench.bus.receive(frame) {
            self.host.frame(at, Origin::Script, frame);
            self.host.look(&mut self.bench.bus);
        }
        self.collect();
        self.send_out(0);
    }

    /// On a line that takes time, a script line is done when its frame was sent or lost, or repeats
    /// without end. Station 0 is the script.
    fn send_out(&mut self, station: usize) {
        while self.bench.bus.is_sending(station)
            && !self.bench.bus.is_stuck(station)
            && self.bench.bus.advance_until_event()
        {
            self.collect();
        }
    }

    /// Lets time pass until the frames on a real line are through, with their responses; not longer than
    /// [`ON_ITS_WAY`], because a full line always has a frame.
    fn settle(&mut self) {
        let bus = &mut self.bench.bus;
        let end = bus.now().plus_micros(ON_ITS_WAY);
        while self.bench.bus.is_busy()
            && !self.is_flooded()
            && let Some(at) = self.bench.bus.next_deadline().filter(|at| *at <= end)
        {
            self.bench.bus.advance_until_sent(at);
            self.collect();
        }
    }

    /// Lets time pass.
    pub(super) fn advance(&mut self, to: Instant) {
        while !self.is_flooded() && self.bench.bus.advance_until_sent(to) {
            self.collect();
        }
    }

    /// Returns whether there were more frames than the limit of the script.
    fn is_flooded(&self) -> bool {
        self.limits
            .is_some_and(|limits| self.frames > limits.frames)
    }

    /// Lets time pass until a frame comes that is not ignored, or until `to`.
    pub(super) fn advance_until_pending(&mut self, to: Instant) {
        while self.pending.is_empty() && !self.is_flooded() && self.bench.bus.advance_until_sent(to)
        {
            self.collect();
        }
    }

    pub(super) fn collect(&mut self) {
        while let Some(sent) = self.bench.bus.poll() {
            let origin = Origin::of(sent.device);
            self.host.frame(sent.at, origin, &sent.frame);
            self.host.look(&mut self.bench.bus);
            if sent.device.is_none() {
                continue;
            }
            self.frames += 1;
            let mut ignored = self.ignored.iter();
            if !ignored.any(|pattern| pattern.matches(&sent.frame)) {
                self.pending.push_back(sent);
            }
        }
    }
}
