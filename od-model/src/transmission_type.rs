//! Transmission type of a PDO.

/// Transmission type of a PDO: sub-index 2 of its communication parameter (CiA 301, chapters 7.5.2.35 and
/// 7.5.2.37).
///
/// | value | TPDO | RPDO |
/// |---|---|---|
/// | 0 | synchronous, acyclic: with the SYNC after a change | synchronous |
/// | 1 to 240 | synchronous, cyclic: once in this number of SYNCs | synchronous |
/// | 241 to 251 | reserved | reserved |
/// | 252 | RTR-only: the values of the last SYNC | reserved |
/// | 253 | RTR-only: the values at the request | reserved |
/// | 254, 255 | event-driven | event-driven |
///
/// ```
/// use od_model::TransmissionType;
///
/// let every_third_sync = TransmissionType::new(3);
/// assert!(every_third_sync.is_synchronous());
/// assert_eq!(every_third_sync.cycle(), Some(3));
/// assert!(TransmissionType::new(241).is_reserved(false));
/// ```
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct TransmissionType(u8);

impl TransmissionType {
    /// Any value of the object.
    pub const fn new(value: u8) -> Self {
        Self(value)
    }

    /// Returns the value.
    pub const fn raw(self) -> u8 {
        self.0
    }

    /// Returns whether the PDO belongs to a SYNC (0 to 240): a TPDO is sent after it, an RPDO is processed with it.
    pub const fn is_synchronous(self) -> bool {
        self.0 <= 240
    }

    /// Returns whether a TPDO is sent with the SYNC after a change (0).
    pub const fn is_acyclic(self) -> bool {
        self.0 == 0
    }

    /// Returns the number of SYNCs from one TPDO to the next, 1 to 240; `None` for a TPDO that is not cyclic.
    pub const fn cycle(self) -> Option<u8> {
        match self.0 {
            1..=240 => Some(self.0),
            _ => None,
        }
    }

    /// Returns whether a TPDO has the values of a SYNC (0 to 240, 252; reserved values, too).
    pub const fn is_sampled_at_sync(self) -> bool {
        self.0 <= 252
    }

    /// Returns whether a TPDO is sent only if a remote frame requests it (252, 253).
    pub const fn is_rtr_only(self) -> bool {
        matches!(self.0, 252 | 253)
    }

    /// Returns whether the PDO is event-driven (254, 255).
    pub const fn is_event_driven(self) -> bool {
        self.0 >= 254
    }

    /// Returns whether CiA 301 reserves the value for an RPDO, or for a TPDO.
    pub const fn is_reserved(self, is_rpdo: bool) -> bool {
        matches!(self.0, 241..=251) || is_rpdo && self.is_rtr_only()
    }
}

#[cfg(test)]
mod tests {
    use super::TransmissionType;

    #[test]
    fn each_value_has_one_kind() {
        for value in 0..=255 {
            let kind = TransmissionType::new(value);
            let kinds = [
                kind.is_acyclic(),
                kind.cycle().is_some(),
                kind.is_rtr_only(),
                kind.is_event_driven(),
                kind.is_reserved(false),
            ];
            assert_eq!(kinds.iter().filter(|is| **is).count(), 1, "{value}");
            assert_eq!(kind.is_synchronous(), value <= 240, "{value}");
            let is_for_rpdos = kind.is_synchronous() || kind.is_event_driven();
            assert_eq!(kind.is_reserved(true), !is_for_rpdos, "{value}");
        }
    }
}
