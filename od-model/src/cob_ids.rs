//! The objects that hold COB-IDs, and the services that they belong to (CiA 301, chapter 7.5.2).

use crate::address::Address;

/// A service with a COB-ID of its own. If two services have the same CAN-ID, the earlier one in
/// this order keeps it.
///
/// ```
/// use od_model::{Address, CobIdService};
///
/// let service = CobIdService::at(Address::new(0x1800, 1)).expect("the COB-ID of a TPDO");
/// assert_eq!(service, CobIdService::Tpdo);
/// // Bit 31: the PDO is not valid.
/// assert!(service.is_used(0x185) && !service.is_used(0x8000_0185));
/// ```
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Debug)]
pub enum CobIdService {
    /// SYNC, 1005h.
    Sync,
    /// TIME, 1012h.
    Time,
    /// EMCY messages that the device sends, 1014h.
    Emcy,
    /// EMCY messages of another device, 1028h.
    EmcyConsumer,
    /// SDO server, 1200h–127Fh: sub-index 1 requests, 2 responses.
    SdoServer,
    /// SDO client, 1280h–12FFh: sub-index 1 requests, 2 responses.
    SdoClient,
    /// PDO that the device receives, 1400h–15FFh.
    Rpdo,
    /// PDO that the device sends, 1800h–19FFh.
    Tpdo,
}

impl CobIdService {
    /// Returns the service of the COB-ID at an address; `None` if the address has no COB-ID.
    pub const fn at(address: Address) -> Option<Self> {
        Some(match (address.index, address.sub) {
            (0x1005, 0) => Self::Sync,
            (0x1012, 0) => Self::Time,
            (0x1014, 0) => Self::Emcy,
            (0x1028, 1..=127) => Self::EmcyConsumer,
            (0x1200..=0x127F, 1 | 2) => Self::SdoServer,
            (0x1280..=0x12FF, 1 | 2) => Self::SdoClient,
            (0x1400..=0x15FF, 1) => Self::Rpdo,
            (0x1800..=0x19FF, 1) => Self::Tpdo,
            _ => return None,
        })
    }

    /// Returns whether the service uses a COB-ID with these bits. It does unless bit 31 is set,
    /// with two exceptions: SYNC is always used, and TIME is used if bit 31 (consumer) or bit 30
    /// (producer) is set.
    pub const fn is_used(self, cob_id: u32) -> bool {
        match self {
            Self::Sync => true,
            Self::Time => cob_id >> 30 != 0,
            _ => cob_id >> 31 == 0,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::CobIdService::{self, Sync, Time, Tpdo};
    use crate::address::Address;

    #[test]
    fn only_cob_ids_belong_to_a_service() {
        let at = |index, sub| CobIdService::at(Address::new(index, sub));
        assert_eq!((at(0x1005, 0), at(0x19FF, 1)), (Some(Sync), Some(Tpdo)));
        for other in [
            (0x1006, 0),
            (0x1028, 0),
            (0x1200, 3),
            (0x1400, 2),
            (0x1A00, 1),
        ] {
            assert_eq!(at(other.0, other.1), None, "{other:X?}");
        }
    }

    #[test]
    fn time_is_used_by_a_consumer_or_a_producer() {
        assert!(!Time.is_used(0x100) && Time.is_used(0x8000_0100) && Time.is_used(0x4000_0100));
        assert!(
            !Tpdo.is_used(0x8000_0181) && Tpdo.is_used(0x4000_0181) && Sync.is_used(0x8000_0080)
        );
    }
}
