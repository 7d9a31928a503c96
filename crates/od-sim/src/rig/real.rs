//! A rig on a real bus: receives the frames of a link, and sends its own frames over it.

use std::prelude::v1::*;

use od_wire::Frame;

use super::{LineEvent, Link, Rig};

/// Limit of items that wait to be drained; the oldest are dropped.
const MOST: usize = 20_000;

impl Rig {
    /// Puts the rig on a real bus. Nothing is sent until [`set_sending`](Self::set_sending).
    pub(crate) fn open_link(&mut self) {
        self.link = Some(Link::default());
    }

    /// Returns whether it is on a real bus.
    pub(crate) fn has_link(&self) -> bool {
        self.link.is_some()
    }

    /// Sends or holds back the frames of this side: those of the user and of all devices.
    pub fn set_sending(&mut self, on: bool) {
        if let Some(link) = &mut self.link {
            link.sends = on;
            link.out.clear();
        }
    }

    /// Handles a frame from the link.
    pub fn hear(&mut self, frame: &Frame) {
        let now = self.bus.now();
        // A learner can act on the hardware, where the bench sees only the frames.
        self.note_act();
        self.bus.receive(frame);
        let mut devices = self.bus.devices().iter();
        let device = devices.position(|one| one.is_sender(frame));
        self.client.handle_frame(now, frame);
        self.record(LineEvent::Heard {
            at: now,
            device,
            frame: *frame,
        });
        self.collect_frames();
    }

    /// Returns the next frame to send over the link.
    pub fn outgoing(&mut self) -> Option<Frame> {
        self.link.as_mut()?.out.pop_front()
    }

    /// Returns how many frames were held back because sending is off.
    pub fn held(&self) -> u64 {
        self.link.as_ref().map_or(0, |link| link.held)
    }

    /// Returns the number of items that were dropped before they were drained.
    pub fn dropped(&self) -> u64 {
        self.link.as_ref().map_or(0, |link| link.dropped)
    }

    /// Offers a frame of this side to the link, which queues it, or holds it back while sending is off.
    /// Returns whether the frame is sent; `true` without a link.
    pub(super) fn offer_to_link(&mut self, frame: &Frame) -> bool {
        let Some(link) = &mut self.link else {
            return true;
        };
        if link.sends {
            link.out.push_back(*frame)
        } else {
            link.held += 1
        }
        link.sends
    }

    /// Drops the oldest items above the limit.
    pub(super) fn drop_oldest(&mut self) {
        if let Some(link) = &mut self.link
            && self.seen.len() >= 2 * MOST
        {
            link.dropped += MOST as u64;
            self.seen.drain(..MOST);
        }
    }
}
