//! CAN-IDs that no PDO, SYNC, TIME or EMCY may use (CiA 301, table 40).

/// Returns whether CiA 301 keeps an 11-bit CAN-ID for NMT, SDO, error control and LSS.
///
/// 000h, 001h–07Fh, 101h–180h, 581h–5FFh, 601h–67Fh, 6E0h–6FFh, 701h–77Fh, 780h–7FFh.
pub const fn is_restricted(can_id: u32) -> bool {
    matches!(
        can_id,
        0x000..=0x07F | 0x101..=0x180 | 0x581..=0x5FF | 0x601..=0x67F | 0x6E0..=0x6FF | 0x701..=0x7FF
    )
}

#[cfg(test)]
mod tests {
    use super::is_restricted;

    #[test]
    fn the_gaps_between_the_services_are_free() {
        for free in [
            0x080, 0x100, 0x181, 0x57F, 0x580, 0x600, 0x680, 0x6DF, 0x700,
        ] {
            assert!(!is_restricted(free), "{free:X}");
        }
        for kept in [
            0x000, 0x001, 0x101, 0x180, 0x581, 0x601, 0x6E0, 0x701, 0x7E5,
        ] {
            assert!(is_restricted(kept), "{kept:X}");
        }
    }
}
