//! Notices an input that never ends, in processor time: a busy machine does not make it one.

use std::fs;
use std::path::PathBuf;
use std::sync::{Mutex, PoisonError};
use std::time::{Duration, Instant};

/// The input that one worker runs.
#[derive(Default)]
pub(crate) struct Watch(Mutex<Running>);

#[derive(Default)]
struct Running {
    clock: Clock,
    /// Number and bytes of the input.
    input: Option<(u64, Vec<u8>)>,
}

/// The time that one thread computed.
#[derive(Clone, Default)]
enum Clock {
    /// Linux counts it, in nanoseconds, in the first number of this file.
    Schedule(PathBuf),
    /// Elsewhere time goes on for a thread that waits, too.
    Wall(Instant),
    #[default]
    Stopped,
}

impl Clock {
    /// The clock of the thread that calls this.
    fn own() -> Self {
        let thread = fs::read_link("/proc/thread-self").map(|thread| {
            let file = PathBuf::from("/proc").join(thread).join("schedstat");
            file.is_file().then_some(file)
        });
        match thread {
            Ok(Some(file)) => Self::Schedule(file),
            _ => Self::Wall(Instant::now()),
        }
    }

    fn now(&self) -> Duration {
        match self {
            Self::Schedule(file) => {
                let text = fs::read_to_string(file).unwrap_or_default();
                let first = text.split(' ').next().and_then(|word| word.parse().ok());
                Duration::from_nanos(first.unwrap_or(0))
            }
            Self::Wall(start) => start.elapsed(),
            Self::Stopped => Duration::ZERO,
        }
    }
}

impl Watch {
    fn lock(&self) -> std::sync::MutexGuard<'_, Running> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// The thread that calls this is the one to watch.
    pub(crate) fn begin(&self) {
        self.lock().clock = Clock::own();
    }

    /// The thread runs this input from now on, or none.
    pub(crate) fn set(&self, input: Option<(u64, Vec<u8>)>) {
        self.lock().input = input;
    }
}

/// Looks at a worker again and again.
#[derive(Default)]
pub(crate) struct Watcher {
    /// The input that it saw first, and the processor time of the worker then.
    seen: Option<(u64, Duration)>,
}

impl Watcher {
    /// The input that the worker computes on for longer than `patience`.
    pub(crate) fn overdue(&mut self, watch: &Watch, patience: Duration) -> Option<Vec<u8>> {
        let running = watch.lock();
        let Some((number, input)) = &running.input else {
            self.seen = None;
            return None;
        };
        let now = running.clock.now();
        match self.seen {
            Some((seen, since)) if seen == *number => {
                (now.saturating_sub(since) > patience).then(|| input.clone())
            }
            _ => {
                self.seen = Some((*number, now));
                None
            }
        }
    }
}

#[cfg(all(test, target_os = "linux"))]
mod tests {
    use std::hint::spin_loop;
    use std::sync::atomic::{AtomicBool, Ordering};
    use std::sync::mpsc;
    use std::thread;
    use std::time::Duration;

    use super::{Watch, Watcher};

    /// Two threads are at their inputs for the same time; one computes and one waits.
    #[test]
    fn only_computing_counts() {
        let patience = Duration::from_millis(30);
        let (busy, idle) = (Watch::default(), Watch::default());
        let (ready, is_ready) = mpsc::channel();
        let (wake, sleep) = mpsc::channel::<()>();
        let done = AtomicBool::new(false);
        thread::scope(|scope| {
            let (busy, idle, done, also_ready) = (&busy, &idle, &done, ready.clone());
            scope.spawn(move || {
                idle.begin();
                idle.set(Some((1, vec![1])));
                ready.send(()).unwrap();
                sleep.recv().unwrap();
            });
            scope.spawn(move || {
                busy.begin();
                busy.set(Some((2, vec![2])));
                also_ready.send(()).unwrap();
                while !done.load(Ordering::Relaxed) {
                    spin_loop();
                }
            });
            is_ready.iter().take(2).for_each(drop);
            let mut watchers = [Watcher::default(), Watcher::default()];
            let found = loop {
                let [of_busy, of_idle] = &mut watchers;
                assert_eq!(of_idle.overdue(idle, patience), None, "it only waits");
                if let Some(input) = of_busy.overdue(busy, patience) {
                    break input;
                }
                thread::yield_now();
            };
            assert_eq!(found, [2]);
            busy.set(Some((3, vec![3])));
            assert_eq!(watchers[0].overdue(busy, patience), None, "a new input");
            done.store(true, Ordering::Relaxed);
            wake.send(()).unwrap();
        });
    }
}
