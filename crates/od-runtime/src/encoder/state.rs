//! The encoder: its state, and what a host can do with it.

use core::marker::PhantomData;

use od_model::{Address, Dictionary};

use super::faults::Faults;
use super::motion::{Gain, Motion};
use super::position::{Angle, Scale, Sensor};
use super::profile::{AnyFamily, EncoderProfile, Family, MOVEMENTS, Parts, Role, Total};
use super::report::Fault;
use od_wire::Instant;

/// Rotary and DIP switches in the cover.
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug, Default)]
pub struct Switches {
    /// Node ID, 1–99; 0 leaves node ID and bit rate to the objects.
    pub node_id: u8,
    /// Position of the DIP switches for the bit rate, 0–7.
    pub bit_rate: u8,
}

/// The behaviour of an encoder: the application of its node.
///
/// The host sets switches and reports faults between calls of the node; after a change of
/// faults it calls [`Node::handle_change`](crate::Node::handle_change).
///
/// `F` is what the compiler knows of the family: an encoder of a [`Family`] has no code for roles
/// of objects that the family does not have.
#[derive(Clone, Debug)]
pub struct Encoder<M, F = AnyFamily> {
    family: PhantomData<F>,
    profile: &'static EncoderProfile,
    /// Shaft that the encoder sits on.
    pub shaft: M,
    pub(super) switches: Switches,
    pub(super) serial_number: Option<u32>,
    pub(super) faults: Faults,
    pub(super) sensor: Sensor,
    pub(super) scale: Scale,
    /// Steps of 6004h per revolution, without a gear that divides the position.
    pub(super) gain: Gain,
    /// Numerator and denominator of a [`GearKind::Position`](super::GearKind::Position), from the
    /// last start.
    pub(super) gear: Option<(u64, u64)>,
    /// Numerator and denominator of a [`GearKind::Output`](super::GearKind::Output) that is on.
    pub(super) output: Option<(u64, u64)>,
    /// 6001h as it was when `output` was switched on; the object shows the value of the gear.
    pub(super) own_steps: u64,
    /// Last angle that the sensor delivered.
    pub(super) angle: Angle,
    /// Time of the last power-off.
    pub(super) off: Option<Instant>,
    /// Time of the last start; `None` without power.
    pub(super) started: Option<Instant>,
    /// Time of the next save of the operating time; `None`: the family does not save it.
    pub(super) keep_at: Option<Instant>,
    /// Seconds of operation before `started`.
    pub(super) seconds: u32,
    /// Number of power-on cycles.
    pub(super) cycles: u32,
    /// Start of the measurement of each movement of the profile.
    pub(super) measured_since: [Instant; MOVEMENTS],
    /// 6200h when it last agreed with 1800h:05.
    pub(super) timer: u64,
    pub(super) bit_rate: Option<u16>,
}

impl<M: Motion> Encoder<M> {
    /// Encoder on a shaft, without faults, switches at 0.
    pub const fn new(profile: &'static EncoderProfile, shaft: M) -> Self {
        Self::with_profile(profile, shaft)
    }
}

impl<M: Motion, F: Family> Encoder<M, F> {
    /// As [`new`](Encoder::new), of a family whose profile is known at compile time; any other
    /// family does not compile.
    pub const fn of_family(shaft: M) -> Self {
        Self::with_profile(
            const { F::PROFILE.expect("the family has no PROFILE") },
            shaft,
        )
    }

    const fn with_profile(profile: &'static EncoderProfile, shaft: M) -> Self {
        let sensor = match profile.sensor {
            Some(sensor) => sensor,
            None => Sensor { steps: 1, turns: 1 },
        };
        Self {
            family: PhantomData,
            profile,
            shaft,
            switches: Switches {
                node_id: 0,
                bit_rate: 0,
            },
            serial_number: None,
            faults: Faults::new(),
            sensor,
            scale: Scale::unscaled(sensor),
            gain: Gain::steps(0),
            gear: None,
            output: None,
            own_steps: 0,
            angle: Angle::ZERO,
            off: None,
            started: None,
            keep_at: None,
            seconds: 0,
            cycles: 0,
            measured_since: [Instant::ZERO; MOVEMENTS],
            timer: 0,
            bit_rate: None,
        }
    }

    /// Sets the sensor that the profile or the default values of a dictionary describe, so that
    /// [`sensor`](Self::sensor) is known before the first power-on.
    #[must_use]
    pub fn with_sensor_of(mut self, dictionary: Dictionary<'_>) -> Self {
        self.sensor = self.profile().sensor_of(dictionary);
        self
    }

    /// Returns the properties of the family.
    pub const fn profile(&self) -> &'static EncoderProfile {
        match F::PROFILE {
            Some(profile) => profile,
            None => self.profile,
        }
    }

    /// Roles that objects of the family may have.
    pub(super) const PARTS: Parts = Parts::of::<F>();

    /// Sets the serial number, which 1018h:04 and 650Bh show from the next reset on (CiA 406, object 650Bh).
    #[must_use]
    pub const fn with_serial_number(mut self, serial_number: u32) -> Self {
        self.serial_number = Some(serial_number);
        self
    }

    /// Returns the serial number that [`with_serial_number`](Self::with_serial_number) set.
    pub const fn serial_number(&self) -> Option<u32> {
        self.serial_number
    }

    /// Returns resolution and range of the sensor, known after
    /// [`with_sensor_of`](Self::with_sensor_of) or the first power-on.
    pub const fn sensor(&self) -> Sensor {
        self.sensor
    }

    /// Returns the present scaling of the position.
    pub const fn scale(&self) -> Scale {
        self.scale
    }

    /// Returns the switches; a family without switches ignores them.
    pub const fn switches(&self) -> Switches {
        self.switches
    }

    /// Sets the switches; they are read at power-on and at reset node.
    pub fn set_switches(&mut self, switches: Switches) {
        self.switches = switches;
    }

    /// Sets a fault, or ends it. [`Fault::Watchdog`] is reported after the next reset.
    pub fn set_fault(&mut self, fault: Fault, broken: bool) {
        self.faults.set(fault, broken);
    }

    /// Returns whether the host has set this fault.
    pub fn is_broken(&self, fault: Fault) -> bool {
        self.faults.is_set(fault)
    }

    /// Returns whether the encoder computes the value of an object from shaft, time, faults or
    /// other objects.
    pub fn computes(&self, address: Address) -> bool {
        let profile = self.profile();
        let role = profile.role(address);
        let mut counters = profile.reports.iter().filter_map(|report| report.counter);
        matches!(address.index, 0x6004 | 0x6500 | 0x6503 | 0x6505 | 0x6509)
            || address.index == 0x6502 && profile.total == Total::Shown
            || role.is_some_and(|role| role.is_live() || *role == Role::Cycles)
            || counters.any(|counter| counter == address)
    }

    /// Returns the bit rate since the last start, in kbit/s; `None`: switches and objects give none.
    pub const fn bit_rate(&self) -> Option<u16> {
        self.bit_rate
    }
}
