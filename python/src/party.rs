//! The threads that take part on a wire, and what each of them waits for.

use std::thread::{self, Thread, ThreadId};
use std::time::{Duration, Instant as Clock};

use od_wire::Instant;

/// What a thread in a call of this package waits for.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(crate) struct Wait {
    /// A frame for this bus.
    pub(crate) port: Option<u32>,
    /// This moment.
    pub(crate) until: Option<Instant>,
}

/// What a thread outside this package does.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(crate) enum Outside {
    /// It runs, as far as anybody knows.
    Runs,
    /// It waits in Python: for a lock of `threading`, a queue, another thread, events of asyncio.
    /// `Some`: at most until this moment of virtual time.
    Waits(Option<Instant>),
}

/// A thread that opened a bus of the wire, sent, received, or changed the bench.
#[derive(Debug)]
pub(crate) struct Party {
    pub(crate) id: ThreadId,
    pub(crate) thread: Thread,
    /// `threading.get_ident()`.
    pub(crate) ident: u64,
    /// `threading.get_native_id()`.
    native: u64,
    /// `Some` in a call that waits.
    pub(crate) wait: Option<Wait>,
    pub(crate) outside: Outside,
    /// Since when it does what it does.
    pub(crate) since: Clock,
    /// A moment, and the time that the thread had spent with a processor then.
    sample: Option<(Clock, Duration)>,
    /// Time follows the clock because of it.
    pub(crate) leads: bool,
    /// Python ends without waiting for it.
    pub(crate) daemon: bool,
}

/// What the threads outside this package do.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(crate) enum Known {
    /// One of them runs.
    Run,
    /// All wait, one of them until this moment at most.
    Wait(Instant),
    /// All wait, and none for a time.
    WaitForEver,
}

/// A thread that has slept for this long, in no wait that Python shows, sleeps.
const NAP: Duration = Duration::from_millis(20);
/// A thread that computes for this long does not mind that time goes on.
const BUSY: Duration = Duration::from_secs(2);
/// As `NAP`, where the system does not say what a thread does.
const UNKNOWN: Duration = Duration::from_millis(100);

impl Party {
    /// The thread that calls.
    pub(crate) fn this(ident: u64, native: u64, daemon: bool) -> Self {
        let thread = thread::current();
        Self {
            id: thread.id(),
            thread,
            ident,
            native,
            wait: None,
            outside: Outside::Runs,
            since: Clock::now(),
            sample: None,
            leads: false,
            daemon,
        }
    }

    /// It is outside this package, and runs.
    pub(crate) fn runs(&self) -> bool {
        self.wait.is_none() && self.outside == Outside::Runs
    }

    /// It touched the wire, or begins something else.
    pub(crate) fn touch(&mut self) {
        self.outside = Outside::Runs;
        self.since = Clock::now();
        self.sample = None;
    }

    /// Returns whether time shall follow the clock because of this thread, and since when: it
    /// sleeps in a call that Python does not show, or computes and computes.
    pub(crate) fn lets_time_follow(&mut self) -> Option<Clock> {
        let now = Clock::now();
        let so_far = now.duration_since(self.since);
        if so_far < NAP {
            return None;
        }
        let Some(spent) = self.spent() else {
            return (so_far > UNKNOWN).then_some(self.since);
        };
        let Some(spent) = spent else {
            self.sample = None;
            return (so_far > BUSY).then_some(now);
        };
        let (at, before) = *self.sample.get_or_insert((now, spent));
        let elapsed = now.duration_since(at);
        if elapsed < NAP / 2 {
            return None;
        }
        self.sample = Some((now, spent));
        match spent.saturating_sub(before) < elapsed / 2 {
            true => Some(self.since),
            false => (so_far > BUSY).then_some(now),
        }
    }

    /// Time that the thread spent on a processor or waited for one, where the system has it;
    /// `Some(None)`: it does so now.
    fn spent(&self) -> Option<Option<Duration>> {
        let folder = format!("/proc/self/task/{}", self.native);
        let stat = std::fs::read_to_string(format!("{folder}/stat")).ok()?;
        if !stat.rsplit_once(") ")?.1.starts_with('S') {
            return Some(None);
        }
        let text = std::fs::read_to_string(format!("{folder}/schedstat")).ok()?;
        let mut numbers = text.split_whitespace().map(str::parse::<u64>);
        let (ran, waited) = (numbers.next()?.ok()?, numbers.next()?.ok()?);
        Some(Some(Duration::from_nanos(ran.saturating_add(waited))))
    }
}
