//! The queue of LSS services.

use alloc::collections::VecDeque;

use od_wire::{Frame, Instant};

use super::events::{Event, Events, Job};
use crate::lss::{Master, Options, Task};

/// The service in progress, then the waiting ones.
#[derive(Clone, Debug)]
pub(super) struct Tasks {
    master: Master,
    active: Option<Job>,
    waiting: VecDeque<(Job, Task)>,
}

impl Tasks {
    pub(super) const fn new(options: Options) -> Self {
        Self {
            master: Master::new(options),
            active: None,
            waiting: VecDeque::new(),
        }
    }

    pub(super) fn push(&mut self, job: Job, task: Task) {
        self.waiting.push_back((job, task));
        self.begin();
    }

    /// Returns whether the job existed.
    pub(super) fn cancel(&mut self, job: Job) -> bool {
        if self.active == Some(job) {
            self.master.cancel();
            self.active = None;
            self.begin();
            return true;
        }
        let at = self.waiting.iter().position(|(waiting, _)| *waiting == job);
        at.and_then(|at| self.waiting.remove(at)).is_some()
    }

    pub(super) fn handle_frame(&mut self, now: Instant, frame: &Frame, events: &mut Events) {
        self.master.handle_frame(now, frame);
        self.end_if_complete(events);
    }

    pub(super) fn handle_timeout(&mut self, now: Instant, events: &mut Events) {
        self.master.handle_timeout(now);
        self.end_if_complete(events);
    }

    pub(super) fn poll_transmit(&mut self, now: Instant, events: &mut Events) -> Option<Frame> {
        let frame = self.master.poll_transmit(now);
        self.end_if_complete(events);
        frame
    }

    pub(super) fn poll_timeout(&self) -> Option<Instant> {
        self.master.poll_timeout()
    }

    fn begin(&mut self) {
        if self.active.is_none()
            && let Some((job, task)) = self.waiting.pop_front()
            && self.master.begin(task).is_ok()
        {
            self.active = Some(job);
        }
    }

    /// Ends a task that has its answer, and begins the next one.
    fn end_if_complete(&mut self, events: &mut Events) {
        if let Some(job) = self.active
            && let Some(answer) = self.master.poll_answer()
        {
            self.active = None;
            events.end(Event::Lss(job, answer));
            self.begin();
        }
    }
}
