//! A link whose waits end on request.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

use od_wire::{Frame, Instant};

use crate::error::Error;
use crate::link::{Heard, Link};

/// Longest wait between two checks of `stop`, in ms.
const SLICE: u64 = 50;

/// A link that ends each wait with [`Error::Interrupted`] while `stop` is set.
///
/// It still sends, so that values on the bus can be restored; only a wait for the other side to accept a frame ends, too.
#[derive(Debug)]
pub struct Interruptible<L> {
    link: L,
    stop: Arc<AtomicBool>,
}

impl<L: Link> Interruptible<L> {
    /// A link that stops when `stop` is set.
    pub const fn new(link: L, stop: Arc<AtomicBool>) -> Self {
        Self { link, stop }
    }
}

impl<L: Link> Link for Interruptible<L> {
    fn now(&self) -> Instant {
        self.link.now()
    }

    fn send(&mut self, frame: &Frame) -> Result<(), Error> {
        let was_stopped = self.stop.load(Ordering::Relaxed);
        self.link.begin_send(frame)?;
        loop {
            let slice = self.link.now().plus_millis(SLICE);
            if self.link.finish_send(slice)? {
                return Ok(());
            }
            if !was_stopped && self.stop.load(Ordering::Relaxed) {
                return Err(Error::Interrupted);
            }
        }
    }

    fn receive(&mut self, until: Instant) -> Result<Option<Heard>, Error> {
        loop {
            if self.stop.load(Ordering::Relaxed) {
                return Err(Error::Interrupted);
            }
            let slice = self.link.now().plus_millis(SLICE);
            let heard = self.link.receive(until.min(slice))?;
            if heard.is_some() || self.link.now() >= until {
                return Ok(heard);
            }
        }
    }

    fn listen_at(&mut self, kbit: u16) -> Result<(), Error> {
        self.link.listen_at(kbit)
    }

    fn resume(&mut self) {
        self.stop.store(false, Ordering::Relaxed);
        self.link.resume();
    }
}
