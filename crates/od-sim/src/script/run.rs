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
use crate::bus::{Sent, UNTIL_QUIET};
use crate::chance::Chance;
use crate::device::VirtualDevice;
use crate::grammar::action::{Action, Draw, NewDevice, When};
use crate::grammar::deed::{Deed, LineChange};
use crate::grammar::draw::drawn;
use crate::grammar::line::line;
use crate::grammar::pattern::Pattern;
use crate::grammar::tokens::Tokens;
use crate::words::plural;

/// Longest time in which a frame of a script is sent, in microseconds: on a line that is always full it never gets its turn.
const SENDING: u64 = 10_000_000;
/// Time after which a run without frames asks whether it has to end, in microseconds.
const STEP: u64 = 10_000_000;

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

/// Progress of a script. The next line depends only on it and on the bench.
#[derive(Clone)]
pub(super) struct Progress {
    /// Frames of the devices that no line has expected yet.
    pub(super) pending: VecDeque<Sent>,
    ignored: Vec<Pattern>,
    /// Boot-up messages of `device` lines, which a script need not expect.
    boot_ups: Vec<Sent>,
    pub(super) held: usize,
    frames: u64,
    /// Frames of the master and, on a real line, of the script.
    own: u64,
    chance: Chance,
    /// The drawn lines, each with the number of its `random` line.
    pub(super) drawn: Vec<(u32, String)>,
}

impl Progress {
    /// The start of a script, with the draws of a seed.
    pub(super) fn new(seed: u64) -> Self {
        Self {
            pending: VecDeque::new(),
            ignored: Vec::new(),
            boot_ups: Vec::new(),
            held: 0,
            frames: 0,
            own: 0,
            chance: Chance::of_seed(seed),
            drawn: Vec::new(),
        }
    }

    /// The same progress with the draws of another seed.
    pub(super) fn with_seed(&self, seed: u64) -> Self {
        Self {
            chance: Chance::of_seed(seed),
            ..self.clone()
        }
    }

    pub(super) fn summary(&self, end: Instant) -> Summary {
        Summary {
            held: self.held,
            frames: self.frames,
            end,
        }
    }
}

/// The bench while a script runs.
pub(super) struct Runner<'r> {
    host: &'r mut dyn Host,
    pub(super) bench: &'r mut Bench,
    pub(super) progress: &'r mut Progress,
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
    if let Some(limits) = host.limits() {
        limits.check(script, bench.bus.devices().len(), bench.bus.now())?;
    }
    let mut progress = Progress::new(host.seed());
    play(&script.statements, bench, host, &mut progress)?;
    Ok(progress.summary(bench.bus.now()))
}

/// Runs lines of a script after those that made this progress.
///
/// # Errors
/// As [`run_on`].
pub(super) fn play(
    statements: &[Statement],
    bench: &mut Bench,
    host: &mut dyn Host,
    progress: &mut Progress,
) -> core::result::Result<(), Box<Stop>> {
    let limits = host.limits();
    let mut runner = Runner {
        host,
        bench,
        progress,
        limits,
    };
    for statement in statements {
        if let Err(reason) = runner.carry_out(statement) {
            let drawn = runner.progress.drawn.last();
            let drawn = drawn.filter(|(line, _)| *line == statement.line);
            return Err(Box::new(Stop {
                line: statement.line,
                text: drawn.map_or(&statement.text, |(_, text)| text).clone(),
                at: runner.now(),
                reason,
            }));
        }
    }
    Ok(())
}

impl Runner<'_> {
    /// Carries out a line. Then checks the limits of the script, and shows the bench to the host.
    fn carry_out(&mut self, statement: &Statement) -> Result<()> {
        let mut result = self.statement(statement);
        if let Some(limits) = self.limits
            && self.progress.frames.max(self.progress.own) > limits.frames
        {
            result = impossible(limits.flood());
        } else if self.host.stops() {
            result = impossible("the run was interrupted");
        }
        if self.host.waits_for_responses() {
            self.wait_for_responses();
        }
        self.host.look(&mut self.bench.bus);
        result
    }

    fn statement(&mut self, statement: &Statement) -> Result<()> {
        let now = self.now();
        // The bus line exists before the first device.
        let is_before_devices = match &statement.action {
            Action::Device(_) => true,
            Action::Deed(Deed::Line(change)) => !matches!(change, LineChange::Plugged(_)),
            _ => false,
        };
        if self.bench.bus.devices().is_empty() && !is_before_devices {
            self.add(&NewDevice::default())?;
        }
        match statement.when {
            When::Next => {}
            When::At(at) if at < now => {
                return impossible(format!("this moment is in the past (now {now:?} s)"));
            }
            When::At(at) => self.advance(at),
            When::After(micros) => self.advance(now.plus_micros(micros)),
        }
        if statement.action.acts() {
            self.host.act();
        }
        match &statement.action {
            Action::Deed(deed) => self.act(deed),
            Action::Device(added) => self.add(added),
            Action::Read { object, outcome } => self.read(object, outcome),
            Action::Write { write, outcome } => self.write(write, outcome),
            Action::Ignore(Some(pattern)) => {
                self.progress
                    .pending
                    .retain(|sent| !pattern.matches(&sent.frame));
                self.progress.ignored.push(pattern.clone());
                Ok(())
            }
            Action::Ignore(None) => {
                self.progress.ignored.clear();
                Ok(())
            }
            Action::Skip => {
                self.progress.pending.clear();
                Ok(())
            }
            Action::Expect(expect) => self.expect(expect),
            Action::Random(draw) => self.draw(statement.line, draw),
        }
    }

    /// Draws lines, and carries them out.
    fn draw(&mut self, number: u32, draw: &Draw) -> Result<()> {
        for _ in 0..draw.times {
            let last = draw.choices.len().saturating_sub(1);
            let chosen = self.progress.chance.up_to(last as u64) as usize;
            let mut faults = Vec::new();
            if let Ok(device) = self.bench.present() {
                let names = device.faults().into_iter();
                faults.extend(names.map(|name| (name, device.is_broken(name))));
            }
            let chance = &mut self.progress.chance;
            let choice = &draw.choices[chosen].text;
            let text =
                drawn(choice, &faults, &mut |last| chance.up_to(last)).or_else(impossible)?;
            self.progress.drawn.push((number, text.clone()));
            let (when, action) = line(Tokens::new(number, &text), &mut None)
                .or_else(|problem| impossible(problem.to_string()))?;
            self.carry_out(&Statement {
                line: number,
                text,
                when,
                action,
            })?;
        }
        Ok(())
    }

    fn act(&mut self, deed: &Deed) -> Result<()> {
        let mut deed = deed.clone();
        loop {
            match deed.act(self.bench).or_else(impossible)? {
                Some(frame) => self.send(&frame),
                None => self.collect(),
            }
            let Some((micros, rest)) = deed.rest() else {
                return Ok(());
            };
            self.advance(self.now().plus_micros(micros));
            if self.must_end() {
                return Ok(());
            }
            deed = rest;
        }
    }

    /// Puts a device with all its channels on the bus.
    fn add(&mut self, wanted: &NewDevice) -> Result<()> {
        let beside = match &wanted.beside {
            Some(label) => Some(self.bench.named(label).or_else(impossible)?),
            None => None,
        };
        let mut id = wanted.nodes.first().copied();
        let mut first = None;
        let (mut channel, mut channels) = (0, 1);
        while channel < channels {
            let device = self.channel(wanted, id, channel)?;
            channels = device.channels();
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
            let before = self.progress.pending.len();
            self.bench.bus.start(self.bench.current);
            self.collect();
            // On a line that takes time, the boot-up message is still being sent.
            for station in first.unwrap_or_default() + 1..=self.bench.bus.devices().len() {
                self.send_out(station);
            }
            self.progress
                .boot_ups
                .extend(self.progress.pending.iter().skip(before));
        }
        Ok(())
    }

    /// Makes a channel of a device, counted from 0.
    fn channel(
        &mut self,
        wanted: &NewDevice,
        id: Option<NodeId>,
        channel: u8,
    ) -> Result<VirtualDevice> {
        let name = wanted.name.as_deref();
        let mut device = self.host.device(name, id).or_else(impossible)?;
        let channels = device.channels();
        if wanted.nodes.len() > usize::from(channels) {
            return impossible(format!(
                "{} has {}, not {}",
                device.title(),
                plural(channels.into(), "node ID"),
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
        Ok(device)
    }

    /// Removes boot-up messages from the queue that do not match, and returns the last of them.
    pub(super) fn skip_boot_ups(&mut self, wanted: impl Fn(&Frame) -> bool) -> Option<Sent> {
        let mut last = None;
        while let Some(sent) = self.progress.pending.front()
            && self.progress.boot_ups.contains(sent)
            && !wanted(&sent.frame)
        {
            last = self.progress.pending.pop_front();
        }
        last
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
    /// without end, or after [`SENDING`]. Station 0 is the script.
    fn send_out(&mut self, station: usize) {
        let end = self.now().plus_micros(SENDING);
        while self.bench.bus.is_sending(station)
            && !self.bench.bus.is_stuck(station)
            && !self.must_end()
            && self.now() < end
            && self.bench.bus.advance_until_event()
        {
            self.collect();
        }
    }

    /// Lets time pass until the frames on a real line are through, with their responses; not longer than
    /// [`UNTIL_QUIET`], because a full line always has a frame.
    fn wait_for_responses(&mut self) {
        let bus = &mut self.bench.bus;
        let end = bus.now().plus_micros(UNTIL_QUIET);
        while self.bench.bus.is_busy()
            && !self.must_end()
            && let Some(at) = self.bench.bus.next_deadline().filter(|at| *at <= end)
        {
            self.bench.bus.advance_until_sent(at);
            self.collect();
        }
    }

    /// Lets time pass.
    pub(super) fn advance(&mut self, to: Instant) {
        while !self.must_end() && self.advance_until_sent(to) {
            self.collect();
        }
    }

    /// Lets time pass until a frame comes that is not ignored, or until `to`.
    pub(super) fn advance_until_pending(&mut self, to: Instant) {
        while self.progress.pending.is_empty() && !self.must_end() && self.advance_until_sent(to) {
            self.collect();
        }
    }

    /// Lets time pass to the next frame, or to `to`; returns whether it is a frame.
    fn advance_until_sent(&mut self, to: Instant) -> bool {
        loop {
            let next = to.min(self.now().plus_micros(STEP));
            if self.bench.bus.advance_until_sent(next) {
                return true;
            }
            if next == to || self.must_end() {
                return false;
            }
        }
    }

    /// Returns whether there were more frames than the limit of the script, or the host ends the run.
    pub(super) fn must_end(&mut self) -> bool {
        let frames = self.progress.frames.max(self.progress.own);
        self.limits.is_some_and(|limits| frames > limits.frames) || self.host.stops()
    }

    pub(super) fn collect(&mut self) {
        while let Some(sent) = self.bench.bus.poll() {
            let origin = Origin::of(sent.device);
            self.host.frame(sent.at, origin, &sent.frame);
            self.host.look(&mut self.bench.bus);
            if sent.device.is_none() {
                self.progress.own += 1;
                continue;
            }
            self.progress.frames += 1;
            let mut ignored = self.progress.ignored.iter();
            if !ignored.any(|pattern| pattern.matches(&sent.frame)) {
                self.progress.pending.push_back(sent);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::script::{Bare, Limited};

    const AMPLE: Limits = Limits {
        micros: u64::MAX,
        devices: 16,
        frames: u64::MAX,
    };

    /// A host that ends the run when it is asked for the last time.
    struct Ending(u32);

    impl Host for Ending {
        fn device(
            &mut self,
            name: Option<&str>,
            node_id: Option<NodeId>,
        ) -> core::result::Result<VirtualDevice, od_model::Refused> {
            Bare(od_devices::DEVICES).device(name, node_id)
        }

        fn stops(&mut self) -> bool {
            self.0 = self.0.saturating_sub(1);
            self.0 == 0
        }
    }

    /// The stack does not grow with the number of frames.
    #[test]
    fn a_line_that_repeats_runs_on_a_small_stack() {
        let run_all = || {
            for line in ["sync 60000 times", "send 601#40 60000 times every 1us"] {
                let script = Script::parse(line).expect("a line");
                assert_eq!(
                    run(&script, &mut Bare(od_devices::DEVICES)).map(drop),
                    Ok(())
                );
            }
        };
        let thread = std::thread::Builder::new()
            .stack_size(256 * 1024)
            .spawn(run_all);
        let ended = thread.expect("a thread").join();
        assert!(ended.is_ok());
    }

    #[test]
    fn a_host_ends_a_run_in_any_line() {
        for line in [
            "wait 3153600000s",
            "nmt start\nwait 3153600000s",
            "sync 1000000 times every 3153s",
            "expect silence 3153600000s",
            "expect 123# within 3153600000s",
            "random 10000 times wait 3153600000s",
        ] {
            let script = Script::parse(line).expect("a line");
            let mut ending = Ending(1000);
            let mut wrapped = Limited(&mut ending, AMPLE);
            for host in [&mut Ending(1000) as &mut dyn Host, &mut wrapped] {
                let stop = run(&script, host).expect_err("it ends");
                let reason = Reason::Impossible("the run was interrupted".into());
                assert_eq!(stop.reason, reason, "{line}");
            }
        }
    }
}
