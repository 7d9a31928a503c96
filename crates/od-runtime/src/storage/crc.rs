//! CRC-32 as in Ethernet and zip (reflected, polynomial 04C11DB7h).

/// The remainders of the sixteen half-bytes.
const TABLE: [u32; 16] = {
    let mut table = [0; 16];
    let mut i = 0;
    while i < 16 {
        let mut crc = i as u32;
        let mut bit = 0;
        while bit < 4 {
            crc = if crc & 1 == 1 {
                crc >> 1 ^ 0xEDB8_8320
            } else {
                crc >> 1
            };
            bit += 1;
        }
        table[i] = crc;
        i += 1;
    }
    table
};

/// A checksum that is being computed.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Crc32(u32);

impl Crc32 {
    /// The checksum of no bytes.
    pub(crate) const fn new() -> Self {
        Self(u32::MAX)
    }

    /// Adds bytes.
    pub(crate) fn update(&mut self, bytes: &[u8]) {
        *self = self.after(bytes);
    }

    /// Returns the checksum with these bytes added.
    pub(crate) const fn after(self, mut bytes: &[u8]) -> Self {
        let Self(mut crc) = self;
        while let [byte, rest @ ..] = bytes {
            crc ^= *byte as u32;
            crc = crc >> 4 ^ TABLE[(crc & 15) as usize];
            crc = crc >> 4 ^ TABLE[(crc & 15) as usize];
            bytes = rest;
        }
        Self(crc)
    }

    /// Returns the finished checksum.
    pub(crate) const fn finish(self) -> u32 {
        !self.0
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_check_value_of_crc_32() {
        let mut crc = Crc32::new();
        crc.update(b"12345");
        crc.update(b"6789");
        assert_eq!(crc.finish(), 0xCBF4_3926);
        assert_eq!(Crc32::new().finish(), 0);
    }
}
