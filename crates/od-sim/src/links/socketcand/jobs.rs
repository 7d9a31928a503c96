//! Repeated work of BCM mode: sends frames periodically, and watches CAN-IDs.

use std::prelude::v1::*;

use od_runtime::{CanId, Frame, Instant};

/// Limit of jobs and of subscriptions of a client.
const MOST: usize = 256;
/// Shortest period of a job, in microseconds.
const FASTEST: u64 = 1000;

#[derive(Debug)]
struct Job {
    frame: Frame,
    every: u64,
    next: Option<Instant>,
}

/// Frames that are sent periodically.
#[derive(Debug, Default)]
pub(super) struct Jobs(Vec<Job>);

impl Jobs {
    /// Adds a job, or changes the interval of the job with this CAN-ID. Its first frame is
    /// sent at once, and no further one if `every` is 0. Returns whether there is room.
    pub(super) fn add(&mut self, frame: Frame, every: u64, now: Instant) -> bool {
        self.delete(frame.id());
        if self.0.len() >= MOST {
            return false;
        }
        let every = if every == 0 { 0 } else { every.max(FASTEST) };
        self.0.push(Job {
            frame,
            every,
            next: (every > 0).then(|| now.plus_micros(every)),
        });
        true
    }

    pub(super) fn update(&mut self, frame: Frame) {
        if let Some(job) = self.0.iter_mut().find(|job| job.frame.id() == frame.id()) {
            job.frame = frame;
        }
    }

    pub(super) fn delete(&mut self, id: CanId) {
        self.0.retain(|job| job.frame.id() != id);
    }

    pub(super) fn deadline(&self) -> Option<Instant> {
        self.0.iter().filter_map(|job| job.next).min()
    }

    /// Returns the jobs that are due, each only once, even after a late call.
    pub(super) fn due(&mut self, now: Instant, mut send: impl FnMut(Frame)) {
        for job in &mut self.0 {
            if let Some(next) = job.next.filter(|next| *next <= now) {
                send(job.frame);
                let following = next.plus_micros(job.every);
                job.next = Some(if following > now {
                    following
                } else {
                    now.plus_micros(job.every)
                });
            }
        }
    }
}

#[derive(Debug)]
struct Watch {
    id: CanId,
    /// Shortest time between two frames.
    every: u64,
    /// Only changes of these bits count.
    mask: Option<Frame>,
    /// Last frame that the client received, and its time.
    heard: Option<(Frame, Instant)>,
    /// Frame to send to the client when the interval is over.
    held: Option<Frame>,
}

impl Watch {
    fn may_speak_at(&self) -> Option<Instant> {
        self.heard.map(|(_, at)| at.plus_micros(self.every))
    }

    fn is_news(&self, frame: &Frame) -> bool {
        let (Some(mask), Some((last, _))) = (&self.mask, &self.heard) else {
            return true;
        };
        let byte = |frame: &Frame, at: usize| frame.data().get(at).copied().unwrap_or(0);
        let changed = |at| (byte(frame, at) ^ byte(last, at)) & byte(mask, at) != 0;
        frame.dlc() != last.dlc() || (0..8).any(changed)
    }
}

/// Subscription of the client.
#[derive(Debug, Default)]
pub(super) struct Watches(Vec<Watch>);

impl Watches {
    /// Adds a subscription; returns whether there is room.
    pub(super) fn add(&mut self, id: CanId, every: u64, mask: Option<Frame>) -> bool {
        self.delete(id);
        if self.0.len() >= MOST {
            return false;
        }
        self.0.push(Watch {
            id,
            every,
            mask,
            heard: None,
            held: None,
        });
        true
    }

    pub(super) fn delete(&mut self, id: CanId) {
        self.0.retain(|watch| watch.id != id);
    }

    /// Returns whether the client receives this frame now. A frame that comes too early is sent later.
    pub(super) fn hears(&mut self, frame: &Frame, now: Instant) -> bool {
        let Some(watch) = self.0.iter_mut().find(|watch| watch.id == frame.id()) else {
            return false;
        };
        if !watch.is_news(frame) {
            return false;
        }
        if watch.may_speak_at().is_some_and(|at| now < at) {
            watch.held = Some(*frame);
            return false;
        }
        watch.heard = Some((*frame, now));
        watch.held = None;
        true
    }

    pub(super) fn deadline(&self) -> Option<Instant> {
        let held = self.0.iter().filter(|watch| watch.held.is_some());
        held.filter_map(Watch::may_speak_at).min()
    }

    /// Returns the next delayed frame whose time has come.
    pub(super) fn due(&mut self, now: Instant) -> Option<Frame> {
        let ready = |watch: &&mut Watch| {
            watch.held.is_some() && watch.may_speak_at().is_none_or(|at| at <= now)
        };
        let watch = self.0.iter_mut().find(ready)?;
        let frame = watch.held.take()?;
        watch.heard = Some((frame, now));
        Some(frame)
    }
}
