//! State of a thread as the operating system reports it; only Linux does so.

use std::fs::read_to_string;
use std::time::Duration;

/// Number of the system call in which a thread waits for a lock of Python, the interpreter's own
/// among them.
const FUTEX: &str = if cfg!(target_arch = "x86_64") {
    "202"
} else if cfg!(any(target_arch = "x86", target_arch = "arm")) {
    "240"
} else {
    "98"
};

/// State of a thread, and its activity so far.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(crate) struct Seen {
    /// It neither runs nor waits for a processor.
    pub(crate) sleeps: bool,
    /// It sleeps in a lock, as far as the system reports.
    pub(crate) locked: bool,
    /// Processor time.
    pub(crate) ran: Duration,
    /// Time during which it waited for a processor.
    pub(crate) waited: Duration,
    /// Number of turns on a processor. A thread that waits for the interpreter gets one every 5 ms.
    pub(crate) turns: u64,
}

/// Reads the state of the thread with this number; `None` if the system does not report it.
pub(crate) fn see(native: u64) -> Option<Seen> {
    let read = |name: &str| read_to_string(format!("/proc/self/task/{native}/{name}")).ok();
    let sleeps = read("stat")?.rsplit_once(") ")?.1.starts_with('S');
    let text = read("schedstat")?;
    let mut numbers = text.split_whitespace().map(str::parse::<u64>);
    let mut number = || numbers.next()?.ok();
    let (ran, waited, turns) = (number()?, number()?, number()?);
    let call = if sleeps { read("syscall") } else { None };
    Some(Seen {
        sleeps,
        locked: call.is_some_and(|call| call.split_whitespace().next() == Some(FUTEX)),
        ran: Duration::from_nanos(ran),
        waited: Duration::from_nanos(waited),
        turns,
    })
}
