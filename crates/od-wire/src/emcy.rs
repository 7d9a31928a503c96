//! EMCY frames (CiA 301, chapter 7.2.7.1): error code, error register, five manufacturer-specific bytes.

/// An EMCY message: a new error, or with code 0000h the end of an error.
///
/// ```
/// use od_wire::emcy::Emcy;
///
/// let emcy = Emcy::parse(&[0x10, 0x82, 0x11, 0, 0, 0, 0, 0]).expect("8 bytes");
/// assert_eq!((emcy.code, emcy.register), (0x8210, 0x11));
/// ```
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug, Default)]
pub struct Emcy {
    /// EMCY error code, for example 8130h; 0000h: error reset or no error.
    pub code: u16,
    /// Error register: the bits of 1001h. For an error that a device raises, the bits that are set
    /// while the error lasts.
    pub register: u8,
    /// Manufacturer-specific bytes 3 to 7 of the frame.
    pub info: [u8; 5],
}

impl Emcy {
    /// An error without manufacturer-specific information.
    pub const fn new(code: u16, register: u8) -> Self {
        Self {
            code,
            register,
            info: [0; 5],
        }
    }

    /// Reads the bytes of a frame; `None` unless there are eight.
    pub fn parse(data: &[u8]) -> Option<Self> {
        let &[low, high, register, a, b, c, d, e] = data else {
            return None;
        };
        Some(Self {
            code: u16::from_le_bytes([low, high]),
            register,
            info: [a, b, c, d, e],
        })
    }

    /// The frame's bytes.
    pub const fn emit(self) -> [u8; 8] {
        // As a number, which takes one store.
        let [a, b, c, d, e] = self.info;
        let low = self.code as u32 | (self.register as u32) << 16 | (a as u32) << 24;
        let high = u32::from_le_bytes([b, c, d, e]);
        ((high as u64) << 32 | low as u64).to_le_bytes()
    }
}

/// Returns the bits of 1001h that belong to an error code (CiA 301, chapters 7.2.7.1 and 7.5.2.2):
/// the generic error, and the bit of its class.
pub const fn register(code: u16) -> u8 {
    1 | match code >> 8 {
        0x20..=0x2F => 1 << 1,
        0x30..=0x3F => 1 << 2,
        0x40..=0x4F => 1 << 3,
        0x80..=0x8F => 1 << 4,
        0xFF => 1 << 7,
        _ => 0,
    }
}

/// Returns the meaning of an EMCY error code in a device of this profile: that of CiA 402 for a drive, else that of CiA 301,
/// table 26.
///
/// ```
/// assert_eq!(od_wire::emcy::text(None, 0x8130), "life guard or heartbeat error");
/// assert_eq!(od_wire::emcy::text(Some(402), 0x7121), "motor blocked");
/// ```
pub const fn text(profile: Option<u16>, code: u16) -> &'static str {
    if let (Some(402), Some(own)) = (profile, of_drive(code)) {
        return own;
    }
    match code {
        0x8110 => return "CAN overrun",
        0x8120 => return "CAN error passive",
        0x8130 => return "life guard or heartbeat error",
        0x8140 => return "recovered from bus-off",
        0x8150 => return "CAN-ID collision",
        0x8210 => return "PDO not processed, length error",
        0x8220 => return "PDO too long",
        0x8230 => return "DAM MPDO not processed, its object is not available",
        0x8240 => return "unexpected SYNC data length",
        0x8250 => return "RPDO timeout",
        _ => {}
    }
    match code >> 8 {
        0x00 => "no error, or error reset",
        0x10 => "generic error",
        0x21 => "current, device input side",
        0x22 => "current inside the device",
        0x23 => "current, device output side",
        0x20..=0x2F => "current",
        0x31 => "mains voltage",
        0x32 => "voltage inside the device",
        0x33 => "output voltage",
        0x30..=0x3F => "voltage",
        0x41 => "ambient temperature",
        0x42 => "device temperature",
        0x40..=0x4F => "temperature",
        0x50..=0x5F => "device hardware",
        0x61 => "internal software",
        0x62 => "user software",
        0x63 => "data set",
        0x60..=0x6F => "device software",
        0x70..=0x7F => "additional modules",
        0x81 => "communication",
        0x82 => "protocol error",
        0x80..=0x8F => "monitoring",
        0x90..=0x9F => "external error",
        0xF0..=0xFE => "additional functions",
        0xFF => "device-specific",
        _ => "reserved",
    }
}

/// Error codes of a drive (CiA 402-2, error codes).
const fn of_drive(code: u16) -> Option<&'static str> {
    Some(match code {
        0x2310 => "continuous over-current, device output side",
        0x2320 => "short circuit or earth leakage, device output side",
        0x2330 => "earth leakage, device output side",
        0x2340 => "short circuit, device output side",
        0x3110 => "mains over-voltage",
        0x3120 => "mains under-voltage",
        0x3130 => "phase failure",
        0x3210 => "DC link over-voltage",
        0x3220 => "DC link under-voltage",
        0x3230 => "load error",
        0x4110 => "excess ambient temperature",
        0x4120 => "too low ambient temperature",
        0x4210 => "excess device temperature",
        0x4220 => "too low device temperature",
        0x4310 => "excess drive temperature",
        0x4320 => "too low drive temperature",
        0x5110 => "low voltage of the supply",
        0x5530 => "non-volatile data memory",
        0x6010 => "software reset (watchdog)",
        0x6320 => "parameter error",
        0x7110 => "brake chopper",
        0x7120 => "motor",
        0x7121 => "motor blocked",
        0x7122 => "motor error or commutation malfunction",
        0x7300 => "sensor",
        0x7301 => "tacho fault",
        0x7303 => "resolver 1 fault",
        0x7305 => "incremental sensor 1 fault",
        0x7310 => "speed",
        0x7320 => "position",
        0x7500 => "communication",
        0x7510 => "serial interface 1",
        0x8311 => "excess torque",
        0x8331 => "torque fault",
        0x8400 => "velocity speed controller",
        0x8500 => "position controller",
        0x8611 => "following error",
        0x8612 => "reference limit",
        _ => return None,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_bytes_of_a_heartbeat_error_are_30_81() {
        let emcy = Emcy {
            code: 0x8130,
            register: 0x11,
            info: [1, 0, 0x14, 0, 0],
        };
        assert_eq!(emcy.emit(), [0x30, 0x81, 0x11, 1, 0, 0x14, 0, 0]);
        assert_eq!(Emcy::parse(&emcy.emit()), Some(emcy));
        assert_eq!(Emcy::parse(&[0; 7]), None);
    }
}
