//! The state of a CAN controller whose driver does not report it.

use embassy_time::{Duration, Timer, with_timeout};
use od_runtime::{BusEvent, Frame};

/// Time after which the state is checked again.
const LOOK: Duration = Duration::from_millis(10);

/// Pause after an error of the bus: a controller may report one for each bit.
const PAUSE: Duration = Duration::from_millis(1);

/// Checks the state of a CAN controller, so that the node learns of bus-off and its end. It is a
/// part of [`Receive`](crate::Receive) for drivers that wait only for frames.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct Watch {
    /// State that was last reported to the node.
    known: BusEvent,
}

impl Default for Watch {
    fn default() -> Self {
        Self::new()
    }
}

impl Watch {
    /// A watch for a controller that has just been started.
    pub const fn new() -> Self {
        Self {
            known: BusEvent::Active,
        }
    }

    /// Waits for a frame, or for a change of the state since the last call. `state` returns the
    /// state of the controller, or [`BusEvent::Overrun`] once after a lost frame. `read` waits for
    /// a frame, and returns `None` after an error of the bus; its future may be dropped before.
    ///
    /// # Errors
    /// The new state.
    pub async fn receive(
        &mut self,
        mut state: impl FnMut() -> BusEvent,
        mut read: impl AsyncFnMut() -> Option<Frame>,
    ) -> Result<Frame, BusEvent> {
        loop {
            let state = state();
            if state != self.known {
                self.known = state;
                return Err(state);
            }
            match with_timeout(LOOK, read()).await {
                Ok(Some(frame)) => return Ok(frame),
                Ok(None) => Timer::after(PAUSE).await,
                Err(_) => {}
            }
        }
    }
}
