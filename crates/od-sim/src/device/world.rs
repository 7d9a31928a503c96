//! The world around a device: its shaft, its switches, its faults.

use std::prelude::v1::*;

use od_runtime::Instant;
use od_runtime::encoder::{Angle, Encoder, Fault};

use crate::device::VirtualDevice;
use crate::shaft::Shaft;

/// 2³², the fractions of a revolution.
const REVOLUTION: f64 = 4_294_967_296.0;

/// Position and speed of a shaft.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct ShaftView {
    /// Revolutions from the sensor's zero point.
    pub turns: f64,
    /// Revolutions per minute, positive clockwise.
    pub rpm: f64,
    /// The sensor's position in steps.
    pub raw: u64,
}

impl VirtualDevice {
    /// The encoder of the device, if it has one.
    pub fn encoder(&self) -> Option<&Encoder<Shaft>> {
        // The bench does not know the shaft of a real node.
        #[cfg(feature = "real")]
        if self.is_described() {
            return None;
        }
        self.node.application.encoder()
    }

    /// Changes something outside the bus, and tells the node. Returns whether the device has an encoder.
    fn change(&mut self, now: Instant, act: impl FnOnce(&mut Encoder<Shaft>)) -> bool {
        let Some(encoder) = self.node.application.encoder_mut() else {
            return false;
        };
        act(encoder);
        self.break_storage();
        self.noticed(now);
        true
    }

    /// Position and speed of the shaft, if the device has one.
    pub fn shaft(&self, now: Instant) -> Option<ShaftView> {
        let encoder = self.encoder()?;
        Some(ShaftView {
            turns: encoder.shaft.seen(now).fractions() as f64 / REVOLUTION,
            rpm: f64::from(encoder.shaft.milli_rpm_at(now)) / 1000.0,
            raw: encoder.shaft.raw(now, encoder.sensor()),
        })
    }

    /// The shaft as it is now, for devices that share it.
    pub(crate) fn shaft_now(&self) -> Option<Shaft> {
        Some(self.encoder()?.shaft.without_counter())
    }

    /// Takes over the angle and the speed of the shaft from another device on it.
    pub(crate) fn put_on_shaft(&mut self, shaft: &Shaft, now: Instant) {
        self.change(now, |encoder| encoder.shaft.follow(shaft));
    }

    /// Turns the shaft to the first angle at which the sensor reports `raw`; its speed stays. Positions that are
    /// set at least every 20 ms are a movement with a speed of its own. Returns whether the device has a shaft.
    pub fn set_position(&mut self, raw: u64, now: Instant) -> bool {
        self.change(now, |encoder| {
            encoder.shaft.set_raw(now, encoder.sensor(), raw);
        })
    }

    /// Turns the shaft by this number of revolutions; its speed stays. Returns whether the device has a shaft.
    pub fn turn(&mut self, turns: f64, now: Instant) -> bool {
        let by = Angle::from_fractions((turns * REVOLUTION) as i64);
        self.change(now, |encoder| encoder.shaft.turn(now, by))
    }

    /// Turns the shaft to this number of revolutions from the sensor's zero point; its speed stays. Returns whether the
    /// device has a shaft.
    pub fn turn_to(&mut self, turns: f64, now: Instant) -> bool {
        let to = Angle::from_fractions((turns * REVOLUTION) as i64);
        self.change(now, |encoder| {
            let by = to.minus(encoder.shaft.seen(now));
            encoder.shaft.turn(now, by);
        })
    }

    /// Lets the shaft turn with this speed from now on; positive is clockwise. Returns whether the device has a shaft.
    pub fn set_rpm(&mut self, rpm: f64, now: Instant) -> bool {
        // `as` limits a speed that is too high to the range, and makes 0 of NaN.
        self.change(now, |encoder| {
            encoder.shaft.set_milli_rpm(now, (rpm * 1000.0) as i32)
        })
    }

    /// Lets the shaft speed up or slow down evenly to this speed within `micros` microseconds,
    /// at most 4295 s. Returns whether the device has a shaft.
    pub fn ramp_to_rpm(&mut self, rpm: f64, micros: u64, now: Instant) -> bool {
        let micros = u32::try_from(micros).unwrap_or(u32::MAX);
        self.change(now, |encoder| {
            encoder.shaft.ramp_to(now, (rpm * 1000.0) as i32, micros)
        })
    }

    /// Sets the rotary switches of the node ID, 0–99; at 0 the node ID comes from the EEPROM. The device reads them
    /// at the next start.
    pub fn set_node_switch(&mut self, number: u8, now: Instant) {
        self.change(now, |encoder| {
            let mut switches = encoder.switches();
            switches.node_id = number.min(99);
            encoder.set_switches(switches);
        });
    }

    /// Sets the DIP switches of the bit rate, 0–7. The device reads them at the next start, and only if the rotary
    /// switches are not at 0.
    pub fn set_bitrate_switch(&mut self, number: u8, now: Instant) {
        self.change(now, |encoder| {
            let mut switches = encoder.switches();
            switches.bit_rate = number & 7;
            encoder.set_switches(switches);
        });
    }

    /// The switches: node ID and bit rate.
    pub fn switches(&self) -> (u8, u8) {
        let switches = self.encoder().map(Encoder::switches);
        switches.map_or((0, 0), |of| (of.node_id, of.bit_rate))
    }

    /// Sets or clears a fault, by a name of [`Fault::NAMES`]. Returns whether this
    /// device has such a fault.
    pub fn set_fault(&mut self, name: &str, broken: bool, now: Instant) -> bool {
        match Fault::from_name(name).filter(|fault| self.has_fault(*fault)) {
            Some(fault) => self.change(now, |encoder| encoder.set_fault(fault, broken)),
            None => false,
        }
    }

    /// Names of the faults that this device supports.
    pub fn faults(&self) -> Vec<&'static str> {
        let known = Fault::NAMES.iter();
        known
            .filter(|(fault, _)| self.has_fault(*fault))
            .map(|(_, name)| *name)
            .collect()
    }

    fn has_fault(&self, fault: Fault) -> bool {
        self.encoder().is_some_and(|encoder| {
            let mut reports = encoder.profile().reports.iter();
            reports.any(|report| report.fault == fault)
        })
    }

    /// Returns whether the host has set the fault of this name.
    pub fn is_broken(&self, name: &str) -> bool {
        match (self.encoder(), Fault::from_name(name)) {
            (Some(encoder), Some(fault)) => encoder.is_broken(fault),
            _ => false,
        }
    }

    /// The bit rate in kbit/s: the one that LSS has activated since the last start, otherwise that of the start. `None`
    /// for a device without a bit rate of its own.
    pub fn bit_rate(&self) -> Option<u16> {
        self.activated
            .or_else(|| self.encoder().and_then(Encoder::bit_rate))
    }

    /// Bit rate in kbit/s of a code of the object for the bit rate (2100h), or of an index of the LSS table if the device has
    /// no such object.
    pub(crate) fn bit_rate_of(&self, code: u8) -> Option<u16> {
        if self.profile().lss.is_some_and(|lss| lss.is_own()) {
            return od_wire::lss::kbit(code);
        }
        let rate = self
            .encoder()?
            .profile()
            .bit_rates
            .get(usize::from(code))
            .copied();
        rate.filter(|rate| *rate != 0)
    }

    /// Returns whether the device has to check its shaft every millisecond: the shaft turns, and its PDOs are sent when
    /// their values change.
    pub(crate) fn watches_shaft(&self) -> bool {
        let turns = |encoder: &Encoder<Shaft>| encoder.shaft.is_turning();
        self.profile().pdo.event_on_change && self.encoder().is_some_and(turns)
    }
}
