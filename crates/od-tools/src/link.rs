//! A link to a bus.

use od_wire::{Frame, Instant};

use crate::error::Error;

/// A received frame.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct Heard {
    /// Time by the link's clock.
    pub at: Instant,
    /// The frame.
    pub frame: Frame,
}

/// A link to a bus, with a clock of its own: real time on a real bus, virtual time on a simulated one.
/// A wait on a simulated bus advances its time and does not sleep.
pub trait Link {
    /// The present moment; [`Instant::ZERO`] is when the link was opened.
    fn now(&self) -> Instant;

    /// Sends a frame.
    ///
    /// # Errors
    /// [`Error::Link`] if the link is lost.
    fn send(&mut self, frame: &Frame) -> Result<(), Error>;

    /// Begins to send a frame. A link that may have to wait for the other side returns at once;
    /// [`finish_send`](Self::finish_send) completes the frame.
    ///
    /// # Errors
    /// As [`send`](Self::send).
    fn begin_send(&mut self, frame: &Frame) -> Result<(), Error> {
        self.send(frame)
    }

    /// Waits until `until` for the other side to accept the frame that was begun; returns whether it did. A frame that is
    /// not completed goes out before the next one.
    ///
    /// # Errors
    /// As [`send`](Self::send).
    fn finish_send(&mut self, _until: Instant) -> Result<bool, Error> {
        Ok(true)
    }

    /// Waits until `until` for the next frame of another sender; with a time in the past it returns a frame
    /// that has already arrived, and does not wait. Frames sent over this link are not received.
    ///
    /// # Errors
    /// [`Error::Link`] if the link is lost.
    fn receive(&mut self, until: Instant) -> Result<Option<Heard>, Error>;

    /// Changes to another bit rate, in kbit/s, in listen-only mode: it acknowledges nothing,
    /// so that a wrong bit rate does not disturb a node.
    ///
    /// # Errors
    /// [`Error::Usage`] if this link cannot; [`Error::Link`] if it is lost.
    fn listen_at(&mut self, kbit: u16) -> Result<(), Error> {
        Err(Error::Usage(format!(
            "this link cannot listen at {kbit} kbit/s; bit-rate detection needs an slcan adapter"
        )))
    }

    /// Waits again after [`Error::Interrupted`], so that values on the bus can be restored.
    fn resume(&mut self) {}
}

/// Implements [`Link`] for a pointer to a link.
macro_rules! forward {
    ($pointer:ty) => {
        impl<L: Link + ?Sized> Link for $pointer {
            fn now(&self) -> Instant {
                (**self).now()
            }

            fn send(&mut self, frame: &Frame) -> Result<(), Error> {
                (**self).send(frame)
            }

            fn begin_send(&mut self, frame: &Frame) -> Result<(), Error> {
                (**self).begin_send(frame)
            }

            fn finish_send(&mut self, until: Instant) -> Result<bool, Error> {
                (**self).finish_send(until)
            }

            fn receive(&mut self, until: Instant) -> Result<Option<Heard>, Error> {
                (**self).receive(until)
            }

            fn listen_at(&mut self, kbit: u16) -> Result<(), Error> {
                (**self).listen_at(kbit)
            }

            fn resume(&mut self) {
                (**self).resume();
            }
        }
    };
}

forward!(&mut L);
forward!(Box<L>);
