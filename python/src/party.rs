//! The threads that take part on a bus, and what each of them waits for.

use std::thread::{self, Thread, ThreadId};
use std::time::{Duration, Instant as Clock};

use od_wire::Instant;
use pyo3::prelude::*;

use crate::system::{Seen, see};

/// Condition for which a thread waits in a call of this package.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(crate) struct Wait {
    /// A frame for this bus.
    pub(crate) port: Option<u32>,
    /// This moment.
    pub(crate) until: Option<Instant>,
    /// Any frame on the bus; contains the number of frames that the thread has seen.
    pub(crate) seen: Option<usize>,
}

/// State of a thread outside this package.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(crate) enum Outside {
    /// It runs, as far as is known.
    Runs,
    /// It waits in Python: for a lock of `threading`, a queue, another thread, events of asyncio.
    /// `Some`: at most until this moment of virtual time.
    Waits(Option<Instant>),
}

/// Result of `odkit._who` for a thread: a number, whether the end of its wait is hidden, and its wait.
#[derive(FromPyObject)]
pub(crate) struct Found(f64, bool, Option<Py<PyAny>>);

impl Found {
    /// The thread ended.
    pub(crate) fn is_gone(&self) -> bool {
        self.0 == -2.0
    }
}

/// A thread that opened a bus of the wire, sent, received, or changed the bench; or one that started
/// while the wire was open, until it sleeps for other reasons.
#[derive(Debug)]
pub(crate) struct Party {
    /// `None` until it has taken part.
    pub(crate) thread: Option<Thread>,
    /// `threading.get_ident()`.
    pub(crate) ident: u64,
    /// `threading.get_native_id()`.
    pub(crate) native: u64,
    /// `Some` during a call that waits.
    pub(crate) wait: Option<Wait>,
    pub(crate) outside: Outside,
    /// Start of its current action.
    since: Clock,
    /// A moment, and what the thread did then.
    sample: Option<(Clock, Seen)>,
    /// Its activity at the first check.
    first: Option<Seen>,
    /// Its current wait, as Python shows it.
    token: Option<Py<PyAny>>,
    /// It may be in a wait in C that ends at this moment at the latest, or may be leaving it.
    hidden: Option<Option<Instant>>,
    /// Time follows the clock because of it.
    pub(crate) leads: bool,
    /// Python can end without waiting for it.
    pub(crate) daemon: bool,
}

/// State of the threads outside this package.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(crate) enum Known {
    /// One of them runs.
    Run,
    /// All wait, one of them until this moment at most.
    Wait(Instant),
    /// All wait, none with a time-out.
    WaitForEver,
}

/// A thread that has slept for this long, without a wait that Python shows, counts as asleep.
const NAP: Duration = Duration::from_millis(20);
/// A thread that has slept for this long without processor time does not wait for the interpreter.
const STILL: Duration = Duration::from_millis(8);
/// A thread that computes for this long does not stop time any longer.
const BUSY: Duration = Duration::from_secs(2);
/// A thread that has waited for locks for this long does not wait for the interpreter.
const LOCKED: Duration = Duration::from_millis(500);
/// Like `NAP`, if the system does not report the state of a thread.
const UNKNOWN: Duration = Duration::from_millis(100);

impl Party {
    /// A thread that has not taken part.
    pub(crate) fn new(ident: u64, native: u64, daemon: bool) -> Self {
        Self {
            thread: None,
            ident,
            native,
            wait: None,
            outside: Outside::Runs,
            since: Clock::now(),
            sample: None,
            first: None,
            token: None,
            hidden: None,
            leads: false,
            daemon,
        }
    }

    /// The calling thread.
    pub(crate) fn this((ident, native, daemon): (u64, u64, bool)) -> Self {
        Self {
            thread: Some(thread::current()),
            ..Self::new(ident, native, daemon)
        }
    }

    /// It is this thread.
    pub(crate) fn is(&self, id: ThreadId) -> bool {
        self.thread.as_ref().is_some_and(|own| own.id() == id)
    }

    /// It is outside this package, and runs.
    pub(crate) fn runs(&self) -> bool {
        self.wait.is_none() && self.outside == Outside::Runs
    }

    /// It used the bus, or starts another action. Returns its last wait.
    pub(crate) fn touch(&mut self) -> Option<Py<PyAny>> {
        self.outside = Outside::Runs;
        self.since = Clock::now();
        (self.sample, self.first, self.hidden) = (None, None, None);
        self.token.take()
    }

    /// Stores the current observation. Returns its last wait if that is over.
    pub(crate) fn learn(&mut self, found: Found, now: Instant) -> Option<Py<PyAny>> {
        let Found(seconds, hidden, token) = found;
        let mut over = None;
        match (&self.token, &token) {
            (Some(old), Some(new)) if old.is(new) => {}
            // It continues to run.
            (None, None) => {}
            (Some(_), None) => over = self.touch(),
            _ => {
                over = self.touch();
                self.token = token;
                let micros = (seconds * 1e6).round();
                let until = (micros < 1e18).then(|| now.plus_micros(micros as u64));
                self.outside = Outside::Waits(until);
                self.hidden = hidden.then_some(until);
            }
        }
        if let Some(until) = self.hidden {
            self.outside = if self.is_still() {
                Outside::Waits(until)
            } else {
                Outside::Runs
            };
        }
        over
    }

    /// Returns whether it is in no wait that other threads can end, or Python does not show its wait.
    pub(crate) fn is_of_its_own(&self) -> bool {
        matches!(self.outside, Outside::Waits(until) if until.is_some() || self.hidden.is_some())
    }

    /// It sleeps, and not for the interpreter.
    fn is_still(&mut self) -> bool {
        let Some(seen) = see(self.native) else {
            return true;
        };
        match self.sample {
            Some((at, before)) if before == seen && seen.sleeps => at.elapsed() >= STILL,
            _ => {
                self.sample = Some((Clock::now(), seen));
                false
            }
        }
    }

    /// Returns whether time must follow the clock because of this thread, and since when: it
    /// sleeps in a call that Python does not show, or computes for long.
    pub(crate) fn lets_time_follow(&mut self) -> Option<Clock> {
        let now = Clock::now();
        let so_far = now.duration_since(self.since);
        if so_far < NAP || self.hidden.is_some() {
            return None;
        }
        let Some(seen) = see(self.native) else {
            return (so_far > UNKNOWN).then_some(self.since);
        };
        let first = *self.first.get_or_insert(seen);
        let is_busy = seen.ran.saturating_sub(first.ran) > BUSY;
        if !seen.sleeps {
            self.sample = None;
            return is_busy.then_some(now);
        }
        let (at, before) = *self.sample.get_or_insert((now, seen));
        let elapsed = now.duration_since(at);
        if elapsed < NAP / 2 {
            return None;
        }
        self.sample = Some((now, seen));
        let spent = |seen: Seen| seen.ran + seen.waited;
        // A thread that waits for the interpreter gets processor time every 5 ms, and is in a lock.
        let is_blocked = seen.locked && seen.turns != before.turns && so_far < LOCKED;
        if !is_blocked && spent(seen).saturating_sub(spent(before)) < elapsed / 2 {
            Some(self.since)
        } else {
            is_busy.then_some(now)
        }
    }
}
