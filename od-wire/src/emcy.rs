//! EMCY frames (CiA 301, chapter 7.2.7.1): error code, error register, five bytes of the manufacturer's.

/// What an EMCY frame says.
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug)]
pub struct Repr {
    /// Emergency error code; 0000h: error reset or no error.
    pub code: u16,
    /// 1001h.
    pub register: u8,
    /// Manufacturer-specific.
    pub info: [u8; 5],
}

impl Repr {
    /// The meaning of a frame's bytes; `None` unless there are eight.
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
        let [low, high] = self.code.to_le_bytes();
        let [a, b, c, d, e] = self.info;
        [low, high, self.register, a, b, c, d, e]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_heartbeat_error_reads_30_81() {
        let repr = Repr {
            code: 0x8130,
            register: 0x11,
            info: [1, 0, 0x14, 0, 0],
        };
        assert_eq!(repr.emit(), [0x30, 0x81, 0x11, 1, 0, 0x14, 0, 0]);
        assert_eq!(Repr::parse(&repr.emit()), Some(repr));
        assert_eq!(Repr::parse(&[0; 7]), None);
    }
}
