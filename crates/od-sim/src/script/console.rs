//! The script language for a live bench: frames, and the surroundings of the bus.
//! Only scripts can have expectations.

use od_model::Refused;
use std::collections::VecDeque;
use std::prelude::v1::*;

use od_runtime::{Frame, Instant};

use super::read::Reader;
use crate::bench::Bench;
use crate::grammar::action::{Action, When};
use crate::grammar::deed::Deed;
use crate::grammar::problem::Problem;

/// Limit of waiting lines; more are refused.
const MOST: usize = 100_000;

/// Takes lines and carries them out in order, each at its time.
///
/// ```
/// use od_sim::script::{Bench, Console};
/// use od_sim::{Bus, VirtualDevice};
/// use od_runtime::NodeId;
///
/// let mut bus = Bus::new();
/// bus.add(VirtualDevice::new(od_devices::find("gxmm").unwrap(), NodeId::ONE));
/// let mut bench = Bench::new(bus);
/// let mut console = Console::default();
/// console.push("power on").unwrap();
/// while let Some(done) = console.step(&mut bench) {
///     done.unwrap();
/// }
/// assert!(bench.bus.devices()[0].is_powered());
/// ```
#[derive(Debug, Default)]
pub struct Console {
    reader: Reader,
    lines: VecDeque<(When, Deed)>,
    /// Time when the previous line was done.
    done: Option<Instant>,
    /// Time of the first call of `step`: time stamps and `at` count from it.
    start: Option<Instant>,
    /// The rest of a line that takes time.
    rest: Option<(Instant, Deed)>,
}

impl Console {
    /// Adds a line; empty lines and comments have no effect. Returns whether there is something
    /// to do.
    ///
    /// # Errors
    /// The problem, and the text to write instead. No part of the line is carried out then.
    pub fn push(&mut self, text: &str) -> Result<bool, Problem> {
        let Some(statement) = self.reader.statement(text)? else {
            return Ok(false);
        };
        let Action::Deed(deed) = statement.action else {
            return Err(Problem::new(
                statement.line,
                "this line works only in a script",
                "write it into a file and start `odkit run`",
            ));
        };
        if self.lines.len() >= MOST {
            return Err(Problem::new(
                statement.line,
                "too many lines are waiting",
                "send fewer lines at once",
            ));
        }
        self.lines.push_back((statement.when, deed));
        Ok(true)
    }

    /// The action that begins next, if none is in progress.
    #[cfg(feature = "serve")]
    pub(crate) fn front(&self) -> Option<&Deed> {
        let front = self.lines.front().filter(|_| self.rest.is_none());
        front.map(|(_, deed)| deed)
    }

    /// Returns whether the last line is in progress.
    #[cfg(feature = "serve")]
    pub(crate) fn goes_on(&self) -> bool {
        self.rest.is_some()
    }

    /// Forgets all lines, except for power that a line has switched off for a time.
    #[cfg(feature = "serve")]
    pub(crate) fn abandon(&mut self) {
        self.lines.clear();
        self.rest.take_if(|(_, rest)| *rest != Deed::Power(true));
    }

    /// Returns whether everything has been carried out.
    pub fn is_idle(&self) -> bool {
        self.lines.is_empty() && self.rest.is_none()
    }

    /// Time when [`step`](Self::step) is due, as seen at `now`.
    pub fn deadline(&self, now: Instant) -> Option<Instant> {
        if let Some((at, _)) = &self.rest {
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

    /// Carries out the next line that is due; `None` if none is. It returns a frame that the line
    /// sends; the caller puts it on the bus.
    ///
    /// The error tells why a line could not be carried out; later lines still can.
    pub fn step(&mut self, bench: &mut Bench) -> Option<Result<Option<Frame>, Refused>> {
        let now = bench.bus.now();
        self.start.get_or_insert(now);
        self.done.get_or_insert(now);
        if self.deadline(now)? > now {
            return None;
        }
        let deed = match self.rest.take() {
            Some((_, deed)) => deed,
            None => self.lines.pop_front()?.1,
        };
        self.done = Some(now);
        let result = deed.act(bench);
        // Do not repeat a failed action.
        let rest = deed.rest().filter(|_| result.is_ok());
        self.rest = rest.map(|(micros, rest)| (now.plus_micros(micros), rest));
        Some(result.map_err(Refused::from))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::bus::Bus;
    use crate::device::VirtualDevice;
    use od_runtime::NodeId;
    use std::format;
    use std::string::ToString;

    /// Frames of the devices while these lines are carried out, for up to 10 s.
    fn run(lines: &[&str]) -> String {
        let mut bus = Bus::new();
        for node in [1, 2] {
            let kind = od_devices::find("gxmm").expect("it is built in");
            bus.add(VirtualDevice::new(
                kind,
                NodeId::new(node).expect("1 to 127"),
            ));
        }
        let mut bench = Bench::new(bus);
        let mut console = Console::default();
        for line in lines {
            console.push(line).expect("a line");
        }
        let mut out = String::new();
        loop {
            while let Some(done) = console.step(&mut bench) {
                match done {
                    Ok(Some(frame)) => {
                        bench.bus.receive(&frame);
                    }
                    Ok(None) => {}
                    Err(why) => out.push_str(&why.to_string()),
                }
                while let Some(sent) = bench.bus.poll() {
                    out.push_str(&format!("{:?} {}\n", sent.at, sent.frame));
                }
            }
            match console.deadline(bench.bus.now()) {
                Some(at) => bench.bus.advance(at),
                None => return out,
            }
        }
    }

    #[test]
    fn lines_act_in_order_and_at_their_times() {
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
    fn lines_only_for_scripts_are_refused() {
        let mut console = Console::default();
        for (line, why) in [
            ("expect 701#00", "only in a script"),
            ("device gxmm", "only in a script"),
            ("sdo read 1000h", "only in a script"),
            ("hello", "is not a verb"),
            ("601#4", "half a byte"),
        ] {
            let problem = console.push(line).expect_err("no such line here");
            assert!(problem.to_string().contains(why), "{line}: {problem}");
        }
        assert!(console.is_idle());
        assert_eq!(
            run(&["use 3"]),
            "device `3` does not exist; write its number, 1 to 2, or the name after `as` in its \
             `device` line"
        );
    }
}
