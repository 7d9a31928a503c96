//! Bytes that wait for a client.

use std::collections::VecDeque;
use std::time::{Duration, Instant as Clock};

/// Pause after a message that the client has to read separately.
const PAUSE: Duration = Duration::from_millis(100);
/// An empty queue keeps this much memory, in bytes.
const KEPT: usize = 64 * 1024;

/// A queue of bytes, with pauses in it.
#[derive(Debug, Default)]
pub(super) struct Outbox {
    bytes: Vec<u8>,
    /// Number of bytes at the front of `bytes` that are already written.
    start: usize,
    /// Positions of pauses, counted from the first byte ever written.
    pauses: VecDeque<u64>,
    written: u64,
    /// Nothing is written before this moment.
    resting: Option<Clock>,
}

impl Outbox {
    /// Number of bytes that wait.
    pub(super) fn len(&self) -> usize {
        self.bytes.len() - self.start
    }

    pub(super) fn is_empty(&self) -> bool {
        self.len() == 0
    }

    pub(super) fn push(&mut self, bytes: &[u8]) {
        if self.start > self.bytes.len() / 2 {
            self.bytes.drain(..self.start);
            self.start = 0;
        }
        self.bytes.extend_from_slice(bytes);
    }

    /// Adds a pause after the bytes so far.
    pub(super) fn pause(&mut self) {
        self.pauses.push_back(self.written + self.len() as u64);
    }

    /// The bytes that may be written now.
    pub(super) fn next(&mut self, now: Clock) -> &[u8] {
        if self.resting.is_some_and(|until| now < until) {
            return &[];
        }
        self.resting = None;
        let whole = &self.bytes[self.start..];
        match self.pauses.front() {
            Some(place) => &whole[..(place - self.written) as usize],
            None => whole,
        }
    }

    /// Marks the first `count` bytes of [`next`](Self::next) as written.
    pub(super) fn wrote(&mut self, count: usize, now: Clock) {
        self.start += count;
        self.written += count as u64;
        if self.pauses.front() == Some(&self.written) {
            self.pauses.pop_front();
            self.rest(now + PAUSE);
        }
        if self.is_empty() {
            self.bytes.clear();
            self.bytes.shrink_to(KEPT);
            self.start = 0;
        }
    }

    /// Writes nothing before this moment.
    pub(super) fn rest(&mut self, until: Clock) {
        self.resting = Some(until);
    }

    /// The end of the pause; `None`: no bytes wait for it.
    pub(super) fn deadline(&self) -> Option<Clock> {
        self.resting.filter(|_| !self.is_empty())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_message_before_a_pause_is_read_separately() {
        let now = Clock::now();
        let mut outbox = Outbox::default();
        outbox.push(b"z\r");
        outbox.push(b"< ok >");
        outbox.pause();
        outbox.push(b"< frame");
        assert_eq!(outbox.deadline(), None);
        assert_eq!(outbox.next(now), b"z\r< ok >");
        outbox.wrote(3, now);
        assert_eq!(outbox.next(now), b" ok >");
        outbox.wrote(5, now);
        assert_eq!(outbox.next(now), b"");
        assert_eq!(outbox.deadline(), Some(now + PAUSE));
        let later = now + PAUSE;
        assert_eq!(outbox.next(later), b"< frame");
        outbox.wrote(7, later);
        assert!(outbox.is_empty() && outbox.deadline().is_none());
    }

    #[test]
    fn an_empty_queue_frees_its_memory() {
        let now = Clock::now();
        let mut outbox = Outbox::default();
        let line = [b'0'; 1024];
        for round in 0..3000 {
            outbox.push(&line);
            assert_eq!(outbox.len(), 1024 * (round + 1 - round / 2));
            if round % 2 == 1 {
                outbox.wrote(1024, now);
            }
        }
        let rest = outbox.next(now).len();
        outbox.wrote(rest, now);
        assert!(outbox.bytes.capacity() <= KEPT);
    }
}
