//! The checksum of block transfers.

/// CRC-16 with polynomial 1021h and start value 0 (CiA 301, chapter 7.2.4.3.16).
pub fn crc16(data: &[u8]) -> u16 {
    crc16_after(0, data)
}

/// Continues a [`crc16`]: `before` is the checksum of the bytes before `data`.
pub fn crc16_after(before: u16, data: &[u8]) -> u16 {
    data.iter().fold(before, |crc, byte| {
        (0..8).fold(crc ^ u16::from(*byte) << 8, |crc, _| {
            if crc & 0x8000 != 0 {
                crc << 1 ^ 0x1021
            } else {
                crc << 1
            }
        })
    })
}

#[cfg(test)]
mod tests {
    #[test]
    fn check_value_of_the_standard() {
        assert_eq!(super::crc16(b"123456789"), 0x31C3);
        assert_eq!(super::crc16(b""), 0);
        assert_eq!(super::crc16_after(super::crc16(b"1234"), b"56789"), 0x31C3);
    }
}
