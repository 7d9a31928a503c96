//! The language of scripts, spoken to a bench that runs already: frames, and the world
//! outside the bus. What is expected belongs to scripts alone.

use std::collections::VecDeque;
use std::format;
use std::prelude::v1::*;

use od_runtime::{Frame, Instant};
use od_wire::nmt;

use super::Problem;
use super::parse::statement;
use super::statement::{Action, Power, When};
use super::words::Words;
use crate::bus::Bus;
use crate::device::VirtualDevice;

/// Lines that wait for their moment; more are refused.
const MOST: usize = 100_000;

/// Takes lines and carries them out in order, each at its moment.
///
/// ```
/// use od_bench::script::Console;
/// use od_bench::{Bus, VirtualDevice};
/// use od_runtime::NodeId;
///
/// let mut bus = Bus::new();
/// bus.add(VirtualDevice::new(od_devices::find("gxmm").unwrap(), NodeId::ONE));
/// let mut console = Console::default();
/// console.push("power on").unwrap();
/// while let Some(done) = console.step(&mut bus) {
///     done.unwrap();
/// }
/// assert!(bus.devices()[0].is_powered());
/// ```
#[derive(Debug, Default)]
pub struct Console {
    /// Where the time stamps of a log begin.
    origin: Option<u64>,
    line: u32,
    lines: VecDeque<(When, Action)>,
    /// Device that lines are about.
    current: usize,
    /// When the line before was done.
    done: Option<Instant>,
    /// When it was first asked for something to do: stamps and `at` count from it.
    start: Option<Instant>,
    /// The rest of a line that takes time.
    rest: VecDeque<(Instant, Action)>,
}

impl Console {
    /// A line that was read; empty lines and comments mean nothing.
    ///
    /// # Errors
    /// What is wrong with it and what may stand there instead; nothing of it is done then.
    pub fn push(&mut self, text: &str) -> Result<(), Problem> {
        self.line = self.line.saturating_add(1);
        let words = Words::new(self.line, text.trim_start_matches('\u{feff}'));
        if words.is_empty() {
            return Ok(());
        }
        let start = words;
        let (when, action) = statement(words, &mut self.origin)?;
        let only =
            "frames, nmt, sync, power, shaft, switch, fault, bus, line, use and wait stand here";
        if !is_for_a_live_bench(&action) {
            return Err(start.problem("only a script can do that", only));
        }
        if self.lines.len() >= MOST {
            return Err(start.problem("too many lines wait for their moment", "send fewer at once"));
        }
        self.lines.push_back((when, action));
        Ok(())
    }

    /// Has everything been carried out?
    pub fn is_idle(&self) -> bool {
        self.lines.is_empty() && self.rest.is_empty()
    }

    /// When [`step`](Self::step) is due, seen from `now`.
    pub fn deadline(&self, now: Instant) -> Option<Instant> {
        if let Some((at, _)) = self.rest.front() {
            return Some(*at);
        }
        let (when, _) = self.lines.front()?;
        Some(self.moment(*when, now))
    }

    fn moment(&self, when: When, now: Instant) -> Instant {
        let since = |start: Option<Instant>, micros| start.unwrap_or(now).plus_micros(micros);
        match when {
            When::Next => now,
            When::At(at) => since(self.start, at.as_micros()),
            When::After(micros) => since(self.done, micros),
        }
    }

    /// Carries out the next line that is due: `None` where none is. A frame that the line
    /// sends is handed back; who calls puts it on the bus.
    ///
    /// The error says why a line could not be carried out; those after it still can.
    pub fn step(&mut self, bus: &mut Bus) -> Option<Result<Option<Frame>, String>> {
        let now = bus.now();
        self.start.get_or_insert(now);
        self.done.get_or_insert(now);
        let (at, queue_of_rest) = match (self.rest.front(), self.lines.front()) {
            (Some((at, _)), _) => (*at, true),
            (None, Some((when, _))) => (self.moment(*when, now), false),
            (None, None) => return None,
        };
        if at > now {
            return None;
        }
        let action = match queue_of_rest {
            true => self.rest.pop_front()?.1,
            false => self.lines.pop_front()?.1,
        };
        self.done = Some(now);
        Some(self.act(&action, bus))
    }

    fn act(&mut self, action: &Action, bus: &mut Bus) -> Result<Option<Frame>, String> {
        let now = bus.now();
        match action {
            Action::Use(name) => self.current = device_named(bus, name)?,
            Action::Send {
                frame,
                times,
                every,
            } => {
                if let Some(times) = times.checked_sub(1).filter(|times| *times > 0) {
                    let again = Action::Send {
                        frame: *frame,
                        times,
                        every: *every,
                    };
                    self.rest.push_front((now.plus_micros(*every), again));
                }
                return Ok(Some(*frame));
            }
            Action::Nmt { command, node } => {
                let own = self.world(bus, |device, _| device.node_id().raw())?;
                let repr = nmt::Repr {
                    command: *command,
                    node: node.unwrap_or(own),
                };
                return Ok(Some(Frame::standard(0, &repr.emit())));
            }
            Action::Power(Power::Cycle(micros)) => {
                self.supply(bus, false)?;
                let on = Action::Power(Power::On);
                self.rest.push_front((now.plus_micros(*micros), on));
            }
            Action::Power(Power::On) => self.supply(bus, true)?,
            Action::Power(Power::Off) => self.supply(bus, false)?,
            Action::Shaft(shaft) => {
                let turned = self.world(bus, |device, now| shaft.act(device, now))?;
                if !turned {
                    return Err("this device has no shaft".into());
                }
            }
            Action::SwitchNode(number) => {
                self.world(bus, |device, now| device.set_node_switch(*number, now))?;
            }
            Action::SwitchBitrate(number) => {
                self.world(bus, |device, now| device.set_bitrate_switch(*number, now))?;
            }
            Action::Fault { name, on } => {
                let known = self.world(bus, |device, now| device.set_fault(name, *on, now))?;
                if !known {
                    return Err(format!("this device has no fault `{name}`"));
                }
            }
            Action::Bus(event) => self.world(bus, |device, now| device.handle_bus(*event, now))?,
            Action::Line(wire) => {
                self.world(bus, |_, _| ())?;
                wire.act(&mut bus.line, self.current);
            }
            // A line that only waits; `push` lets nothing else in.
            _ => {}
        }
        Ok(None)
    }

    fn supply(&self, bus: &mut Bus, on: bool) -> Result<(), String> {
        self.world(bus, |_, _| ())?;
        bus.set_power(self.current, on);
        Ok(())
    }

    fn world<R>(
        &self,
        bus: &mut Bus,
        act: impl FnOnce(&mut VirtualDevice, Instant) -> R,
    ) -> Result<R, String> {
        bus.with(self.current, act)
            .ok_or_else(|| format!("there is no device {}", self.current + 1))
    }
}

fn is_for_a_live_bench(action: &Action) -> bool {
    matches!(
        action,
        Action::Use(_)
            | Action::Send { .. }
            | Action::Nmt { .. }
            | Action::Power(_)
            | Action::Shaft(_)
            | Action::SwitchNode(_)
            | Action::SwitchBitrate(_)
            | Action::Fault { .. }
            | Action::Bus(_)
            | Action::Line(_)
            | Action::Wait
    )
}

/// The device with this number, counted from 1, in the order of the command line.
fn device_named(bus: &Bus, name: &str) -> Result<usize, String> {
    let count = bus.devices().len();
    match name.parse::<usize>() {
        Ok(number) if (1..=count).contains(&number) => Ok(number - 1),
        _ => Err(format!("the devices are called 1 to {count}")),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use od_runtime::NodeId;
    use std::string::ToString;

    /// What the devices send while these lines are carried out, up to 10 s.
    fn run(lines: &[&str]) -> String {
        let mut bus = Bus::new();
        for node in [1, 2] {
            let kind = od_devices::find("gxmm").expect("it is built in");
            bus.add(VirtualDevice::new(
                kind,
                NodeId::new(node).expect("1 to 127"),
            ));
        }
        let mut console = Console::default();
        for line in lines {
            console.push(line).expect("a line");
        }
        let mut out = String::new();
        loop {
            while let Some(done) = console.step(&mut bus) {
                match done {
                    Ok(Some(frame)) => {
                        bus.receive(&frame);
                    }
                    Ok(None) => {}
                    Err(why) => out.push_str(&why),
                }
                while let Some(sent) = bus.poll() {
                    out.push_str(&format!("{:?} {}\n", sent.at, sent.frame));
                }
            }
            match console.deadline(bus.now()) {
                Some(at) => bus.advance(at),
                None => return out,
            }
        }
    }

    #[test]
    fn lines_act_in_order_and_at_their_moments() {
        let out = run(&[
            "# nothing",
            "power on",
            "use 2",
            "power on",
            "(0.100000) can0 601#4000100000000000",
            "power cycle 2s",
            "can0  602   [8]  40 00 10 00 00 00 00 00",
            "use 1",
            "wait 1s",
            "nmt reset",
            "send 701#R 3 times every 10ms",
        ]);
        assert_eq!(
            out,
            "0.000000 701#00\n0.000000 702#00\n0.100000 581#4300100096010200\n\
             2.100000 702#00\n2.100000 582#4300100096010200\n3.100000 701#00\n"
        );
    }

    #[test]
    fn what_only_a_script_can_do_is_refused() {
        let mut console = Console::default();
        for (line, why) in [
            ("expect 701#00", "only a script"),
            ("device gxmm", "only a script"),
            ("sdo read 1000h", "only a script"),
            ("hello", "begins no statement"),
            ("601#4", "half a byte"),
        ] {
            let problem = console.push(line).expect_err("no such line here");
            assert!(problem.to_string().contains(why), "{line}: {problem}");
        }
        assert!(console.is_idle());
        assert_eq!(run(&["use 3"]), "the devices are called 1 to 2");
    }
}
