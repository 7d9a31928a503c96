//! Properties of an encoder family, as const data.

use core::mem::discriminant;

use od_model::{Address, DataType, Dictionary, Literal};

use super::fault::{Fault, Report};
use super::object::{Movement, Role};
use super::position::Sensor;
use od_wire::AbortCode;

/// Unit of object 6502h.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Total {
    /// Steps in all, the whole measuring range.
    Steps,
    /// Revolutions (CiA 406).
    Revolutions,
    /// Revolutions of the range that is shown: 6502h follows 6002h / 6001h, rounded down.
    Shown,
}

/// Counting of revolutions beyond the range of the sensor, and without power.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Counter {
    /// Counts without limit while powered; without power whole ranges of the sensor are lost. A
    /// range of more revolutions than the sensor's starts again at 0 where the sensor does.
    Sensor,
    /// Counts without limit while powered. Without power it follows up to `turns / 2` revolutions
    /// either way; beyond that the position is off by a multiple of `turns`.
    Kept {
        /// Revolutions that the counter tells apart.
        turns: u32,
    },
    /// Counts without limit while powered; each start begins within the first revolution.
    Volatile,
}

/// Values that 6002h accepts, besides the limits of the dictionary.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum RangeRule {
    /// 1 to what the sensor tells apart in all; above is 06090031h.
    Sensor,
    /// 6001h times a power of two, and 0 if that means 2³²; else 06090030h.
    PowerOfTwo,
    /// At most 6001h times the sensor's revolutions; above is 06090031h. Only a write of
    /// 6002h is checked, so that 6001h first and 6002h second always works.
    Turns,
}

/// An electronic gear: numerator and denominator at sub-indices 2 and 3 of an object.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct Gear {
    /// Index of the object.
    pub index: u16,
    /// Value of sub-index 1 that switches it on.
    pub on: u8,
    /// Value that it divides.
    pub kind: GearKind,
}

/// Effect of a gear.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum GearKind {
    /// The position is that of the encoder divided by the factor, modulo the same range. A
    /// gear that is in the store at a start (power-on, NMT reset node) acts from then on.
    Position,
    /// 6002h is one revolution of the output, which is as many of the encoder as the factor
    /// says. It acts at once; 6001h shows steps per revolution of the encoder, rounded down,
    /// and writing it changes nothing. A new gear is a new resolution: the offset is cleared.
    Output,
}

/// An object of manufacturer options whose bits change the encoder (2110h).
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct Options {
    /// Index of the object.
    pub index: u16,
    /// Bits that make the offset survive a new resolution.
    pub keep_offset: u32,
    /// Bits that make 1800h:05 later than 6200h.
    pub delay_timer: u32,
    /// By how much, in milliseconds.
    pub delay_ms: u16,
    /// Bits that keep the sense of rotation (6000h) out of speed and acceleration.
    pub ignore_sense: u32,
}

impl Options {
    /// No bit means anything; for `..Options::NONE`.
    pub const NONE: Self = Self {
        index: 0x2110,
        keep_offset: 0,
        delay_timer: 0,
        delay_ms: 0,
        ignore_sense: 0,
    };
}

/// Number of movements that a profile can have.
pub(super) const MOVEMENTS: usize = 4;

/// Properties of an encoder family besides its dictionary.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct EncoderProfile {
    /// The sensor; `None`: 6501h and 6502h describe it.
    pub sensor: Option<Sensor>,
    /// Steps per revolution with scaling off; `None`: the sensor's.
    pub unscaled_steps: Option<u32>,
    /// Counting of revolutions.
    pub counter: Counter,
    /// Unit of 6502h.
    pub total: Total,
    /// Values that 6002h accepts.
    pub range_rule: RangeRule,
    /// 6509h is signed (CiA 406), else modulo the range.
    pub signed_offset: bool,
    /// 6002h = 0 means 2³².
    pub zero_is_full: bool,
    /// Bits of 6000h that 6500h shows.
    pub operating_bits: u16,
    /// The electronic gear.
    pub gear: Option<Gear>,
    /// Objects with a role; at most 4 of them are a movement.
    pub objects: &'static [(Address, Role)],
    /// Pairs of objects with one value: a write to one changes the other. After a start the
    /// saved value of the pair applies, the first one if both are saved.
    pub links: &'static [(Address, Address)],
    /// Answer to a value below its lower limit.
    pub below_limit: AbortCode,
    /// Manufacturer options.
    pub options: Option<Options>,
    /// Bit rates by the codes of the object for the bit rate ([`Role::BitRate`]), in kbit/s; 0
    /// where a code has none.
    pub bit_rates: &'static [u16],
    /// Bit rates by the DIP switches, in kbit/s; at 0 the object decides. A device without
    /// any has no switches for the node ID either.
    pub switch_rates: &'static [u16],
    /// Reports of faults; at most 31.
    pub reports: &'static [Report],
    /// A report exists only where 6504h and 6506h have its bits (by them, variants differ);
    /// else all do.
    pub by_support: bool,
}

impl EncoderProfile {
    /// Report of a position that is not valid (CiA 406: bit 0 of 6503h). A sensor that fails is
    /// reported so if the family has no alarm for the fault.
    pub const NO_ANGLE: Report = Report {
        code: 0x7320,
        register: 0x01,
        alarm: 0x0001,
        ..Report::BASE
    };

    /// Returns the profile of an encoder of an unknown family, by its dictionary; `None` if the
    /// device is not an encoder. An encoder has a position: 6004h is an UNSIGNED32 that no
    /// master can write, and 1000h, if it declares anything, declares CiA 406.
    ///
    /// 6501h and 6502h describe its sensor. 6502h counts revolutions as CiA 406 has it,
    /// unless it has the default value of 6002h: then both are steps.
    pub fn for_dictionary(dictionary: Dictionary<'_>) -> Option<&'static Self> {
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
        Some(if in_steps { &STEPS } else { &Self::CIA406 })
    }

    /// Returns the role of an object.
    pub fn role(&self, address: Address) -> Option<&'static Role> {
        let mut objects = self.objects.iter();
        let found = objects.find(|(at, _)| *at == address);
        found.map(|(_, role)| role)
    }

    /// Returns the first object with a role, whatever that holds.
    pub fn object(&self, role: Role) -> Option<Address> {
        let kind = discriminant(&role);
        let mut objects = self.objects.iter();
        let found = objects.find(|(_, role)| discriminant(role) == kind);
        found.map(|(at, _)| *at)
    }

    /// Returns the speeds and accelerations with their addresses.
    pub fn movements(&self) -> impl Iterator<Item = (Address, &'static Movement)> + use<> {
        let objects = self.objects.iter();
        objects.filter_map(|(at, role)| match role {
            Role::Movement(movement) => Some((*at, movement)),
            _ => None,
        })
    }

    /// Returns the sensor that the profile or, by its default values, a dictionary describes.
    pub fn sensor_of(&self, dictionary: Dictionary<'_>) -> Sensor {
        self.sensor_by(default_of(dictionary))
    }

    /// Returns the sensor that the numbers at 6001h, 6002h, 6501h and 6502h describe.
    pub(super) fn sensor_by(&self, number: impl Fn(u16) -> Option<u64>) -> Sensor {
        if let Some(sensor) = self.sensor {
            return sensor;
        }
        let some = |index| number(index).filter(|number| *number > 0);
        let steps = some(0x6501).or_else(|| some(0x6001)).unwrap_or(0x2000);
        let total = some(0x6502).unwrap_or(1);
        let turns = match self.total {
            Total::Steps => total.checked_div(steps).unwrap_or(total),
            Total::Revolutions | Total::Shown => total,
        };
        Sensor {
            steps: u32::try_from(steps).unwrap_or(u32::MAX),
            turns: u32::try_from(turns.max(1)).unwrap_or(u32::MAX),
        }
    }

    /// CiA 406 to the letter: the profile of an encoder of an unknown EDS.
    pub const CIA406: Self = Self {
        sensor: None,
        unscaled_steps: None,
        counter: Counter::Sensor,
        total: Total::Revolutions,
        range_rule: RangeRule::Sensor,
        signed_offset: true,
        zero_is_full: false,
        operating_bits: 0x0005,
        gear: None,
        objects: &[(Address::new(0x6508, 0), Role::TenthHoursSinceStart)],
        links: &[],
        below_limit: AbortCode::ValueTooLow,
        options: None,
        bit_rates: &[],
        switch_rates: &[],
        reports: &[
            Self::NO_ANGLE,
            Report {
                fault: Fault::Battery,
                code: 0xFF00,
                register: 0x81,
                warning: 0x0010,
                ..Report::BASE
            },
            Report {
                fault: Fault::Watchdog,
                code: 0x6010,
                register: 0x01,
                warning: 0x0004,
                ..Report::BASE
            },
            Report {
                fault: Fault::Memory,
                code: 0x5530,
                register: 0x01,
                ..Report::BASE
            },
        ],
        by_support: true,
    };
}

/// Number of the profile in the low half of 1000h.
const CIA406: u64 = 406;

/// Default values by index.
fn default_of(dictionary: Dictionary<'_>) -> impl Fn(u16) -> Option<u64> {
    move |index| {
        let entry = dictionary.entry(index, 0)?;
        match entry.default {
            Literal::Signed(..0) => None,
            default => default.bits(1),
        }
    }
}
