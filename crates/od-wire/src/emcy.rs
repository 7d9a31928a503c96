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
