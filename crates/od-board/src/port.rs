//! A CAN controller of the `embedded-can` ecosystem, and the frames that wait for it.

use core::mem::swap;

use embedded_can::{ErrorKind, blocking};
use od_runtime::{BusEvent, Frame, Instant};
use od_wire::CanId;

use crate::owner::Owner;

/// Number of frames that can wait for the controller. While all places are used, the node keeps its
/// frames.
const ROOM: usize = 4;

/// Frames that wait for a mailbox of the CAN controller, the one with the highest priority first;
/// frames with the same CAN-ID keep their order.
///
/// A frame that an nb `transmit` pushes out of its mailbox, to make room for one of higher
/// priority, returns to this queue and is sent later.
#[derive(Clone, Debug)]
pub struct Port {
    frames: [Frame; ROOM],
    len: usize,
}

impl Default for Port {
    fn default() -> Self {
        Self::new()
    }
}

impl Port {
    /// A port without waiting frames.
    pub const fn new() -> Self {
        Self {
            frames: [Frame::standard(0, &[]); ROOM],
            len: 0,
        }
    }

    /// Returns whether no frame waits here; the node may have further frames.
    pub const fn is_empty(&self) -> bool {
        self.len == 0
    }

    /// Drops the waiting frames, as [`peek`](Self::peek) does while the owner is bus-off.
    pub const fn clear(&mut self) {
        self.len = 0;
    }

    /// Returns the frame to send next without removing it, since the controller may have no room.
    /// While the controller has room, frames are sent in the order of the node.
    pub fn peek(&mut self, owner: &mut impl Owner, now: Instant) -> Option<&Frame> {
        if owner.is_bus_off() {
            self.clear();
        }
        if self.len == 0
            && let Some(frame) = owner.poll_transmit(now)
        {
            self.insert(frame, false);
        }
        self.waiting().first()
    }

    /// The waiting frames, in the order in which they are sent.
    fn waiting(&self) -> &[Frame] {
        self.frames.get(..self.len).unwrap_or_default()
    }

    /// Call this if the controller has no room for the frame of [`peek`](Self::peek). Returns
    /// whether the node has a frame of higher priority, for which the controller may have room. No
    /// frame overtakes a boot-up message.
    pub fn has_higher(&mut self, owner: &mut impl Owner, now: Instant) -> bool {
        let first = self.waiting().first().map(Frame::id);
        if self.waiting().iter().any(is_boot_up) {
            return false;
        }
        while self.len < ROOM
            && let Some(frame) = owner.poll_transmit(now)
        {
            self.insert(frame, false);
        }
        self.waiting().first().map(Frame::id) != first
    }

    /// Notes that the controller accepted the frame of [`peek`](Self::peek), and stores the frame
    /// that it pushed out of a mailbox, if there was one.
    pub fn sent(&mut self, frame: &Frame, thrown_out: Option<Frame>) {
        if let Some(at) = self.waiting().iter().position(|other| other == frame) {
            // The frames after it move up.
            let mut behind = *frame;
            let from = self.frames.iter_mut().take(self.len).skip(at);
            from.rev().for_each(|room| swap(room, &mut behind));
            self.len -= 1;
        }
        if let Some(frame) = thrown_out {
            self.insert(frame, true);
        }
    }

    /// `before`: it is older than the waiting frames with its CAN-ID.
    fn insert(&mut self, frame: Frame, before: bool) {
        if self.len == ROOM {
            return;
        }
        let key = rank(frame.id());
        let at = (self.waiting().iter())
            .take_while(|other| match rank(other.id()) {
                rank if rank == key => !before,
                rank => rank < key,
            })
            .count();
        self.len += 1;
        // The frames after it move back.
        let mut next = frame;
        let from = self.frames.iter_mut().take(self.len).skip(at);
        from.for_each(|room| swap(room, &mut next));
    }

    /// Handles all received frames and what is due, and sends frames while there is room. It never
    /// waits, so it can be used in a loop or an interrupt.
    ///
    /// # Errors
    /// The first error of the controller. Call it again: no frame of the node is lost. An overrun
    /// is reported to the node and is not an error here.
    pub fn serve_nb<C: embedded_can::nb::Can>(
        &mut self,
        owner: &mut impl Owner,
        can: &mut C,
        now: Instant,
    ) -> Result<(), C::Error> {
        loop {
            let received = can.receive();
            match received {
                Ok(frame) => {
                    if let Some(frame) = Frame::from_can(&frame) {
                        owner.handle_frame(now, &frame);
                    }
                }
                Err(nb::Error::WouldBlock) => break,
                Err(nb::Error::Other(error)) => self.report(owner, now, error)?,
            }
            owner.catch_up(now);
            self.send_nb(owner, can, now)?;
        }
        owner.catch_up(now);
        self.send_nb(owner, can, now)
    }

    /// Sends frames while the controller has room.
    ///
    /// # Errors
    /// As [`serve_nb`](Self::serve_nb).
    pub fn send_nb<C: embedded_can::nb::Can>(
        &mut self,
        owner: &mut impl Owner,
        can: &mut C,
        now: Instant,
    ) -> Result<(), C::Error> {
        while let Some(frame) = self.peek(owner, now).copied() {
            let thrown_out = match frame.to_can() {
                Some(as_theirs) => match can.transmit(&as_theirs) {
                    Ok(thrown_out) => thrown_out,
                    Err(nb::Error::WouldBlock) if self.has_higher(owner, now) => continue,
                    Err(nb::Error::WouldBlock) => break,
                    Err(nb::Error::Other(error)) => return Err(error),
                },
                // A frame that the controller cannot send does not delay the others.
                None => None,
            };
            let thrown_out = thrown_out.and_then(|frame| Frame::from_can(&frame));
            self.sent(&frame, thrown_out);
        }
        Ok(())
    }

    /// Waits for a frame, handles it and what is due, and sends all frames of the node. Use it
    /// where an interrupt shows that a frame was received, or in a thread that waits for frames.
    /// `clock` returns the time at which the frame was received.
    ///
    /// # Errors
    /// As [`serve_nb`](Self::serve_nb).
    pub fn serve_blocking<C: blocking::Can>(
        &mut self,
        owner: &mut impl Owner,
        can: &mut C,
        clock: impl FnOnce() -> Instant,
    ) -> Result<(), C::Error> {
        let received = can.receive();
        let now = clock();
        match received {
            Ok(frame) => {
                if let Some(frame) = Frame::from_can(&frame) {
                    owner.handle_frame(now, &frame);
                }
            }
            Err(error) => self.report(owner, now, error)?,
        }
        owner.catch_up(now);
        self.send_blocking(owner, can, now)
    }

    /// Sends all frames of the node.
    ///
    /// # Errors
    /// As [`serve_nb`](Self::serve_nb).
    pub fn send_blocking<C: blocking::Can>(
        &mut self,
        owner: &mut impl Owner,
        can: &mut C,
        now: Instant,
    ) -> Result<(), C::Error> {
        while let Some(frame) = self.peek(owner, now).copied() {
            if let Some(frame) = frame.to_can() {
                can.transmit(&frame)?;
            }
            self.sent(&frame, None);
        }
        Ok(())
    }

    fn report<E: embedded_can::Error>(
        &mut self,
        owner: &mut impl Owner,
        now: Instant,
        error: E,
    ) -> Result<(), E> {
        match error.kind() {
            ErrorKind::Overrun => owner.handle_bus(now, BusEvent::Overrun),
            _ => return Err(error),
        }
        Ok(())
    }
}

fn is_boot_up(frame: &Frame) -> bool {
    frame.id().raw() & 0x780 == 0x700 && frame.data() == [0]
}

/// Rank in arbitration, the highest priority first: 11 bits win over 29 bits that begin with the
/// same bits.
const fn rank(id: CanId) -> u32 {
    match id.as_standard() {
        Some(raw) => (raw as u32) << 19,
        None => (id.raw() >> 18) << 19 | 1 << 18 | id.raw() & 0x3_FFFF,
    }
}
