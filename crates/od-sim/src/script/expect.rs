//! Checks `expect` lines against the received frames.

use std::format;
use std::prelude::v1::*;

use od_runtime::Instant;

use super::run::{ON_ITS_WAY, Result, Runner, failed, impossible};
use crate::bus::Sent;
use crate::grammar::action::{Expect, Timing};
use crate::grammar::fact::Fact;
use crate::grammar::frames::Frames;
use crate::grammar::shown::duration;

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
                    self.place.held += 1;
                }
                return Ok(());
            }
            Expect::Silence(micros) => self.silence(*micros)?,
            Expect::Fact(fact) => self.fact(fact)?,
        }
        self.place.held += 1;
        Ok(())
    }

    fn fact(&mut self, fact: &Fact) -> Result<()> {
        let bench = &mut *self.bench;
        let found = fact.look(&mut bench.bus, bench.current, None);
        self.collect();
        let found = found.or_else(impossible)?;
        if found.holds {
            Ok(())
        } else {
            failed(
                fact.words(Some(self.device()?), "", false),
                format!("it is {}", found.now),
            )
        }
    }

    fn silence(&mut self, micros: u64) -> Result<()> {
        self.skip_boot_ups(|_| false);
        self.advance_until_pending(self.now().plus_micros(micros));
        match self.place.pending.front().copied() {
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
                (from.plus_micros(ON_ITS_WAY), String::new(), None)
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
        self.skip_boot_ups(|frame| wanted.matches(frame));
        self.advance_until_pending(until);
        let wanted_text = format!("{wanted}{when}");
        let Some(sent) = self.place.pending.pop_front() else {
            let ahead = self.look_ahead();
            return failed(wanted_text, ahead);
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
