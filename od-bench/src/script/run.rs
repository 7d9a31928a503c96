//! From statements to frames.

use std::collections::VecDeque;
use std::format;
use std::prelude::v1::*;

use od_runtime::{Frame, Instant, NodeId};
use od_wire::nmt;

use super::statement::{Action, Power, Shaft, Statement, When, Wire};
use super::{Bench, Host, Origin, Pattern, Reason, Script, Stop, Summary};
use crate::bus::{Bus, Sent};
use crate::device::VirtualDevice;
use od_model::values;

/// What stops a line.
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

/// What a `device` line asks for.
#[derive(Default)]
struct Wanted<'s> {
    name: Option<&'s str>,
    nodes: &'s [NodeId],
    label: Option<&'s str>,
    beside: Option<&'s str>,
    serial: Option<u32>,
}

/// The bench while a script runs.
pub(super) struct Runner<'h> {
    host: &'h mut dyn Host,
    pub(super) bus: Bus,
    labels: Vec<Option<String>>,
    current: usize,
    /// Frames that the devices sent and no line has expected yet.
    pub(super) pending: VecDeque<Sent>,
    ignored: Vec<Pattern>,
    /// Boot-up messages of `device` lines: a script may expect them and need not.
    greetings: Vec<Sent>,
    pub(super) held: usize,
    frames: u64,
}

/// Runs a script from its first line to its last, or to the first that does not hold.
///
/// # Errors
/// [`Stop`] says which line, and why.
pub fn run(script: &Script, host: &mut dyn Host) -> core::result::Result<Summary, Box<Stop>> {
    run_on(script, &mut Bench::default(), host)
}

/// As [`run`], on a bench that is there already and stays there afterwards.
///
/// # Errors
/// [`Stop`] says which line, and why; what the lines before it did stays done.
pub fn run_on(
    script: &Script,
    bench: &mut Bench,
    host: &mut dyn Host,
) -> core::result::Result<Summary, Box<Stop>> {
    let mut runner = Runner {
        host,
        bus: core::mem::take(&mut bench.bus),
        labels: core::mem::take(&mut bench.labels),
        current: bench.current,
        pending: VecDeque::new(),
        ignored: Vec::new(),
        greetings: Vec::new(),
        held: 0,
        frames: 0,
    };
    let result = runner.all(script);
    (bench.bus, bench.labels, bench.current) = (runner.bus, runner.labels, runner.current);
    result
}

/// The device with this label, or the `name.1` of a redundant one; else the one with this
/// number, counted from 1.
pub(super) fn named(labels: &[Option<String>], label: &str) -> Option<usize> {
    let find = |name: &str| {
        labels
            .iter()
            .position(|label| label.as_deref() == Some(name))
    };
    let number = || {
        let number: usize = label.parse().ok()?;
        (1..=labels.len()).contains(&number).then(|| number - 1)
    };
    find(label)
        .or_else(|| find(label.strip_suffix(".1")?))
        .or_else(number)
}

impl Runner<'_> {
    fn all(&mut self, script: &Script) -> core::result::Result<Summary, Box<Stop>> {
        for statement in &script.statements {
            let result = self.statement(statement);
            self.host.look(&mut self.bus);
            if let Err(reason) = result {
                return Err(Box::new(Stop {
                    line: statement.line,
                    text: statement.text.clone(),
                    at: self.bus.now(),
                    reason,
                }));
            }
        }
        Ok(Summary {
            held: self.held,
            frames: self.frames,
            end: self.bus.now(),
        })
    }

    fn statement(&mut self, statement: &Statement) -> Result<()> {
        let now = self.bus.now();
        // The wire is there before the first device is.
        let names_device = matches!(
            statement.action,
            Action::Device { .. }
                | Action::Line(Wire::Real(_) | Wire::Terminators(_) | Wire::BitRate(_))
        );
        if self.bus.devices().is_empty() && !names_device {
            self.add(&Wanted::default(), true)?;
        }
        match statement.when {
            When::Next => {}
            When::At(at) if at < now => {
                return impossible(format!("it is {now:?} s already; time runs forward only"));
            }
            When::At(at) => self.advance(at),
            When::After(micros) => self.advance(now.plus_micros(micros)),
        }
        self.act(&statement.action)
    }

    fn act(&mut self, action: &Action) -> Result<()> {
        match action {
            Action::Device {
                name,
                nodes,
                label,
                beside,
                serial,
                powered,
            } => {
                let wanted = Wanted {
                    name: Some(name),
                    nodes,
                    label: label.as_deref(),
                    beside: beside.as_deref(),
                    serial: *serial,
                };
                self.add(&wanted, *powered)?;
            }
            Action::Use(label) => self.current = self.labelled(label)?,
            Action::Send {
                frame,
                times,
                every,
            } => {
                for turn in 0..*times {
                    if turn > 0 {
                        self.advance(self.bus.now().plus_micros(*every));
                    }
                    self.send(frame);
                }
            }
            Action::Shaft(shaft) => self.shaft(*shaft)?,
            Action::Power(power) => self.power(*power),
            Action::SwitchNode(number) => {
                self.with(|device, now| device.set_node_switch(*number, now))
            }
            Action::SwitchBitrate(number) => {
                self.with(|device, now| device.set_bitrate_switch(*number, now));
            }
            Action::Fault { name, on } => {
                if !self.with(|device, now| device.set_fault(name, *on, now)) {
                    let known = self.device().faults().join(", ");
                    return impossible(format!(
                        "this device has no fault `{name}`; there are {known}"
                    ));
                }
            }
            Action::Bus(event) => self.with(|device, now| device.handle_bus(*event, now)),
            Action::Line(wire) => wire.act(&mut self.bus.line, self.current),
            Action::BusRate(kbit) => self.bus.set_bit_rate(*kbit),
            Action::Wait => {}
            Action::Nmt { command, node } => {
                let node = node.unwrap_or_else(|| self.device().node_id().raw());
                let repr = nmt::Repr {
                    command: *command,
                    node,
                };
                self.send(&Frame::standard(0, &repr.emit()));
            }
            Action::Read { object, outcome } => self.read(object, outcome)?,
            Action::Write {
                object,
                value,
                type_name,
                outcome,
            } => {
                self.write(object, value, type_name.as_deref(), outcome)?;
            }
            Action::Ignore(pattern) => {
                self.pending.retain(|sent| !pattern.matches(&sent.frame));
                self.ignored.push(pattern.clone());
            }
            Action::IgnoreNothing => self.ignored.clear(),
            Action::Skip => self.pending.clear(),
            Action::Expect(expect) => self.expect(expect)?,
        }
        Ok(())
    }

    /// The device of a `device … as` line above; of a redundant one, `name.2` is the second
    /// channel.
    fn labelled(&self, label: &str) -> Result<usize> {
        match named(&self.labels, label) {
            Some(device) => Ok(device),
            None => impossible(format!("no `device … as {label}` line stands above")),
        }
    }

    /// Puts a device on the bus, all its channels.
    fn add(&mut self, wanted: &Wanted<'_>, powered: bool) -> Result<()> {
        let beside = match wanted.beside {
            Some(label) => Some(self.labelled(label)?),
            None => None,
        };
        let node = wanted.nodes.first().copied();
        let mut device = self.host.device(wanted.name, node).or_else(impossible)?;
        if let Some(serial) = wanted.serial {
            device = device.with_serial_number(serial);
        }
        let channels = device.channels();
        if wanted.nodes.len() > usize::from(channels) {
            return impossible(format!(
                "{} has {channels} node ID, not {}",
                device.title(),
                wanted.nodes.len()
            ));
        }
        let mut id = node.unwrap_or(NodeId::ONE);
        let first = match beside {
            Some(other) => self.bus.add_beside(device, other),
            None => self.bus.add(device),
        };
        self.labels.push(wanted.label.map(str::to_owned));
        for channel in 1..channels {
            let next = wanted.nodes.get(usize::from(channel)).copied();
            // The next free number, where the line gives none.
            id = next.or(NodeId::new(id.raw() + 1)).unwrap_or(NodeId::ONE);
            let device = self
                .host
                .device(wanted.name, Some(id))
                .or_else(impossible)?;
            let serial_number = wanted.serial.unwrap_or(1).wrapping_add(u32::from(channel));
            self.bus
                .add_beside(device.with_serial_number(serial_number), first);
            let label = wanted.label.map(|label| format!("{label}.{}", channel + 1));
            self.labels.push(label);
        }
        self.current = first;
        if powered {
            let before = self.pending.len();
            self.power(Power::On);
            self.greetings.extend(self.pending.iter().skip(before));
        }
        Ok(())
    }

    /// Takes greetings off the queue that are not what is wanted.
    pub(super) fn pass_greetings(&mut self, wanted: impl Fn(&Frame) -> bool) {
        while let Some(sent) = self.pending.front()
            && self.greetings.contains(sent)
            && !wanted(&sent.frame)
        {
            self.pending.pop_front();
        }
    }

    /// The device that lines of the world outside are about.
    pub(super) fn device(&self) -> &VirtualDevice {
        // `statement` adds a device before anything asks for one.
        &self.bus.devices()[self.current]
    }

    fn with<R>(&mut self, act: impl FnOnce(&mut VirtualDevice, Instant) -> R) -> R {
        // As above: there is a current device.
        let result = self
            .bus
            .with(self.current, act)
            .expect("a device was added first");
        self.collect();
        result
    }

    /// Puts a frame on the bus.
    pub(super) fn send(&mut self, frame: &Frame) {
        let at = self.bus.now();
        // The answers wait in the bus until `collect`, so the frame is seen before them.
        if self.bus.receive(frame) {
            self.host.frame(at, Origin::Script, frame);
            self.host.look(&mut self.bus);
        }
        self.collect();
    }

    /// Lets time pass.
    pub(super) fn advance(&mut self, to: Instant) {
        while self.bus.advance_until_sent(to) {
            self.collect();
        }
    }

    /// Lets time pass until a frame comes that is not ignored, or until `to`.
    pub(super) fn advance_until_pending(&mut self, to: Instant) {
        while self.pending.is_empty() && self.bus.advance_until_sent(to) {
            self.collect();
        }
    }

    fn collect(&mut self) {
        while let Some(sent) = self.bus.poll() {
            self.frames += 1;
            self.host
                .frame(sent.at, Origin::Device(sent.device), &sent.frame);
            self.host.look(&mut self.bus);
            if !self
                .ignored
                .iter()
                .any(|pattern| pattern.matches(&sent.frame))
            {
                self.pending.push_back(sent);
            }
        }
    }

    fn shaft(&mut self, shaft: Shaft) -> Result<()> {
        if self.with(|device, now| shaft.act(device, now)) {
            Ok(())
        } else {
            impossible("this device has no shaft")
        }
    }

    fn power(&mut self, power: Power) {
        match power {
            Power::On => self.supply(true),
            Power::Off => self.supply(false),
            Power::Cycle(micros) => {
                self.supply(false);
                self.advance(self.bus.now().plus_micros(micros));
                self.supply(true);
            }
        }
    }

    fn supply(&mut self, on: bool) {
        self.bus.set_power(self.current, on);
        self.collect();
    }

    /// A value as the current device has it now, in words and bytes.
    pub(super) fn value(&mut self, object: &str) -> Result<(od_model::DataType, Vec<u8>)> {
        let found = values::find(self.device().dictionary(), object);
        let (address, data_type) = match found {
            Ok(entry) => (entry.address, entry.data_type),
            Err(why) => return impossible(why),
        };
        Ok((
            data_type,
            self.with(|device, now| device.read(address, now)),
        ))
    }
}
