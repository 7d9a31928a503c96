//! The threads that take part on a bus, and what each of them waits for.

use std::sync::OnceLock;
use std::thread::{self, Thread, ThreadId};
use std::time::{Duration, Instant as Clock};

use od_wire::Instant;
use pyo3::intern;
use pyo3::prelude::*;

/// Condition for which a thread waits.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Default)]
pub(crate) struct Wait {
    /// A frame for this bus.
    pub(crate) port: Option<u32>,
    /// This moment.
    pub(crate) until: Option<Instant>,
    /// Any frame on the bus; contains the number of frames that the thread has seen.
    pub(crate) seen: Option<usize>,
    /// It ends after all other waits that end at the same moment.
    pub(crate) is_last: bool,
    /// The clock and the time of the bus at the start of a wait of Python that takes the same time on both.
    pub(crate) paced: Option<(Clock, Instant)>,
}

/// A thread that opened a bus, sent, received, or changed the bench; or that one of these started.
#[derive(Debug)]
pub(crate) struct Party {
    /// `None` until a started thread runs.
    pub(crate) thread: Option<Thread>,
    /// `threading.get_ident()`; of a started thread that does not run yet, a number of its own.
    pub(crate) ident: u64,
    /// A weak reference to the `threading.Thread`.
    pub(crate) object: Py<PyAny>,
    /// The clock of its processor time, if the system has it.
    pub(crate) processor: Option<i64>,
    /// `None` while it runs.
    pub(crate) wait: Option<Wait>,
    /// A weak reference to the thread for whose end it waits: what is dropped under a lock must not run Python.
    pub(crate) target: Option<Py<PyAny>>,
    /// It waits in a call of this package on another bus.
    pub(crate) elsewhere: bool,
    /// It waits for something that odkit does not see.
    pub(crate) is_asleep: bool,
    /// It has called this package; a thread that never does is forgotten once it is silent.
    pub(crate) is_known: bool,
    /// Its processor time when another thread first saw it run after its last call of this package.
    runs: Option<f64>,
    /// Its processor time, and since when that has not changed.
    silent: Option<(Clock, f64)>,
    /// It had no processor time while another thread competed with it: a thread that could run would have had some.
    pub(crate) has_lost: bool,
}

/// State of a thread, as another thread sees it.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(crate) enum Seen {
    Runs,
    /// It has used the processor for `LONG`.
    Computes,
    /// It has had no processor time for `SILENT`: it waits for something that odkit does not see, or the computer is
    /// busy.
    Silent,
    /// It waits for something that odkit does not see.
    Asleep,
}

/// Processor time in seconds after which a thread without a call of this package is reported.
const LONG: f64 = 10.0;
/// Without processor time for this long, a thread may wait for something that odkit does not see.
const SILENT: Duration = Duration::from_secs(1);
/// Like `SILENT`, if the system does not report the processor time of a thread.
const UNKNOWN: Duration = Duration::from_secs(10);

/// Processor time in seconds for which a thread competes with one that may wait for something unseen: many of the
/// scheduler's turns.
const SHARE: f64 = 0.05;
/// Time on the clock between two looks at the processor time.
const SLICE: Duration = Duration::from_millis(2);

impl Party {
    /// A thread that runs.
    pub(crate) fn new(
        thread: Option<Thread>,
        (ident, object, processor): (u64, Py<PyAny>, Option<i64>),
    ) -> Self {
        Self {
            is_known: thread.is_some(),
            thread,
            ident,
            object,
            processor,
            wait: None,
            target: None,
            elsewhere: false,
            is_asleep: false,
            runs: None,
            silent: None,
            has_lost: false,
        }
    }

    pub(crate) fn is(&self, id: ThreadId) -> bool {
        self.thread.as_ref().is_some_and(|own| own.id() == id)
    }

    /// Notes that the thread waits.
    pub(crate) fn begin(&mut self, wait: Wait) {
        (self.wait, self.runs) = (Some(wait), None);
    }

    /// Notes that the thread runs: it neither waits nor is silent.
    pub(crate) fn touch(&mut self) {
        (self.wait, self.runs, self.silent) = (None, None, None);
        (self.is_asleep, self.has_lost, self.is_known) = (false, false, true);
    }

    /// Looks at the thread while it runs: `time` is the processor time that it has had so far.
    pub(crate) fn look(&mut self, time: Option<f64>) -> Seen {
        let long = if time.is_some() { SILENT } else { UNKNOWN };
        let time = time.unwrap_or(0.0);
        let now = Clock::now();
        let runs = *self.runs.get_or_insert(time);
        match self.silent {
            Some((since, before)) if before == time => {
                if now - since < long {
                    Seen::Runs
                } else if self.has_lost {
                    Seen::Asleep
                } else {
                    Seen::Silent
                }
            }
            _ => {
                (self.silent, self.has_lost) = (Some((now, time)), false);
                if time - runs >= LONG {
                    Seen::Computes
                } else {
                    Seen::Runs
                }
            }
        }
    }
}

/// Uses the processor for `SHARE`. A thread that could run gets its share of the processor meanwhile, however busy the
/// computer is.
///
/// # Errors
/// Exception that a signal such as Ctrl-C raises.
pub(crate) fn compete(py: Python<'_>) -> PyResult<()> {
    let time = py.import(intern!(py, "time"))?;
    let used = || -> PyResult<f64> {
        let seconds = time.call_method0(intern!(py, "thread_time"))?;
        seconds.extract()
    };
    let end = used()? + SHARE;
    while used()? < end {
        detached(py, || {
            let began = Clock::now();
            while began.elapsed() < SLICE {
                std::hint::spin_loop();
            }
        });
        py.check_signals()?;
    }
    Ok(())
}

/// The program ends: a thread that is not attached to the interpreter stays so.
#[pyfunction]
pub(crate) fn end_program() {
    let _ = ENDS.set(thread::current().id());
}

/// The thread that ends the program.
static ENDS: OnceLock<ThreadId> = OnceLock::new();

/// Calls `act` without the interpreter's lock; returns its result.
pub(crate) fn detached<T: Send>(py: Python<'_>, act: impl Send + FnOnce() -> T) -> T {
    py.detach(|| {
        let result = act();
        while ENDS.get().is_some_and(|one| *one != thread::current().id()) {
            thread::park();
        }
        result
    })
}
