//! Roles of objects in an encoder, as const data.

use od_model::Address;

/// Behaviour of an object beyond what its dictionary entry says.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Role {
    /// Shows the operating time since the first power-on, in seconds. It is saved with every
    /// save and every six minutes.
    Seconds,
    /// Shows the operating time since the first power-on, in units of six minutes (6508h).
    TenthHours,
    /// Shows the time since the last start, in seconds.
    SecondsSinceStart,
    /// Shows the time since the last start, in units of six minutes (6508h).
    TenthHoursSinceStart,
    /// Counts how often power came.
    Cycles,
    /// Shows the moment of the position, in microseconds modulo 65,536.
    TimeStamp,
    /// Shows the position of the sensor modulo 2³²: no scaling, sense of rotation or offset.
    RawPosition,
    /// Shows bits of other objects.
    Diagnosis(&'static [Mirror]),
    /// Shows a speed or an acceleration: an INTEGER8, INTEGER16 or INTEGER32.
    Movement(Movement),
    /// Accepts these values only; others abort with 06090030h.
    OneOf(&'static [u8]),
    /// Node ID for the next start, 1 to 127.
    NodeId,
    /// Code of the bit rate for the next start, see
    /// [`bit_rates`](super::EncoderProfile::bit_rates).
    BitRate,
    /// Fakes errors for a test: accepts the codes of
    /// [`Report::injection`](super::Report::injection) one after another, and 0, which ends them
    /// all; others abort with 06090030h. An error that nothing ends
    /// ([`Until::Ever`](super::Until::Ever)) outlasts a start here, too.
    InjectedError,
    /// Steps that are added to the position for a test. A start ends it.
    InjectedOffset,
}

impl Role {
    /// Is the value computed when it is read?
    pub(super) const fn is_live(&self) -> bool {
        matches!(
            self,
            Self::TimeStamp | Self::RawPosition | Self::Diagnosis(_) | Self::Movement(_)
        ) || self.is_time()
    }

    /// Is the value an operating time?
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
    /// Whole revolutions: a speed is per minute.
    Revolutions,
    /// Steps of 6004h; sense of rotation and resolution count, offset and range do not. A
    /// [`GearKind::Output`](super::GearKind::Output) counts, a
    /// [`GearKind::Position`](super::GearKind::Position) does not.
    Position,
    /// This number of steps per revolution, whatever the scaling; the sense of rotation counts.
    Fixed(u32),
    /// Steps of the sensor, without the sense of rotation.
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

/// A speed or an acceleration that can be read: the mean over an interval, times a
/// multiplier, by a divider, rounded towards zero, held in the limits of its object.
///
/// It is 0 until a whole interval has passed since the start, or since the interval or the
/// source was changed.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct Movement {
    /// Speed or acceleration.
    pub quantity: Quantity,
    /// Object that selects the source; values that `sources` has not are answered with
    /// 06090030h.
    pub selector: Option<Address>,
    /// The sources by the selector's value; without a selector the first one is used.
    pub sources: &'static [(u8, Source)],
    /// Object with the interval in milliseconds; 0 counts as 1.
    pub interval: Address,
    /// Objects with multiplier and divider. A divider of 0 cannot be written.
    pub factor: Option<(Address, Address)>,
}

/// A bit that shows a bit of another object.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct Mirror {
    /// Index of the object with the bit, sub-index 0.
    pub from: u16,
    /// The bit there.
    pub bit: u8,
    /// The bit here.
    pub shown: u8,
}
