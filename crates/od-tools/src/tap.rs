//! A link that shows its frames to a listener.

use od_wire::{Frame, Instant};

use crate::error::Error;
use crate::link::{Heard, Link};

/// A link whose frames in both directions are passed to a function.
#[derive(Debug)]
pub struct Tap<L, F> {
    link: L,
    see: F,
}

impl<L: Link, F: FnMut(&Frame)> Tap<L, F> {
    /// Calls `see` with each frame of `link`.
    pub const fn new(link: L, see: F) -> Self {
        Self { link, see }
    }
}

impl<L: Link, F: FnMut(&Frame)> Link for Tap<L, F> {
    fn now(&self) -> Instant {
        self.link.now()
    }

    fn send(&mut self, frame: &Frame) -> Result<(), Error> {
        self.link.send(frame)?;
        (self.see)(frame);
        Ok(())
    }

    fn receive(&mut self, until: Instant) -> Result<Option<Heard>, Error> {
        let heard = self.link.receive(until)?;
        if let Some(heard) = &heard {
            (self.see)(&heard.frame);
        }
        Ok(heard)
    }

    fn listen_at(&mut self, kbit: u16) -> Result<(), Error> {
        self.link.listen_at(kbit)
    }

    fn resume(&mut self) {
        self.link.resume();
    }
}
