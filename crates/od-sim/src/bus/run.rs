//! Lets time pass: which deadline is next, and how far the bus runs.

use std::prelude::v1::*;

use od_runtime::{BusEvent, Instant};

use super::{Bus, STUCK, Sent};

impl Bus {
    /// Lets time pass until `to`; deadlines before are met at their own time.
    pub fn advance(&mut self, to: Instant) {
        while self.step(to) {}
    }

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

    /// Lets time pass until no frame is being sent or waits, or until this time if there is always
    /// one.
    pub(crate) fn advance_until_quiet(&mut self, until: Instant) {
        while self.is_busy() && self.next_deadline().is_some_and(|at| at <= until) {
            self.advance_until_event();
        }
    }

    /// Lets time pass until the next event on the line or in a device; `false` if there will be
    /// none.
    pub(crate) fn advance_until_event(&mut self) -> bool {
        let Some(at) = self.next_deadline() else {
            return false;
        };
        self.step(at.max(self.now));
        true
    }

    /// The next deadline of any device, of a controller that recovers from bus-off, of a frame
    /// on a real line, or of the master.
    pub fn next_deadline(&self) -> Option<Instant> {
        let devices = (0..self.devices.len()).filter_map(|device| self.deadline(device));
        let controller = self.line.next_recovery().map(|(at, _)| at);
        devices
            .chain(controller)
            .chain(self.line.medium.due())
            .chain(self.master_due())
            .min()
    }

    /// Time when a device is due. A device with a frame to send waits until its controller has
    /// room.
    pub(super) fn deadline(&self, device: usize) -> Option<Instant> {
        let at = self.devices[device].poll_timeout()?;
        let waits = at <= self.now && self.line.is_real();
        (!waits || self.line.medium.has_room(device + 1)).then_some(at)
    }

    /// Meets the next deadline up to `to`, and returns `true`; without one the time becomes `to`.
    fn step(&mut self, to: Instant) -> bool {
        let goes_on = self.meet_next(to);
        self.follow_wires();
        self.run_master();
        goes_on
    }

    /// As `step`, without the effects over wires and those on the master.
    fn meet_next(&mut self, to: Instant) -> bool {
        let due = (0..self.devices.len())
            .filter_map(|device| Some((self.deadline(device)?, device)))
            .min();
        // `run_master` does the work of the master at this moment.
        if let Some(at) = self.master_due()
            && at <= to
            && due.is_none_or(|(first, _)| at < first)
            && self.line.medium.due().is_none_or(|first| at < first)
        {
            self.now = self.now.max(at);
            return true;
        }
        if let Some(at) = self.line.medium.due()
            && at <= to
            && due.is_none_or(|(first, _)| at <= first)
        {
            self.now = self.now.max(at);
            self.run_line();
            return true;
        }
        if let Some((at, device)) = self.line.next_recovery()
            && at <= to
            && due.is_none_or(|(first, _)| at < first)
        {
            self.now = self.now.max(at);
            self.recover(device);
            return true;
        }
        let Some((at, device)) = due.filter(|(at, _)| *at <= to) else {
            self.now = self.now.max(to);
            return false;
        };
        self.now = self.now.max(at);
        self.meet(device, 0, to)
    }

    /// Meets the deadlines of a device at this time; `met` were met already. Returns whether the
    /// time is not after `to`.
    fn meet(&mut self, device: usize, met: u32, to: Instant) -> bool {
        for _ in met..STUCK {
            self.devices[device].handle_timeout(self.now);
            self.pass_on(device);
            self.report_controllers();
            match self.deadline(device) {
                Some(again) if again <= self.now => {}
                _ => return true,
            }
        }
        self.now = self.now.plus_micros(1);
        self.now <= to
    }

    /// The bus was recessive for long enough after bus-off: a device that restarts its controller
    /// returns, any other stays off the bus.
    fn recover(&mut self, device: usize) {
        let begins = self.devices.get_mut(device).is_some_and(|one| {
            one.handle_bus(BusEvent::Active, self.now);
            !one.is_bus_off()
        });
        self.line.recover(device, begins);
        if begins {
            self.pass_on(device);
            self.report_controllers();
        }
    }

    /// Meets many deadlines at once for the only device on an ideal line. Returns the same as
    /// `step`; `None` if there are other devices, or an observer waits for frames.
    fn run_alone(&mut self, to: Instant, frames: usize) -> Option<bool> {
        if self.has_master() {
            return None;
        }
        let Self {
            devices,
            rate,
            wires,
            line,
            sent,
            now,
            ..
        } = self;
        let [device] = devices.as_mut_slice() else {
            return None;
        };
        let reaches_outside = rate.is_none() && line.is_plugged(0) && line.is_plugged(1);
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
