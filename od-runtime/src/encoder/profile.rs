//! What one encoder family does differently from another, as const data.

use od_model::Address;

use super::Sensor;
use crate::AbortCode;

/// What object 6502h counts.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Total {
    /// Steps in all, the whole measuring range.
    Steps,
    /// Revolutions (CiA 406).
    Revolutions,
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
}

/// Something that can break.
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug)]
pub enum Fault {
    /// The sensor's position is not to be trusted.
    Position,
    /// The battery of the multiturn counter is nearly empty.
    Battery,
    /// The last reset was by the watchdog; seen after the next reset.
    Watchdog,
    /// The non-volatile memory failed.
    Memory,
    /// The electronics cannot reach the sensor.
    Internal,
}

impl Fault {
    /// All of them.
    pub const ALL: [Self; 5] = [
        Self::Position,
        Self::Battery,
        Self::Watchdog,
        Self::Memory,
        Self::Internal,
    ];
}

/// How a family reports a fault.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct Report {
    /// Which.
    pub fault: Fault,
    /// EMCY code.
    pub code: u16,
    /// Bits of 1001h.
    pub register: u8,
    /// Bits of 6503h; the fault exists only where 6504h has them.
    pub alarm: u16,
    /// Bits of 6505h; the fault exists only where 6506h has them.
    pub warning: u16,
    /// Object that counts how often it came.
    pub counter: Option<Address>,
}

/// What the encoder needs to know of its family besides the dictionary.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct EncoderProfile {
    /// The sensor; `None`: 6501h and 6502h describe it.
    pub sensor: Option<Sensor>,
    /// What 6502h counts.
    pub total: Total,
    /// 6509h is signed (CiA 406), else modulo the range.
    pub signed_offset: bool,
    /// 6002h = 0 stands for 2³².
    pub zero_is_full: bool,
    /// Bits of 6000h that 6500h shows.
    pub operating_bits: u16,
    /// Answer to a value below its lower limit.
    pub below_limit: AbortCode,
    /// Objects that take these values and no others; the answer else is 06090030h.
    pub lists: &'static [(Address, &'static [u8])],
    /// Manufacturer options.
    pub options: Option<Options>,
    /// Object with the node ID for the next start.
    pub node_id: Option<u16>,
    /// Object with the code of the bit rate for the next start.
    pub bit_rate: Option<u16>,
    /// Bit rates by that code, in kbit/s; 0 where a code has none.
    pub bit_rates: &'static [u16],
    /// Bit rates by the DIP switches, in kbit/s.
    pub switch_rates: &'static [u16],
    /// Object with the operating time since the first power-on, in seconds.
    pub seconds: Option<Address>,
    /// 6508h counts six minutes each, since the last reset.
    pub operating_time: bool,
    /// How faults are reported.
    pub reports: &'static [Report],
}

impl EncoderProfile {
    /// CiA 406 and nothing else: what an encoder of an unknown EDS gets.
    pub const CIA406: Self = Self {
        sensor: None,
        total: Total::Revolutions,
        signed_offset: true,
        zero_is_full: false,
        operating_bits: 0x0005,
        below_limit: AbortCode::ValueTooLow,
        lists: &[],
        options: None,
        node_id: None,
        bit_rate: None,
        bit_rates: &[],
        switch_rates: &[],
        seconds: None,
        operating_time: true,
        reports: &[
            Report {
                fault: Fault::Position,
                code: 0x7320,
                register: 0x01,
                alarm: 0x0001,
                warning: 0,
                counter: None,
            },
            Report {
                fault: Fault::Battery,
                code: 0xFF00,
                register: 0x81,
                alarm: 0,
                warning: 0x0010,
                counter: None,
            },
            Report {
                fault: Fault::Watchdog,
                code: 0x6010,
                register: 0x01,
                alarm: 0,
                warning: 0x0004,
                counter: None,
            },
            Report {
                fault: Fault::Memory,
                code: 0x5530,
                register: 0x01,
                alarm: 0,
                warning: 0,
                counter: None,
            },
        ],
    };
}
