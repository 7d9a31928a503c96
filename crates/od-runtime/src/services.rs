//! Facts of a device that the compiler knows: its dictionary, and the services of its node.

use od_model::Dictionary;
use od_wire::CobId;

/// Dictionary and services of a device, as far as the compiler knows them.
///
/// A service is on unless its constant is `false`; then the node has no code for it, and does not
/// compile if the dictionary has objects of it. `object_dictionary!` implements this trait for the
/// type `Device` of each module that it makes; `without lss, block;` in its call makes constants
/// `false`.
pub trait Services: Sized {
    /// The dictionary; `None`: known at run time.
    const DICTIONARY: Option<Dictionary<'static>> = None;
    /// LSS slave (CiA 305).
    const LSS: bool = true;
    /// Segmented SDO transfers. Without them a value of more than four bytes cannot be read
    /// (06010000h), and a segmented download is not a command (05040001h).
    const SEGMENTED: bool = true;
    /// SDO block transfers. Without them they are not commands (05040001h).
    const BLOCK: bool = true;
    /// RPDOs (1400h to 17FFh).
    const RPDOS: bool = true;
    /// Transmission of TPDOs when a mapped value changes
    /// ([`event_on_change`](crate::PdoProfile::event_on_change)).
    const CHANGES: bool = true;
    /// Node guarding and life guarding (100Ch, 100Dh).
    const GUARDING: bool = true;
    /// Heartbeat consumer (1016h).
    const CONSUMER: bool = true;
    /// Saving and restoring (1010h, 1011h), and the operating records.
    const STORAGE: bool = true;
    /// Error behaviour (1029h, and the default of CiA 301 if 1029h is missing).
    const BEHAVIOUR: bool = true;
    /// Events for the host ([`Node::poll_event`](crate::Node::poll_event)).
    const EVENTS: bool = true;
    /// SDO servers besides the default one (1201h to 127Fh): on if the dictionary has one.
    ///
    /// Off for a dictionary known at run time, as are the SYNC producer and TIME: an implementation
    /// of this trait for such a dictionary switches them on.
    const SERVERS: bool = match &Self::DICTIONARY {
        Some(dictionary) => dictionary.servers() > 0,
        None => false,
    };
    /// SYNC producer (1005h, 1006h, 1019h): on if the dictionary has 1006h. Otherwise bit 30 of
    /// 1005h cannot be set (06090030h).
    const SYNC_PRODUCER: bool = match &Self::DICTIONARY {
        Some(dictionary) => dictionary.has(0x1006),
        None => false,
    };
    /// TIME consumer and producer (1012h): on if the dictionary has 1012h.
    const TIME: bool = match &Self::DICTIONARY {
        Some(dictionary) => dictionary.has(0x1012),
        None => false,
    };
    /// Deadline of RPDOs (1400h:05): a late frame is EMCY 8250h. On if the dictionary has the
    /// sub-index, or is known at run time.
    const DEADLINES: bool = match &Self::DICTIONARY {
        Some(_) => may_have::<Self>(0x1400, 0x15FF, Some(5)),
        None => true,
    };
    /// A SYNC whose length is not that of 1019h causes EMCY 8240h (CiA 301, table 26).
    const SYNC_LENGTH: bool = true;
    /// Number of errors that can be active at once, and that can begin or end in one call, 1 to
    /// 128. The same number of EMCY messages can wait, at most 16.
    const ERRORS: usize = 32;
    /// Values that the application streams ([`Application::stream`](crate::Application::stream)):
    /// on if the dictionary has one, or is known at run time.
    const STREAMS: bool = match &Self::DICTIONARY {
        Some(dictionary) => dictionary.has_streams(),
        None => true,
    };
}

/// Returns whether a device may have a value with an index in this range and with this sub-index,
/// if one is given. Call it at compile time.
pub(crate) const fn may_have<D: Services>(first: u16, last: u16, sub: Option<u8>) -> bool {
    let Some(dictionary) = &D::DICTIONARY else {
        return true;
    };
    let mut rest = dictionary.rows();
    while let [row, others @ ..] = rest {
        let is_sub = match sub {
            Some(sub) => row.address().sub == sub,
            None => true,
        };
        if is_sub && first <= row.index() && row.index() <= last {
            return true;
        }
        rest = others;
    }
    false
}

/// As [`may_have`], for values in the store: no other value can change.
pub(crate) const fn may_change<D: Services>(first: u16, last: u16) -> bool {
    let Some(dictionary) = &D::DICTIONARY else {
        return true;
    };
    let mut rest = dictionary.rows();
    while let [row, others @ ..] = rest {
        if row.is_stored() && first <= row.index() && row.index() <= last {
            return true;
        }
        rest = others;
    }
    false
}

/// Checks at compile time that the dictionary has no object of a service that is switched off.
pub(crate) const fn assert_served<D: Services>() {
    let Some(dictionary) = &D::DICTIONARY else {
        return;
    };
    let mut rest = dictionary.rows();
    while let [row, others @ ..] = rest {
        let is_served = match row.index() {
            0x100C | 0x100D => D::GUARDING,
            0x1010 | 0x1011 => D::STORAGE,
            0x1012 => D::TIME,
            0x1016 => D::CONSUMER,
            0x1029 => D::BEHAVIOUR,
            0x1201..=0x127F => D::SERVERS,
            0x1400..=0x17FF => D::RPDOS,
            _ => true,
        };
        assert!(
            is_served,
            "the dictionary has an object of a service that is switched off by `without`"
        );
        let cob_id = CobId::new(row.default(dictionary.pool(), 0) as u32);
        assert!(
            row.index() != 0x1005 || D::SYNC_PRODUCER || !cob_id.produces_sync(),
            "1005h produces SYNC by default, and the node does not; add 1006h, or clear bit 30"
        );
        rest = others;
    }
}

#[cfg(test)]
pub(crate) mod tests {
    use od_model::owned::{Buckets, Shape};
    use od_model::row::Row;
    use od_model::{
        Access, Address, DataType, Entry, Group, Literal, Names, ObjectCode, Range, Slot,
    };

    use super::*;

    /// Row of a number, with a place in the store or without.
    const fn row(index: u16, sub: u8, len: u16) -> Row {
        let entry = Entry {
            address: Address::new(index, sub),
            data_type: DataType::Unsigned32,
            access: if len > 0 { Access::Rw } else { Access::Const },
            mappable: false,
            group: Group::None,
            name: Range::new(0, 0),
            default: Literal::None,
            low: Literal::None,
            high: Literal::None,
            slot: Slot { offset: 0, len },
        };
        Row::new(&entry, ObjectCode::Record, 0, 0)
    }

    /// A device whose dictionary is known at run time.
    pub(crate) struct AnyDevice;

    impl Services for AnyDevice {}

    /// A device in which the mapping of a TPDO can change, and that of an RPDO cannot.
    pub(crate) struct Known;

    impl Services for Known {
        const DICTIONARY: Option<Dictionary<'static>> = {
            static ROWS: &[Row] = &[row(0x1003, 0, 4), row(0x1600, 2, 0), row(0x1A00, 1, 4)];
            Some(dictionary(ROWS))
        };
    }

    /// A device without PDOs.
    pub(crate) struct Rich;

    impl Services for Rich {
        const DICTIONARY: Option<Dictionary<'static>> = {
            static ROWS: &[Row] = &[row(0x1006, 0, 4), row(0x1012, 0, 4), row(0x1201, 1, 4)];
            Some(dictionary(ROWS))
        };
    }

    const fn dictionary(rows: &'static [Row]) -> Dictionary<'static> {
        let names = Names {
            rows: &[],
            text: "",
        };
        let buckets = Buckets::Words(&[]);
        let shape = Shape {
            store_len: 4,
            longest: 4,
            has_streams: false,
            reals: None,
            varying: None,
        };
        Dictionary::trusted(buckets, rows, &[], "", &[], shape, names)
    }

    #[test]
    fn a_device_may_have_what_its_dictionary_has() {
        for (first, last, sub, there) in [
            (0x1003, 0x1003, None, true),
            (0x1002, 0x1003, Some(0), true),
            (0x1003, 0x1004, Some(0), true),
            (0x1003, 0x1003, Some(2), false),
            (0x1000, 0x1002, None, false),
            (0x1601, 0x19FF, None, false),
            (0x1601, 0x19FF, Some(1), false),
            (0x1600, 0x17FF, Some(2), true),
            (0x1A00, 0x1BFF, Some(1), true),
            (0x1A01, 0x1BFF, Some(1), false),
        ] {
            assert_eq!(may_have::<Known>(first, last, sub), there, "{first:X}");
            assert!(may_have::<AnyDevice>(first, last, sub));
        }
    }

    #[test]
    fn values_outside_the_store_cannot_change() {
        for (first, last, can_change) in [
            (0x1003, 0x1003, true),
            (0x1000, 0x1002, false),
            (0x1004, 0x19FF, false),
            (0x1600, 0x17FF, false),
            (0x1A00, 0x1BFF, true),
            (0x1A01, 0x1BFF, false),
        ] {
            assert_eq!(may_change::<Known>(first, last), can_change, "{first:X}");
            assert!(may_change::<AnyDevice>(first, last));
        }
    }

    #[test]
    fn a_rare_service_is_on_if_the_dictionary_has_its_object() {
        const NONE: [bool; 4] = [false, false, false, false];
        fn services<D: Services>() -> [bool; 4] {
            [D::SERVERS, D::SYNC_PRODUCER, D::TIME, D::STREAMS]
        }
        assert_eq!(services::<Known>(), NONE);
        assert_eq!(services::<Rich>(), [true, true, true, false]);
        assert_eq!(services::<AnyDevice>(), [false, false, false, true]);
    }
}
