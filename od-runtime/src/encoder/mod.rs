//! A simulated absolute encoder (CiA 406): shaft, sensor, scaling, and the objects around them.
//!
//! The arithmetic is pure functions ([`Shaft`], [`Sensor`], [`Scale`]). [`Encoder`] ties
//! them to a dictionary by address: any that has 6004h will do. What a family does
//! differently stands in an [`EncoderProfile`].

mod application;
mod fault;
mod faults;
mod position;
mod profile;
mod shaft;

use od_model::typed::{Ro, Var};
use od_model::{Address, DataType, Dictionary};

use crate::{Instant, Store};

pub use fault::{Appears, Fault, Report, Until};
use faults::Faults;
pub use position::{Scale, Sensor};
pub use profile::{
    Counter, EncoderProfile, Gear, GearKind, Injection, Mirror, Movement, OperatingTime, Options,
    Quantity, RangeRule, Source, Total,
};
pub use shaft::{Angle, Shaft};

/// Rotary and DIP switches in the cover.
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug, Default)]
pub struct Switches {
    /// Node ID, 1–99; 0 leaves node ID and bit rate to the objects.
    pub node_id: u8,
    /// Position of the DIP switches for the bit rate, 0–7.
    pub bit_rate: u8,
}

/// The device behind an encoder's dictionary.
///
/// The host turns the [`Shaft`], sets switches and breaks things between calls of the
/// node; after a change of faults it calls `Node::handle_change`.
#[derive(Clone, Debug)]
pub struct Encoder {
    profile: &'static EncoderProfile,
    /// The shaft that it sits on.
    pub shaft: Shaft,
    switches: Switches,
    serial_number: Option<u32>,
    faults: Faults,
    sensor: Sensor,
    scale: Scale,
    /// 6004h, where it stands in the store.
    position: Option<Var<u32, Ro>>,
    /// Where the shaft stood when power went.
    off: Option<Angle>,
    /// What the shaft turned without power and the revolution counter did not see.
    unseen: Angle,
    /// The last reset; `None` without power.
    started: Option<Instant>,
    /// Periods of operation since, at whose end its time was saved.
    kept: u64,
    /// Seconds of operation before `started`.
    seconds: u32,
    /// 6200h as it was when it last agreed with 1800h:05.
    timer: u64,
    bit_rate: Option<u16>,
}

impl Encoder {
    /// An encoder at angle 0, nothing broken, switches at 0.
    pub const fn new(profile: &'static EncoderProfile) -> Self {
        let sensor = match profile.sensor {
            Some(sensor) => sensor,
            None => Sensor { steps: 1, turns: 1 },
        };
        Self {
            profile,
            shaft: Shaft::at_rest(Angle::ZERO),
            switches: Switches {
                node_id: 0,
                bit_rate: 0,
            },
            serial_number: None,
            faults: Faults::new(),
            sensor,
            scale: Scale::unscaled(sensor),
            position: None,
            off: None,
            unseen: Angle::ZERO,
            started: None,
            kept: 0,
            seconds: 0,
            timer: 0,
            bit_rate: None,
        }
    }

    /// An encoder of an unknown family for a dictionary that has a position (6004h);
    /// `None` for every other device. 6004h is a position where it is an UNSIGNED32 that no
    /// master can write, and 1000h, if it says anything, says CiA 406.
    ///
    /// 6501h and 6502h describe its sensor. 6502h counts revolutions as CiA 406 has it,
    /// unless it is what 6002h is by default: then both are steps.
    pub fn for_dictionary(dictionary: Dictionary<'_>) -> Option<Self> {
        static STEPS: EncoderProfile = EncoderProfile {
            total: Total::Steps,
            ..EncoderProfile::CIA406
        };
        let position = dictionary.entry(0x6004, 0)?;
        let number = default_of(dictionary);
        let is_other = number(0x1000).is_some_and(|kind| kind & 0xFFFF != CIA406);
        if position.data_type != DataType::Unsigned32 || position.access.writable() || is_other {
            return None;
        }
        let in_steps = number(0x6502).is_some_and(|total| number(0x6002) == Some(total));
        let profile = if in_steps {
            &STEPS
        } else {
            &EncoderProfile::CIA406
        };
        Some(Self::new(profile).with_sensor_of(dictionary))
    }

    /// With the sensor that a dictionary's defaults describe, where the profile has none:
    /// [`set_raw_position`](Self::set_raw_position) can be used before the first power-on.
    #[must_use]
    pub fn with_sensor_of(mut self, dictionary: Dictionary<'_>) -> Self {
        self.sensor = self.sensor_of(default_of(dictionary));
        self
    }

    /// What its family does differently.
    pub const fn profile(&self) -> &'static EncoderProfile {
        self.profile
    }

    /// With this serial number in 1018h:04 and 650Bh from the next reset on.
    #[must_use]
    pub const fn with_serial_number(mut self, serial_number: u32) -> Self {
        self.serial_number = Some(serial_number);
        self
    }

    /// What its sensor tells apart; known after [`with_sensor_of`](Self::with_sensor_of) or the
    /// first power-on.
    pub const fn sensor(&self) -> Sensor {
        self.sensor
    }

    /// How its position is made at present.
    pub const fn scale(&self) -> Scale {
        self.scale
    }

    /// The angle that the electronics know: the shaft's, without whole ranges of the
    /// sensor that it turned while there was no power.
    #[inline]
    pub fn angle(&self, now: Instant) -> Angle {
        self.shaft.angle(now).minus(self.unseen)
    }

    /// The position as 6004h has it.
    #[inline]
    pub fn position(&self, now: Instant) -> u32 {
        self.scale.position(self.angle(now))
    }

    /// The sensor's own position, before scaling, sense and offset.
    pub fn raw_position(&self, now: Instant) -> u64 {
        self.sensor.raw(self.angle(now))
    }

    /// Puts the shaft where the sensor begins to say `raw`; it goes on with its speed.
    ///
    /// It has to be known what the [`sensor`](Self::sensor) is.
    pub fn set_raw_position(&mut self, now: Instant, raw: u64) {
        self.unseen = Angle::ZERO;
        self.shaft.set_angle(now, self.sensor.angle(raw));
    }

    /// The switches.
    pub const fn switches(&self) -> Switches {
        self.switches
    }

    /// Sets the switches; they are read at power-on and at reset node.
    pub fn set_switches(&mut self, switches: Switches) {
        self.switches = switches;
    }

    /// Breaks something, or repairs it. [`Fault::Watchdog`] is seen after the next reset.
    pub fn set_fault(&mut self, fault: Fault, broken: bool) {
        self.faults.set(fault, broken);
    }

    /// Is it broken?
    pub fn is_broken(&self, fault: Fault) -> bool {
        self.faults.is_set(fault)
    }

    /// The bit rate since the last start, in kbit/s, if the device has one of its own.
    pub const fn bit_rate(&self) -> Option<u16> {
        self.bit_rate
    }

    /// Power goes. The shaft may turn on; a counter that misses a crossing of its zero
    /// does not know of it, which shows where the revolutions are no power of two.
    pub fn power_off(&mut self, now: Instant) {
        self.seconds = self.seconds_at(now);
        self.started = None;
        self.off = Some(self.angle(now));
    }

    /// Seconds of operation, up to `now`.
    fn seconds_at(&self, now: Instant) -> u32 {
        let seconds = self.micros(now) / 1_000_000;
        self.seconds
            .saturating_add(u32::try_from(seconds).unwrap_or(u32::MAX))
    }

    /// Microseconds since the last reset.
    fn micros(&self, now: Instant) -> u64 {
        self.started.map_or(0, |started| now.micros_since(started))
    }

    fn sensor_of(&self, number: impl Fn(u16) -> Option<u64>) -> Sensor {
        if let Some(sensor) = self.profile.sensor {
            return sensor;
        }
        let some = |index| number(index).filter(|number| *number > 0);
        let steps = some(0x6501).or_else(|| some(0x6001)).unwrap_or(0x2000);
        let total = some(0x6502).unwrap_or(1);
        let turns = match self.profile.total {
            Total::Steps => total / steps,
            Total::Revolutions | Total::Shown => total,
        };
        Sensor {
            steps: u32::try_from(steps).unwrap_or(u32::MAX),
            turns: u32::try_from(turns.max(1)).unwrap_or(u32::MAX),
        }
    }

    /// The largest range that 6002h can take.
    fn most(&self) -> u64 {
        self.sensor.range()
    }

    /// Power is back: what the revolution counter makes of where the shaft is now.
    fn wake_up(&mut self, now: Instant) {
        let Some(off) = self.off.take() else {
            return;
        };
        let on = self.angle(now);
        let range = i128::from(self.sensor.turns) << 32;
        let laps = |angle: Angle| i128::from(angle.fractions()).div_euclid(range);
        // Whole ranges that fit into the angle fit into its difference.
        let unseen = ((laps(on) - laps(off)) * range) as i64;
        self.unseen = self.unseen.plus(Angle::from_fractions(unseen));
    }

    /// The rule of the objects for the position; also 6500h, which shows 6000h.
    fn configure(&mut self, store: &mut Store<'_>) {
        self.sensor = self.sensor_of(|index| store.try_unsigned(index, 0));
        let operating = store.try_unsigned(0x6000, 0).unwrap_or(SCALING);
        let scale = if operating & SCALING != 0 {
            let steps = store.try_unsigned(0x6001, 0).unwrap_or(0);
            let steps = if steps == 0 {
                self.sensor.steps.into()
            } else {
                steps
            };
            let range = match store.try_unsigned(0x6002, 0) {
                Some(0) if self.profile.zero_is_full => 1 << 32,
                Some(0) | None => self.most(),
                Some(range) => range,
            };
            Scale::new(self.sensor, u32::try_from(steps).unwrap_or(u32::MAX), range)
        } else {
            Scale::unscaled(self.sensor)
        };
        let offset = store.unsigned(0x6509, 0);
        let offset = if self.profile.signed_offset {
            // An INTEGER32 comes as its 32 bits or with its sign.
            i64::from(offset as u32 as i32)
        } else {
            i64::from(offset as u32)
        };
        self.scale = scale
            .with_sense(operating & REVERSED != 0)
            .with_offset(offset);
        let shown = operating & u64::from(self.profile.operating_bits);
        store.set_unsigned(Address::new(0x6500, 0), shown);
    }
}

/// Default values by index.
fn default_of(dictionary: Dictionary<'_>) -> impl Fn(u16) -> Option<u64> {
    move |index| {
        let entry = dictionary.entry(index, 0)?;
        u64::try_from(entry.default.integer(1)?).ok()
    }
}

/// What 1000h says of a CiA 406 device in its low half.
const CIA406: u64 = 406;

/// Bits of 6000h.
const REVERSED: u64 = 1 << 0;
const SCALING: u64 = 1 << 2;

#[cfg(test)]
mod tests;
