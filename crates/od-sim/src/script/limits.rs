//! Limits of a script that runs while a user waits: a text from other people must not hang
//! the program that opens it.

use std::format;
use std::prelude::v1::*;

use od_runtime::Instant;

use super::outcome::{Reason, Stop};
use super::read::Script;
use crate::grammar::action::{Action, Expect, Timing, When};
use crate::grammar::deed::Deed;
use crate::grammar::duration::duration;
use crate::words::plural;

/// The limits of a script.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct Limits {
    /// Virtual time of the run, in microseconds.
    pub micros: u64,
    /// Devices on the bus, counting each channel of a redundant one.
    pub devices: usize,
    /// Frames, counting those of the script and those of devices.
    pub frames: u64,
}

impl Limits {
    /// Limits of a page: ten virtual minutes, 16 devices, 100,000 frames.
    pub const PAGE: Self = Self {
        micros: 600_000_000,
        devices: 16,
        frames: 100_000,
    };

    /// Adds up the needs of all lines before any of them runs.
    ///
    /// # Errors
    /// The first line that exceeds a limit.
    pub(super) fn check(
        &self,
        script: &Script,
        devices: usize,
        start: Instant,
    ) -> Result<(), Box<Stop>> {
        let (mut at, mut devices, mut frames) = (start, devices, 0_u64);
        for statement in &script.statements {
            let cost = Cost::of(statement.when, &statement.action, at);
            at = at.plus_micros(cost.micros);
            devices = devices.saturating_add(cost.devices);
            frames = frames.saturating_add(cost.frames);
            let passed = at.micros_since(start);
            let why = if passed > self.micros {
                let (passed, most) = (duration(passed), duration(self.micros));
                format!("up to here {passed} of virtual time pass; the limit is {most}")
            } else if devices > self.devices {
                self.room()
            } else if frames > self.frames {
                self.flood()
            } else {
                continue;
            };
            return Err(Box::new(Stop {
                line: statement.line,
                text: statement.text.clone(),
                at: start,
                reason: Reason::Impossible(why),
            }));
        }
        Ok(())
    }

    /// The message for one device too many.
    pub fn room(&self) -> String {
        format!("the bus has room for {}", plural(self.devices, "device"))
    }

    /// The message for too many frames.
    pub(super) fn flood(&self) -> String {
        format!(
            "the limit is {} in one run",
            plural(self.frames as usize, "frame")
        )
    }
}

/// Highest cost of a line.
#[derive(Default)]
struct Cost {
    micros: u64,
    devices: usize,
    frames: u64,
}

impl Cost {
    fn of(when: When, action: &Action, now: Instant) -> Self {
        let before = match when {
            When::Next => 0,
            When::At(at) => at.micros_since(now),
            When::After(micros) => micros,
        };
        let mut cost = match action {
            Action::Deed(Deed::Cycle(micros)) => Self::time(*micros),
            Action::Deed(Deed::Send { times, every, .. }) => Self {
                micros: every.saturating_mul(u64::from(times.saturating_sub(1))),
                frames: u64::from(*times),
                devices: 0,
            },
            Action::Device(added) => Self {
                devices: added.nodes.len().max(1),
                ..Self::default()
            },
            Action::Expect(Expect::Silence(micros) | Expect::Fact { within: micros, .. }) => {
                Self::time(*micros)
            }
            Action::Expect(Expect::Frame { times, timing, .. }) => match timing {
                Timing::Now => Self::default(),
                Timing::Within(micros) | Timing::After(micros) | Timing::Every(micros) => {
                    Self::time(micros.saturating_mul(u64::from(*times)))
                }
            },
            Action::Random(draw) => {
                let lines = draw.choices.iter().map(|one| &one.most);
                let costs = lines.map(|(when, action)| Self::of(*when, action, now));
                let most = costs.fold(Self::default(), |most, cost| Self {
                    micros: most.micros.max(cost.micros),
                    devices: most.devices.max(cost.devices),
                    frames: most.frames.max(cost.frames),
                });
                Self {
                    micros: most.micros.saturating_mul(u64::from(draw.times)),
                    frames: most.frames.saturating_mul(u64::from(draw.times)),
                    ..most
                }
            }
            _ => Self::default(),
        };
        cost.micros = cost.micros.saturating_add(before);
        cost
    }

    fn time(micros: u64) -> Self {
        Self {
            micros,
            ..Self::default()
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn check(text: &str) -> Result<(), String> {
        let script = Script::parse(text).expect("a script");
        let result = Limits::PAGE.check(&script, 1, Instant::from_micros(5));
        result.map_err(|stop| stop.to_string())
    }

    #[test]
    fn scripts_within_the_limits_of_a_page_run() {
        assert_eq!(
            check("wait 300s\nwait 299s\nsync 1000 times every 1ms"),
            Ok(())
        );
        assert_eq!(check(&"device gxmm\n".repeat(15)), Ok(()));
    }

    #[test]
    fn limits_apply_to_sums_of_lines() {
        for (text, line, why) in [
            ("wait 1000000000s", 1, "600s"),
            ("wait 400s\nwait 201s", 2, "601s"),
            ("power cycle 601s", 1, "600s"),
            ("expect silence 601s", 1, "600s"),
            ("at 700s power off", 1, "600s"),
            ("sync 60002 times every 10ms", 1, "600s"),
            (
                "sync 60000 times every 1us\nsync 60000 times every 1us",
                2,
                "100000 frames",
            ),
            (&"device gxmm\n".repeat(2000), 16, "16 devices"),
            ("random 7 times sync | wait 0..100s", 1, "700s"),
            (
                "random 2 times sync 1..60000 times every 1us",
                1,
                "100000 frames",
            ),
        ] {
            let said = check(text).expect_err(text);
            assert!(said.contains(why), "{text}: {said}");
            assert!(said.starts_with(&format!("line {line} ")), "{text}: {said}");
        }
    }
}
