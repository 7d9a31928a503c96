//! Properties of an encoder family, as const data: what differs from CiA 406 and from other
//! families, and the roles of the family's objects.

use core::mem::discriminant;

use od_model::{Address, DataType, Dictionary, Literal};

use super::position::Sensor;
use super::report::{Fault, Report};
use od_wire::AbortCode;

/// Unit of object 6502h (MANUALS.md C-X-01).
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Total {
    /// Total number of steps: the whole measuring range.
    Steps,
    /// Revolutions (CiA 406).
    Revolutions,
    /// Revolutions of the range that is shown: 6502h is 6002h / 6001h, rounded down (MANUALS.md
    /// C-EAM-17).
    Shown,
}

/// Counting of revolutions beyond the range of the sensor, and without power.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Counter {
    /// Counts without limit while powered; without power, whole ranges of the sensor are lost. If
    /// 6002h has more revolutions than the sensor, the position starts again at 0 where the sensor
    /// does.
    Sensor,
    /// Counts without limit while powered. Without power it follows up to `turns / 2` revolutions
    /// either way (MANUALS.md C-EN-26); beyond that the position is off by a multiple of `turns`.
    Kept {
        /// Number of revolutions that the counter distinguishes.
        turns: u32,
    },
    /// Counts without limit while powered; after each start it is within the first revolution.
    Volatile,
}

/// Values that 6002h accepts within the limits of the dictionary.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum RangeRule {
    /// 1 to the range of the sensor in steps; above, the download is aborted with 06090031h.
    Sensor,
    /// 6001h times a power of two, and 0 if that means 2³²; else the abort code is 06090030h
    /// (MANUALS.md C-EAM-18).
    PowerOfTwo,
    /// At most 6001h times the revolutions of the sensor; above, the download is aborted with
    /// 06090031h. Only a download to 6002h is checked, so 6001h first and 6002h second always
    /// works.
    Turns,
}

/// Electronic gear: switch, numerator and denominator at sub-indices 1, 2 and 3 of an object
/// (MANUALS.md C-X-06).
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct Gear {
    /// Index of the object.
    pub index: u16,
    /// Value of sub-index 1 that switches the gear on.
    pub on: u8,
    /// Effect of the gear.
    pub kind: GearKind,
}

/// Effect of a gear.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum GearKind {
    /// The position is that of the encoder divided by numerator / denominator, modulo the same range.
    /// Values take effect at the next start (power-on, NMT reset node; manual 001, 4.4.6).
    Position,
    /// 6002h is one revolution of the output, which is numerator / denominator revolutions of the
    /// encoder (MANUALS.md C-EN-09). Values take effect at once (U-14); 6001h shows steps per
    /// revolution of the encoder, rounded down, and a download to it has no effect. A new gear is a
    /// new resolution, so it clears the offset.
    Output,
}

/// Object of manufacturer options whose bits change the encoder (2110h; MANUALS.md C-X-12).
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct OptionObject {
    /// Index of the object.
    pub index: u16,
    /// Bits that keep the offset after a new resolution.
    pub keep_offset: u32,
    /// Bits that make 1800h:05 longer than 6200h (MANUALS.md C-GX-26).
    pub delay_timer: u32,
    /// Milliseconds that `delay_timer` adds.
    pub delay_ms: u16,
    /// Bits that make speed and acceleration independent of the code sequence (6000h, bit 0;
    /// MANUALS.md C-EAM-33).
    pub ignore_code_sequence: u32,
}

impl OptionObject {
    /// Options without a meaning, for `..OptionObject::NONE`.
    pub const NONE: Self = Self {
        index: 0x2110,
        keep_offset: 0,
        delay_timer: 0,
        delay_ms: 0,
        ignore_code_sequence: 0,
    };
}

/// Behaviour of an object beyond what its dictionary entry says.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Role {
    /// Shows the operating time since the first power-on, in seconds. The node saves it with every
    /// save and every six minutes (2201h:02; MANUALS.md C-GX-27).
    Seconds,
    /// Shows the operating time since the first power-on, in units of six minutes (CiA 406, object
    /// 6508h).
    TenthHours,
    /// Shows the time since the last start, in seconds.
    SecondsSinceStart,
    /// Shows the time since the last start, in units of six minutes (6508h; MANUALS.md C-GX-27).
    TenthHoursSinceStart,
    /// Counts power-on cycles.
    Cycles,
    /// Shows the time of the position since the last start, in microseconds modulo 65,536.
    TimeStamp,
    /// Shows the raw position of the sensor modulo 2³², without scaling, code sequence and offset
    /// (CiA 406, object 600Ch).
    RawPosition,
    /// Shows bits of other objects.
    Diagnosis(&'static [Mirror]),
    /// Shows a speed or an acceleration (CiA 406, objects 6030h and 6040h): an INTEGER8, INTEGER16 or
    /// INTEGER32.
    Movement(Movement),
    /// Accepts these values only; an SDO download of any other is aborted with 06090030h.
    OneOf(&'static [u8]),
    /// Node ID for the next start, 1 to 127.
    NodeId,
    /// Code of the bit rate for the next start, by [`EncoderProfile::bit_rates`].
    BitRate,
    /// Injects faults for a test: accepts the codes of [`Report::injection`] one after another, and
    /// 0, which ends them all; others abort with 06090030h. A start ends them, except those of
    /// [`Until::Ever`](super::Until::Ever).
    InjectedError,
    /// Adds steps to the position for a test, until the next start.
    InjectedOffset,
}

impl Role {
    /// Returns whether the value is computed when it is read.
    pub(super) const fn is_live(&self) -> bool {
        matches!(
            self,
            Self::TimeStamp | Self::RawPosition | Self::Diagnosis(_) | Self::Movement(_)
        ) || self.is_time()
    }

    /// Returns whether the value is an operating time.
    pub(super) const fn is_time(&self) -> bool {
        matches!(
            self,
            Self::Seconds | Self::TenthHours | Self::SecondsSinceStart | Self::TenthHoursSinceStart
        )
    }
}

/// Source of a speed or an acceleration.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Source {
    /// Whole revolutions; a speed is per minute.
    Revolutions,
    /// Steps of 6004h: code sequence, resolution and a [`GearKind::Output`] apply; offset, range and a
    /// [`GearKind::Position`] do not.
    Position,
    /// This number of steps per revolution, independent of the scaling; the code sequence applies.
    Fixed(u32),
    /// Steps of the sensor; the code sequence does not apply.
    Raw,
}

/// Quantity that is derived from the movement of the shaft.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Quantity {
    /// Steps per second, or revolutions per minute.
    Speed,
    /// Steps per second squared.
    Acceleration,
}

/// Speed or acceleration that an object shows: the mean over an interval, times a multiplier,
/// divided by a divider, rounded towards zero. It saturates at the limits of the object's type
/// (MANUALS.md U-15).
///
/// It is 0 until a whole interval has passed since the start, or since a change of interval or
/// source.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct Movement {
    /// Speed or acceleration.
    pub quantity: Quantity,
    /// Object that selects the source (CiA 406, objects 6031h and 6041h); a value that `sources` lacks is
    /// aborted with 06090030h.
    pub selector: Option<Address>,
    /// Sources by the value of the selector; without a selector the first one is used.
    pub sources: &'static [(u8, Source)],
    /// Object with the interval (integration time) in milliseconds; 0 counts as 1.
    pub interval: Address,
    /// Objects with multiplier and divider; a divider of 0 is aborted (MANUALS.md C-EN-24).
    pub factor: Option<(Address, Address)>,
}

/// Bit that shows a bit of another object.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct Mirror {
    /// Index of the object with the bit, sub-index 0.
    pub from: u16,
    /// Number of the bit in that object.
    pub bit: u8,
    /// Number of the bit that shows it.
    pub shown: u8,
}

/// Greatest number of movements in a profile.
pub(super) const MOVEMENTS: usize = 4;

/// Properties of an encoder family besides its dictionary, each with its default in
/// [`CIA406`](Self::CIA406).
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct EncoderProfile {
    /// Sensor; `None`: 6501h and 6502h describe it.
    pub sensor: Option<Sensor>,
    /// Steps per revolution with scaling off (MANUALS.md C-EN-07); `None`: those of the sensor.
    pub unscaled_steps: Option<u32>,
    /// Counting of revolutions.
    pub counter: Counter,
    /// Unit of 6502h.
    pub total: Total,
    /// Values that 6002h accepts.
    pub range_rule: RangeRule,
    /// 6509h is signed (CiA 406), else modulo the range (MANUALS.md C-X-13, U-07).
    pub signed_offset: bool,
    /// A 6002h of 0 means 2³².
    pub zero_is_full: bool,
    /// Bits of 6000h that 6500h shows.
    pub operating_bits: u16,
    /// Electronic gear.
    pub gear: Option<Gear>,
    /// Objects with a role; at most 4 of them are movements.
    pub objects: &'static [(Address, Role)],
    /// Pairs of objects with one value, such as preset values (CiA 406, objects 6003h and 6010h): a download
    /// to one changes the other. After a reset the saved value of the pair applies, that of the first object
    /// if both are saved (MANUALS.md C-EAM-28).
    pub links: &'static [(Address, Address)],
    /// Abort code for a value below its lower limit (MANUALS.md U-05).
    pub below_limit: AbortCode,
    /// Manufacturer options.
    pub options: Option<OptionObject>,
    /// Bit rates by the codes of the object for the bit rate ([`Role::BitRate`]), in kbit/s; 0 if a
    /// code is not supported (MANUALS.md C-X-10).
    pub bit_rates: &'static [u16],
    /// Bit rates by the DIP switches, in kbit/s (MANUALS.md C-GX-35); at 0 the object for the bit rate
    /// applies. Empty: the device has no switches, also none for the node ID.
    pub switch_rates: &'static [u16],
    /// Reports of faults, at most 31.
    pub reports: &'static [Report],
    /// The device supports only the reports whose bits are set in its supported alarms and warnings (CiA 406,
    /// objects 6504h and 6506h), by which variants differ; otherwise it supports all.
    pub by_support: bool,
}

impl EncoderProfile {
    /// Report of a position that is not valid (CiA 406, object 6503h, bit 0). A sensor that fails is
    /// reported in this way if the family has no alarm for its fault.
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
    /// 6501h and 6502h describe its sensor. 6502h is a number of revolutions (CiA 406) unless its
    /// default value is that of 6002h: then both are steps.
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

    /// Returns the first object with a role; what the role contains does not matter.
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

    /// CiA 406 without deviations: the profile of an encoder of an unknown EDS.
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

/// Number of the device profile in bits 0 to 15 of 1000h.
const CIA406: u64 = 406;

/// Returns the default values of a dictionary by index; negative ones are left out.
fn default_of(dictionary: Dictionary<'_>) -> impl Fn(u16) -> Option<u64> {
    move |index| {
        let entry = dictionary.entry(index, 0)?;
        match entry.default {
            Literal::Signed(..0) => None,
            default => default.bits(1),
        }
    }
}

/// Family of an encoder as a type: its profile is known at compile time, so that the compiler leaves
/// out the code for roles of objects that the family does not have.
///
/// ```
/// use od_runtime::encoder::{Angle, Encoder, EncoderProfile, Family, Sampled};
/// use od_runtime::Duration;
///
/// struct Thermal;
///
/// impl Family for Thermal {
///     const PROFILE: Option<&'static EncoderProfile> = Some(&EncoderProfile::CIA406);
/// }
///
/// let shaft = Sampled::<_, 16>::new(Angle::ZERO, Duration::from_millis(1));
/// let encoder: Encoder<_, Thermal> = Encoder::of_family(shaft);
/// assert_eq!(encoder.profile(), &EncoderProfile::CIA406);
/// ```
pub trait Family {
    /// Profile of the family; `None`: known at run time ([`Encoder::new`](super::Encoder::new)).
    const PROFILE: Option<&'static EncoderProfile>;
}

/// Family whose profile is known at run time only.
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug, Default)]
pub struct AnyFamily;

impl Family for AnyFamily {
    const PROFILE: Option<&'static EncoderProfile> = None;
}

/// Roles that objects of a family may have.
pub(super) struct Parts {
    pub(super) time_stamp: bool,
    pub(super) raw_position: bool,
    pub(super) diagnosis: bool,
    pub(super) movement: bool,
    pub(super) injected_error: bool,
    pub(super) injected_offset: bool,
}

impl Parts {
    /// Roles of a family; all of them if its profile is known at run time only.
    pub(super) const fn of<F: Family>() -> Self {
        let Some(profile) = F::PROFILE else {
            return Self::all(true);
        };
        let mut parts = Self::all(false);
        let mut rest: &[(Address, Role)] = profile.objects;
        while let [(_, role), others @ ..] = rest {
            match role {
                Role::TimeStamp => parts.time_stamp = true,
                Role::RawPosition => parts.raw_position = true,
                Role::Diagnosis(_) => parts.diagnosis = true,
                Role::Movement(_) => parts.movement = true,
                Role::InjectedError => parts.injected_error = true,
                Role::InjectedOffset => parts.injected_offset = true,
                _ => {}
            }
            rest = others;
        }
        parts
    }

    const fn all(there: bool) -> Self {
        Self {
            time_stamp: there,
            raw_position: there,
            diagnosis: there,
            movement: there,
            injected_error: there,
            injected_offset: there,
        }
    }
}
