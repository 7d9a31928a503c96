//! Actions over time: profiles of shafts, and cyclic frames.

use std::prelude::v1::*;

use od_wire::{Frame, Instant};

/// A shaft's profile: speeds with their durations.
#[derive(Clone)]
struct Motion {
    device: usize,
    /// Revolutions per minute, and microseconds.
    steps: Vec<(f64, u64)>,
    repeats: bool,
    next: usize,
    due: Instant,
}

/// A cyclic frame.
#[derive(Clone)]
struct Cyclic {
    key: u32,
    frame: Frame,
    every: u64,
    due: Instant,
}

/// All actions with their times.
#[derive(Clone, Default)]
pub(super) struct Clockwork {
    motions: Vec<Motion>,
    cyclic: Vec<Cyclic>,
}

/// An action that is due.
pub(super) enum Tick {
    Rpm(usize, f64),
    Send(Frame),
}

/// The shortest step of a profile and the shortest interval, so that time advances.
const SHORTEST: u64 = 100;

impl Clockwork {
    /// Lets a shaft follow `steps` from now on, pairs of rpm and milliseconds; none stop it.
    pub(super) fn follow(&mut self, device: usize, steps: &[f64], repeats: bool, now: Instant) {
        self.motions.retain(|motion| motion.device != device);
        let step = |pair: &[f64]| (pair[0], ((pair[1] * 1000.0) as u64).max(SHORTEST));
        let steps: Vec<_> = steps.chunks_exact(2).map(step).collect();
        if !steps.is_empty() {
            self.motions.push(Motion {
                device,
                steps,
                repeats,
                next: 0,
                due: now,
            });
        }
    }

    /// Returns whether the shaft follows a profile.
    pub(super) fn moves(&self, device: usize) -> bool {
        self.motions.iter().any(|motion| motion.device == device)
    }

    /// Removes a device; later devices move up.
    pub(super) fn remove(&mut self, device: usize) {
        self.motions.retain(|motion| motion.device != device);
        for motion in &mut self.motions {
            motion.device -= usize::from(motion.device > device);
        }
    }

    /// Sends a frame at this interval in microseconds from now on; 0 ends it. Each key has one frame.
    pub(super) fn repeat(&mut self, key: u32, frame: Frame, every: u64, now: Instant) {
        self.cyclic.retain(|one| one.key != key);
        if every > 0 {
            let every = every.max(SHORTEST);
            self.cyclic.push(Cyclic {
                key,
                frame,
                every,
                due: now,
            });
        }
    }

    /// Time of the next action.
    pub(super) fn due(&self) -> Option<Instant> {
        let motions = self.motions.iter().map(|motion| motion.due);
        motions.chain(self.cyclic.iter().map(|one| one.due)).min()
    }

    /// Returns the next action that is due now.
    pub(super) fn take(&mut self, now: Instant) -> Option<Tick> {
        if let Some(place) = self.motions.iter().position(|motion| motion.due <= now) {
            let motion = &mut self.motions[place];
            let device = motion.device;
            if motion.next == motion.steps.len() {
                if !motion.repeats {
                    self.motions.remove(place);
                    return Some(Tick::Rpm(device, 0.0));
                }
                motion.next = 0;
            }
            let (rpm, micros) = motion.steps[motion.next];
            motion.next += 1;
            motion.due = motion.due.plus_micros(micros);
            return Some(Tick::Rpm(device, rpm));
        }
        let one = self.cyclic.iter_mut().find(|one| one.due <= now)?;
        one.due = one.due.plus_micros(one.every);
        Some(Tick::Send(one.frame))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_profile_runs_its_steps_and_ends_or_begins_again() {
        let mut clockwork = Clockwork::default();
        clockwork.follow(2, &[60.0, 10.0, -60.0, 5.0], false, Instant::ZERO);
        let mut seen = Vec::new();
        while let Some(due) = clockwork.due() {
            if let Some(Tick::Rpm(2, rpm)) = clockwork.take(due) {
                seen.push((due.as_micros(), rpm));
            }
        }
        assert_eq!(seen, [(0, 60.0), (10_000, -60.0), (15_000, 0.0)]);
        assert!(!clockwork.moves(2));
        clockwork.follow(0, &[1.0, f64::NAN], true, Instant::ZERO);
        for _ in 0..3 {
            let due = clockwork.due().unwrap_or(Instant::ZERO);
            assert!(clockwork.take(due).is_some(), "it continues");
        }
        assert_eq!(clockwork.due(), Some(Instant::from_micros(300)));
    }

    #[test]
    fn a_cyclic_frame_keeps_its_interval_until_it_is_ended() {
        let mut clockwork = Clockwork::default();
        let sync = Frame::standard(0x80, &[]);
        clockwork.repeat(7, sync, 1000, Instant::from_micros(500));
        assert!(clockwork.take(Instant::from_micros(499)).is_none());
        for at in [500, 1500, 2500] {
            assert_eq!(clockwork.due(), Some(Instant::from_micros(at)));
            assert!(matches!(
                clockwork.take(Instant::from_micros(at)),
                Some(Tick::Send(_))
            ));
        }
        clockwork.repeat(7, sync, 0, Instant::ZERO);
        assert_eq!(clockwork.due(), None);
    }
}
