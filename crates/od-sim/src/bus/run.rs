//! Lets time pass until frames are sent, one after the other or many at once.

use std::prelude::v1::*;

use od_runtime::Instant;

use super::{Bus, Sent};

impl Bus {
    /// Lets time pass until a frame is sent, but not beyond `to`. Returns whether one was sent; if
    /// not, the time is `to`.
    pub fn advance_until_sent(&mut self, to: Instant) -> bool {
        self.advance_until_full(to, 1)
    }

    /// As [`advance_until_sent`](Self::advance_until_sent), until this number of frames can be
    /// [polled](Self::poll).
    pub(crate) fn advance_until_full(&mut self, to: Instant, frames: usize) -> bool {
        while self.sent.len() < frames {
            let goes_on = match self.run_alone(to, frames) {
                Some(goes_on) => goes_on,
                None => self.step(to),
            };
            if !goes_on {
                return !self.sent.is_empty();
            }
        }
        true
    }

    /// Meets many deadlines at once for the only device on an ideal line. Returns the same as
    /// `step`; `None` if there are other devices, or an observer waits for frames.
    fn run_alone(&mut self, to: Instant, frames: usize) -> Option<bool> {
        if self.has_master() {
            return None;
        }
        let Self {
            devices,
            wiring,
            wires,
            line,
            sent,
            now,
            ..
        } = self;
        let [device] = devices.as_mut_slice() else {
            return None;
        };
        let reaches_outside = wiring.rate.is_none() && line.is_plugged(0) && line.is_plugged(1);
        if !wires.is_empty() || line.is_real() || !reaches_outside || line.has_plans() {
            return None;
        }
        let wanted = frames.saturating_sub(sent.len());
        let again = device.run(now, to, wanted, |at, frame| {
            sent.push_back(Sent {
                at,
                device: Some(0),
                frame,
            });
        })?;
        // The time stays that of the last frame, even if the device has nothing to do until `to`.
        if self.sent.len() >= frames {
            return Some(true);
        }
        match self.deadline(0) {
            Some(at) if at <= self.now && again => Some(self.meet(0, 1, to)),
            Some(at) if at <= to => Some(true),
            _ => {
                self.now = self.now.max(to);
                Some(false)
            }
        }
    }

    /// All frames of devices, oldest first.
    pub(crate) fn poll_all(&mut self) -> impl Iterator<Item = Sent> + '_ {
        self.sent.drain(..)
    }
}

#[cfg(test)]
mod tests {
    use od_runtime::{Frame, NodeId};

    use super::*;
    use crate::device::VirtualDevice;

    /// A gxmm that turns, with a heartbeat and a PDO every 7 ms, with and without an observer.
    fn bus(is_watched: bool) -> Option<Bus> {
        let kind = od_devices::find("gxmm")?;
        let mut bus = Bus::new();
        let device = bus.add(VirtualDevice::new(kind, NodeId::ONE).delivered());
        bus.start(device);
        bus.with(device, |device, now| {
            device.set_rpm(61.5, now);
            // More bytes than it will ever write.
            !is_watched || device.cut_power_after(1 << 30)
        })?;
        for (index, value) in [(0x1800u16, 7), (0x1017, 25)] {
            let [low, high] = index.to_le_bytes();
            let sub = if index == 0x1800 { 5 } else { 0 };
            bus.receive(&Frame::standard(
                0x601,
                &[0x2B, low, high, sub, value, 0, 0, 0],
            ));
        }
        bus.receive(&Frame::standard(0, &[1, 1]));
        Some(bus)
    }

    /// Time continues from the frame, even if the device has no deadline before the end.
    #[test]
    fn the_time_is_that_of_the_awaited_frame() {
        let mut bus = bus(false).expect("a device");
        for (index, sub) in [(0x1800u16, 5), (0x1017, 0)] {
            let [low, high] = index.to_le_bytes();
            bus.receive(&Frame::standard(0x601, &[0x2B, low, high, sub, 0, 0, 0, 0]));
        }
        bus.poll_all().for_each(drop);
        // A heartbeat in 30 ms, and none within 20 ms after it.
        bus.receive(&Frame::standard(0x601, &[0x2B, 0x17, 0x10, 0, 30, 0, 0, 0]));
        bus.poll_all().for_each(drop);
        let begin = bus.now();
        assert!(bus.advance_until_sent(begin.plus_millis(50)));
        assert_eq!(bus.now(), bus.poll().expect("a frame").at);
    }

    #[test]
    fn many_deadlines_at_once_give_the_same_as_one_by_one() {
        let (mut one, mut other) = (bus(false).expect("a device"), bus(true).expect("a device"));
        let end = Instant::from_millis(2_000);
        let (mut at_once, mut step_by_step) = (Vec::new(), Vec::new());
        while one.advance_until_full(end, 100) && one.now() < end {
            assert!(one.sent.len() >= 100 || one.now() == end);
            at_once.extend(one.poll_all());
        }
        at_once.extend(one.poll_all());
        while other.advance_until_sent(end) {
            step_by_step.extend(other.poll_all());
        }
        assert!(at_once.len() > 350, "{}", at_once.len());
        assert_eq!(at_once, step_by_step);
        assert_eq!((one.now(), other.now()), (end, end));
    }
}
