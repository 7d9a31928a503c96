//! Time per operation on a machine with other load.
//!
//! All contenders of a discipline take turns in short rounds: a slow second of
//! the machine then affects all of them, and the ratios are right. The result is the
//! tenth percentile of the rounds, which are those without interruption.

use std::time::{Duration, Instant};

use crate::contender::Subject;

/// Duration of a round of one contender: shorter than the time slices of a loaded
/// system.
const ROUND: Duration = Duration::from_micros(500);

/// Nanoseconds per operation of each subject, undisturbed, from this number of rounds.
pub fn race(subjects: &mut [Box<dyn Subject>], rounds: usize) -> Vec<f64> {
    let counts: Vec<u64> = subjects.iter_mut().map(|s| calibrate(s.as_mut())).collect();
    let mut times = vec![Vec::with_capacity(rounds); subjects.len()];
    for _ in 0..rounds {
        for ((subject, &count), times) in subjects.iter_mut().zip(&counts).zip(&mut times) {
            // The other contenders have used the caches in between.
            subject.run(count / 2);
            times.push(time(subject.as_mut(), count).as_secs_f64() * 1e9 / count as f64);
        }
    }
    times.into_iter().map(undisturbed).collect()
}

/// The count of operations that fills one round; warms the subject up, too.
fn calibrate(subject: &mut dyn Subject) -> u64 {
    let mut count = 16;
    loop {
        // A single time may include an interruption.
        let tries = [(); 5].map(|()| time(subject, count));
        let taken = tries.into_iter().min().unwrap_or_default();
        if taken >= ROUND / 4 {
            let scale = ROUND.as_secs_f64() / taken.as_secs_f64();
            return ((count as f64 * scale) as u64).max(1);
        }
        count *= 4;
    }
}

fn time(subject: &mut dyn Subject, count: u64) -> Duration {
    let start = Instant::now();
    subject.run(count);
    start.elapsed()
}

fn undisturbed(mut numbers: Vec<f64>) -> f64 {
    numbers.sort_by(f64::total_cmp);
    numbers[numbers.len() / 10]
}
