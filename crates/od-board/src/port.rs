//! A CAN controller of the `embedded-can` ecosystem, and the frames that wait for it.

use core::mem::swap;

use embedded_can::{ErrorKind, blocking};
use od_runtime::{BusEvent, Frame, Instant};
use od_wire::CanId;

use crate::owner::Owner;

/// Frames that can wait for the controller. While all of them wait, the node keeps its own.
const ROOM: usize = 4;

/// Frames that wait for a mailbox of the CAN controller, the one that wins arbitration first; frames
/// with the same CAN-ID keep their order.
///
/// A frame that an nb `transmit` throws out of its mailbox, to make room for one of higher priority,
/// comes back here and is sent later.
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
    /// A port where nothing waits.
    pub const fn new() -> Self {
        Self {
            frames: [Frame::standard(0, &[]); ROOM],
            len: 0,
        }
    }

    /// Returns whether no frame waits here; the node may have others.
    pub const fn is_empty(&self) -> bool {
        self.len == 0
    }

    /// Drops the frames that wait, as [`peek`](Self::peek) does while the owner knows of bus-off.
    pub const fn clear(&mut self) {
        self.len = 0;
    }

    /// Returns the frame to send next, without taking it: the controller may have no room. As long as
    /// there is room, frames go in the order of the node.
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

    /// The frames that wait, the first one to be sent next.
    fn waiting(&self) -> &[Frame] {
        self.frames.get(..self.len).unwrap_or_default()
    }

    /// The controller has no room for the frame that was [`peek`](Self::peek)ed. Returns whether the node
    /// has one of higher priority, for which it may have room. Nothing overtakes a boot-up message.
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

    /// The controller took a frame that was [`peek`](Self::peek)ed, and threw another one out for it or
    /// not.
    pub fn sent(&mut self, frame: &Frame, thrown_out: Option<Frame>) {
        if let Some(at) = self.waiting().iter().position(|other| other == frame) {
            // Those behind it move up.
            let mut behind = *frame;
            let from = self.frames.iter_mut().take(self.len).skip(at);
            from.rev().for_each(|room| swap(room, &mut behind));
            self.len -= 1;
        }
        if let Some(frame) = thrown_out {
            self.insert(frame, true);
        }
    }

    /// `before`: it is older than those with its CAN-ID.
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
        // Those behind it move back.
        let mut next = frame;
        let from = self.frames.iter_mut().take(self.len).skip(at);
        from.for_each(|room| swap(room, &mut next));
    }

    /// Handles all frames that came and what is due, and sends as long as there is room: for a loop,
    /// or an interrupt, that never waits.
    ///
    /// # Errors
    /// The first error of the controller. Call it again: no frame of the node is lost. An overrun is
    /// reported to the node, not here.
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

    /// Sends as long as the controller has room.
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
                // A controller that cannot send such a frame does not hold up the others.
                None => None,
            };
            let thrown_out = thrown_out.and_then(|frame| Frame::from_can(&frame));
            self.sent(&frame, thrown_out);
        }
        Ok(())
    }

    /// Waits for a frame, handles it and what is due by then, and sends all that the node has: where an
    /// interrupt says that a frame is there, or a thread of its own waits for it. `clock` returns the
    /// moment at which the frame is there.
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

    /// Sends all that the node has.
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

/// Rank in arbitration, the highest priority first: 11 bits win over 29 bits that begin alike.
const fn rank(id: CanId) -> u32 {
    match id.as_standard() {
        Some(raw) => (raw as u32) << 19,
        None => (id.raw() >> 18) << 19 | 1 << 18 | id.raw() & 0x3_FFFF,
    }
}
