//! Checks `expect` lines against the received frames.

use std::format;
use std::prelude::v1::*;

use od_runtime::Instant;

use super::run::{Result, Runner, failed, impossible};
use crate::bus::{Sent, UNTIL_QUIET};
use crate::grammar::action::{Expect, Timing};
use crate::grammar::duration::duration;
use crate::grammar::fact::Fact;
use crate::grammar::frames::Frames;

/// After a failed expectation the script runs for this time to find the frame that comes next.
const LOOK_AHEAD: u64 = 10_000_000;

impl Runner<'_> {
    pub(super) fn expect(&mut self, expect: &Expect) -> Result<()> {
        match expect {
            Expect::Frame {
                frames,
                times,
                timing,
            } => {
                for _ in 0..*times {
                    self.frame(frames, *timing)?;
                    self.progress.held += 1;
                }
                return Ok(());
            }
            Expect::Silence(micros) => self.silence(*micros)?,
            Expect::Fact { fact, within } => self.fact(fact, *within)?,
        }
        self.progress.held += 1;
        Ok(())
    }

    /// Looks after each event, because a state such as bus-off may end again before the next frame.
    fn fact(&mut self, fact: &Fact, within: u64) -> Result<()> {
        let end = self.now().plus_micros(within);
        let now = loop {
            let bench = &mut *self.bench;
            let found = fact.look(&mut bench.bus, bench.current, None);
            self.collect();
            let found = found.or_else(impossible)?;
            if found.holds {
                return Ok(());
            }
            if self.now() >= end || self.must_end() {
                break found.now;
            }
            let soon = self.now().plus_micros(1);
            let next = self.bench.bus.next_deadline();
            self.advance(next.map_or(end, |at| at.max(soon).min(end)));
        };
        let mut wanted = fact.words(Some(self.device()?), "", false);
        if within > 0 {
            wanted.push_str(&format!(" within {}", duration(within)));
        }
        failed(wanted, format!("it is {now}"))
    }

    fn silence(&mut self, micros: u64) -> Result<()> {
        self.skip_boot_ups(|_| false);
        self.advance_until_pending(self.now().plus_micros(micros));
        match self.progress.pending.front().copied() {
            None => Ok(()),
            Some(sent) => failed("silence", self.came(&sent)),
        }
    }

    fn frame(&mut self, wanted: &Frames, timing: Timing) -> Result<()> {
        let from = self.now();
        let late = self.bench.bus.longest_wait();
        let (until, when, exact) = match timing {
            // If frames take time, a frame that is being sent counts as received.
            Timing::Now if self.bench.bus.line.is_real() => {
                (from.plus_micros(UNTIL_QUIET), String::new(), None)
            }
            Timing::Now => (from, String::new(), None),
            Timing::Within(micros) => (
                from.plus_micros(micros),
                format!(" within {}", duration(micros)),
                None,
            ),
            Timing::After(micros) | Timing::Every(micros) => {
                let at = from.plus_micros(micros);
                (at.plus_micros(late), format!(" at {at:?} s"), Some(at))
            }
        };
        self.advance_until_pending(until);
        let skipped = self.skip_boot_ups(|frame| wanted.matches(frame));
        self.advance_until_pending(until);
        let wanted_text = format!("{wanted}{when}");
        let Some(sent) = self.progress.pending.pop_front() else {
            let ahead = self.look_ahead();
            return match skipped {
                Some(boot_up) => failed(
                    wanted_text,
                    format!("{}; otherwise {ahead}", self.came(&boot_up)),
                ),
                None => failed(wanted_text, ahead),
            };
        };
        let off = |at: Instant| sent.at.micros_since(at).max(at.micros_since(sent.at));
        if wanted.matches(&sent.frame) && exact.is_none_or(|at| off(at) <= late) {
            return Ok(());
        }
        failed(wanted_text, self.came(&sent))
    }

    fn came(&self, sent: &Sent) -> String {
        let words = crate::words::explain(self.bench.bus.devices(), &sent.frame);
        format!("({:?}) {} came: {words}", sent.at, sent.frame)
    }

    /// No frame came; find the one that comes later.
    fn look_ahead(&mut self) -> String {
        let now = self.now();
        let far = now.plus_micros(LOOK_AHEAD);
        let bus = &mut self.bench.bus;
        match bus.advance_until_sent(far).then(|| bus.poll()).flatten() {
            Some(sent) => {
                let later = duration(sent.at.micros_since(now));
                format!(
                    "nothing came by {now:?} s; {later} later {}",
                    self.came(&sent)
                )
            }
            None => format!("nothing came by {now:?} s, nor in the 10 s after it"),
        }
    }
}

#[cfg(test)]
mod tests {
    use std::string::ToString;

    use crate::script::{Bare, Script, run};

    /// The reason why a script stops, or an empty text.
    fn stops(lines: &str) -> String {
        let script = Script::parse(lines).expect(lines);
        match run(&script, &mut Bare(od_devices::DEVICES)) {
            Ok(_) => String::new(),
            Err(stop) => stop.to_string(),
        }
    }

    /// A node at another bit rate is bus-off for a moment only; no line about the present moment meets it.
    #[test]
    fn a_state_that_comes_and_goes_is_met_within_a_time() {
        let two = "line real\ndevice gxmm node 1\nswitch bitrate 2\ndevice gxmm node 2\nwait 1s\nsdo write 1017h = 100\nsdo write 1010h:01 = \"save\"\nswitch node 2\nswitch bitrate 4\npower cycle 1s\n";
        let bus_off = "expect controller bus-off";
        assert_eq!(
            stops(&format!(
                "{two}{bus_off} within 2s\nexpect controller error-active within 2s"
            )),
            ""
        );
        assert!(stops(&format!("{two}{bus_off}")).contains("it is error active"));
        let never = stops("line real\ndevice gxmm node 1\nexpect controller bus-off within 50ms");
        assert!(
            never.contains("the CAN controller is bus-off within 50ms"),
            "{never}"
        );
    }

    #[test]
    fn a_skipped_boot_up_message_is_named_if_another_frame_was_expected() {
        let why = stops("device gxmm node 1\nexpect 701#01");
        assert!(why.contains("701#00 came: "), "{why}");
        assert!(why.contains("; otherwise nothing came"), "{why}");
        let why = stops("device gxmm node 1\nexpect 701#00\nexpect 701#00");
        assert!(!why.contains("701#00 came"), "{why}");
    }

    #[test]
    fn a_value_is_met_at_the_event_that_changes_it() {
        let turning =
            "device gxmm\nshaft rpm 60\nnmt start\nsdo write 1800h:05 = 100\nignore 181#*\n";
        assert_eq!(
            stops(&format!("{turning}expect state operational within 1s")),
            ""
        );
        let far = format!("{turning}expect state stopped within 400ms");
        assert!(stops(&far).contains("it is Operational"), "{}", stops(&far));
    }
}
