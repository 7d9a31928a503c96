//! Delay with which this computer resumes a waiting program.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::thread;
use std::time::Instant;

use od_wire::Duration;

/// Time between two measurements.
const BEAT: Duration = Duration::from_millis(2);

/// A thread that sleeps again and again, and measures how much later it wakes up.
///
/// A slave on the same computer is about as late; the test sees that only as a frame that is late.
pub struct Pulse {
    /// Longest delay since the last look, in microseconds.
    late: Arc<AtomicU64>,
    stop: Arc<AtomicBool>,
}

impl Pulse {
    /// Starts the thread; it ends soon after this value is dropped.
    pub fn start() -> Self {
        let pulse = Self {
            late: Arc::default(),
            stop: Arc::default(),
        };
        let (late, stop) = (Arc::clone(&pulse.late), Arc::clone(&pulse.stop));
        thread::spawn(move || {
            while !stop.load(Ordering::Relaxed) {
                let from = Instant::now();
                thread::sleep(BEAT);
                let over = from.elapsed().saturating_sub(BEAT).as_micros();
                late.fetch_max(u64::try_from(over).unwrap_or(u64::MAX), Ordering::Relaxed);
            }
        });
        pulse
    }

    /// Longest delay since the last call, in microseconds.
    pub fn take(&self) -> u64 {
        self.late.swap(0, Ordering::Relaxed)
    }
}

impl Drop for Pulse {
    fn drop(&mut self) {
        self.stop.store(true, Ordering::Relaxed);
    }
}
