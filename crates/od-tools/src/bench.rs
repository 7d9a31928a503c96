//! A link to a simulated bus, in virtual time.

use std::borrow::BorrowMut;

use od_sim::bus::Bus;
use od_wire::{Frame, Instant};

use crate::error::Error;
use crate::link::{Heard, Link};

/// A link to a [`Bus`], owned or borrowed: waiting advances the virtual time to the next frame at once.
#[derive(Debug)]
pub struct OnBench<B>(pub B);

impl<B: BorrowMut<Bus>> Link for OnBench<B> {
    fn now(&self) -> Instant {
        self.0.borrow().now()
    }

    fn send(&mut self, frame: &Frame) -> Result<(), Error> {
        // If the line loses the frame there is no response, as on a real bus.
        self.0.borrow_mut().receive(frame);
        Ok(())
    }

    fn receive(&mut self, until: Instant) -> Result<Option<Heard>, Error> {
        let bus = self.0.borrow_mut();
        loop {
            bus.advance_until_sent(until.max(bus.now()));
            match bus.poll() {
                // A frame of this program, which the bus reports again after its transmission on a
                // timed line.
                Some(sent) if sent.device.is_none() => {}
                Some(sent) => {
                    return Ok(Some(Heard {
                        at: sent.at,
                        frame: sent.frame,
                    }));
                }
                None => return Ok(None),
            }
        }
    }
}
