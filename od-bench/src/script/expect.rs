//! What `expect` lines hold against what came.

use std::format;
use std::prelude::v1::*;

use od_runtime::{AbortCode, Frame};
use od_wire::sdo;

use super::Pattern;
use super::run::{Result, Runner, failed, impossible};
use super::statement::{Expect, Timing};
use crate::bus::Sent;
use crate::leds::Led;
use od_model::values;

/// So far ahead a failed expectation looks, to say what would have come.
const LOOK_AHEAD: u64 = 10_000_000;

impl Runner<'_> {
    pub(super) fn expect(&mut self, expect: &Expect) -> Result<()> {
        match expect {
            Expect::Frame {
                pattern,
                times,
                timing,
            } => {
                for _ in 0..*times {
                    self.frame(&Wanted::Frame(pattern), *timing)?;
                    self.held += 1;
                }
                return Ok(());
            }
            Expect::Abort { code, timing } => self.frame(&Wanted::Abort(*code), *timing)?,
            Expect::Silence(micros) => self.silence(*micros)?,
            Expect::State(name) => {
                let device = self.device();
                let state = match device.is_powered() {
                    true => device.state().name().to_lowercase(),
                    false => String::from("off"),
                };
                if state != *name {
                    return failed(format!("state {name}"), format!("the state is {state}"));
                }
            }
            Expect::Value { object, value } => {
                let (data_type, bytes) = self.value(object)?;
                let wanted = match values::parse(data_type, value) {
                    Ok(wanted) => wanted,
                    Err(why) => return impossible(why),
                };
                if wanted != bytes {
                    return failed(
                        format!("{object} = {}", values::show(data_type, &wanted)),
                        format!("it is {}", values::show(data_type, &bytes)),
                    );
                }
            }
            Expect::Led { green, led } => self.led(*green, *led)?,
            Expect::BitRate(wanted) => match self.device().bit_rate() {
                Some(rate) if rate == *wanted => {}
                Some(rate) => {
                    return failed(format!("{wanted} kbit/s"), format!("it is {rate} kbit/s"));
                }
                None => return impossible("this device has no bit rate of its own"),
            },
        }
        self.held += 1;
        Ok(())
    }

    fn led(&self, green: bool, wanted: Led) -> Result<()> {
        if !self.device().has_leds() {
            return impossible("this device has no LED");
        }
        let leds = self.device().leds();
        let (colour, led) = if green {
            ("green", leds.0)
        } else {
            ("red", leds.1)
        };
        if led == wanted {
            return Ok(());
        }
        failed(
            format!("the {colour} LED is {}", wanted.name()),
            format!("it is {}", led.name()),
        )
    }

    fn silence(&mut self, micros: u64) -> Result<()> {
        self.pass_greetings(|_| false);
        self.advance_until_pending(self.bus.now().plus_micros(micros));
        match self.pending.front().copied() {
            None => Ok(()),
            Some(sent) => failed("silence", self.came(&sent)),
        }
    }

    fn frame(&mut self, wanted: &Wanted<'_>, timing: Timing) -> Result<()> {
        let from = self.bus.now();
        let (until, when, exact) = match timing {
            Timing::Now => (from, String::new(), None),
            Timing::Within(micros) => (
                from.plus_micros(micros),
                format!(" within {}", duration(micros)),
                None,
            ),
            Timing::After(micros) | Timing::Every(micros) => {
                let at = from.plus_micros(micros);
                (at, format!(" at {at:?} s"), Some(at))
            }
        };
        self.advance_until_pending(until);
        self.pass_greetings(|frame| wanted.is(frame));
        self.advance_until_pending(until);
        let wanted_text = format!("{wanted}{when}");
        let Some(sent) = self.pending.pop_front() else {
            let ahead = self.look_ahead();
            return failed(wanted_text, ahead);
        };
        if wanted.is(&sent.frame) && exact.is_none_or(|at| at == sent.at) {
            return Ok(());
        }
        failed(wanted_text, self.came(&sent))
    }

    fn came(&self, sent: &Sent) -> String {
        let words = crate::words::explain(self.bus.devices(), &sent.frame);
        format!("({:?}) {} came: {words}", sent.at, sent.frame)
    }

    /// Nothing came; what would come later?
    fn look_ahead(&mut self) -> String {
        let now = self.bus.now();
        let far = now.plus_micros(LOOK_AHEAD);
        match self
            .bus
            .advance_until_sent(far)
            .then(|| self.bus.poll())
            .flatten()
        {
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

/// Microseconds as a script writes them.
pub(crate) fn duration(micros: u64) -> String {
    match (micros % 1_000_000, micros % 1000) {
        (0, _) if micros > 0 => format!("{}s", micros / 1_000_000),
        (_, 0) => format!("{}ms", micros / 1000),
        _ => format!("{micros}us"),
    }
}

/// What a frame has to be.
enum Wanted<'w> {
    Frame(&'w Pattern),
    Abort(AbortCode),
}

impl Wanted<'_> {
    fn is(&self, frame: &Frame) -> bool {
        match self {
            Self::Frame(pattern) => pattern.matches(frame),
            Self::Abort(wanted) => {
                let id = frame.id().as_standard();
                let answer = id.is_some_and(|id| (0x581..=0x5FF).contains(&id)) && frame.dlc() == 8;
                let response = sdo::Response::parse(frame.bytes());
                answer
                    && matches!(response, sdo::Response::Abort { code, .. } if code == wanted.code())
            }
        }
    }
}

impl core::fmt::Display for Wanted<'_> {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        match self {
            Self::Frame(pattern) => pattern.fmt(f),
            Self::Abort(code) => write!(f, "SDO abort {code}"),
        }
    }
}
