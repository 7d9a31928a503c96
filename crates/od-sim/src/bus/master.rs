//! The master on the bus: it sends and hears through the CAN interface of the outside.

use od_model::Refused;
use od_runtime::{Frame, Instant};
use od_wire::NodeId;

use super::{Bus, STUCK, Sent};
use crate::master::{BootState, Master, Order};

/// Limit of frames of the master that are kept until the line has transmitted them.
#[cfg(feature = "serve")]
const MOST_KEPT: usize = 1000;

impl Bus {
    /// The master; `None` if it got no order yet.
    pub fn master(&self) -> Option<&Master> {
        self.master.as_deref()
    }

    /// Gives the master an order.
    ///
    /// # Errors
    /// A sentence: the list has no slave to boot.
    pub(crate) fn order_master(&mut self, order: &Order) -> Result<(), Refused> {
        let now = self.now;
        let master = self.master.get_or_insert_default();
        master.order(now, order)?;
        self.run_master();
        Ok(())
    }

    /// The state of a node, as the master sees it; `None`: it has not begun to boot the node.
    pub(crate) fn boot_state(&self, node: NodeId) -> Option<BootState> {
        let boot = self.master.as_ref()?.boot(node)?;
        Some(boot.state)
    }

    /// Time when the master is due.
    pub(super) fn master_due(&self) -> Option<Instant> {
        self.master.as_ref()?.poll_timeout()
    }

    /// Returns whether there is a master.
    pub(super) fn has_master(&self) -> bool {
        self.master.is_some()
    }

    /// Passes a frame of a device to the master.
    pub(super) fn tell_master(&mut self, frame: &Frame) {
        if let Some(master) = &mut self.master {
            master.handle_frame(self.now, frame);
        }
    }

    /// Returns whether the master sent this frame, and forgets it. A station sends its frames in order, so earlier
    /// ones are lost.
    #[cfg(feature = "serve")]
    pub(crate) fn take_of_master(&mut self, frame: &Frame) -> bool {
        let at = self.of_master.iter().position(|sent| sent == frame);
        self.of_master.drain(..at.map_or(0, |at| at + 1));
        at.is_some()
    }

    /// The master does what is due at this moment, and sends its frames.
    pub(super) fn run_master(&mut self) {
        // A master and a node that answer each other for ever would stop time.
        for _ in 0..STUCK {
            let Some(master) = &mut self.master else {
                return;
            };
            if master.poll_timeout().is_some_and(|at| at <= self.now) {
                master.handle_timeout(self.now);
            }
            let Some(frame) = master.poll_transmit(self.now) else {
                return;
            };
            #[cfg(feature = "serve")]
            if self.of_master.len() < MOST_KEPT {
                self.of_master.push_back(frame);
            }
            if self.line.is_real() {
                // A SYNC message that still waits for a full line is not sent twice.
                if !(frame.data().is_empty() && self.is_waiting(&frame)) {
                    self.queue(&frame);
                }
            } else if self.line.is_plugged(0) {
                self.sent.push_back(Sent {
                    at: self.now,
                    device: None,
                    frame,
                });
                self.hand_over(&frame);
            }
        }
    }
}
