//! Objects of the device profiles, as a table.

use od_model::{DataType, ObjectCode};

/// One object, or a range of objects that are alike.
pub(super) struct Object {
    first: u16,
    last: u16,
    /// VAR or ARRAY; an ARRAY may be a RECORD as well.
    pub(super) code: ObjectCode,
    /// The types that the value, or every sub-object, may have.
    pub(super) data_types: &'static [DataType],
    /// May a master write it? `None` where the profile leaves it open.
    pub(super) writable: Option<bool>,
}

/// The entry of an index in a profile.
pub(super) fn of(profile: u16, index: u16) -> Option<&'static Object> {
    let table = match profile {
        401 => IO,
        402 => DRIVE,
        406 => ENCODER,
        _ => return None,
    };
    table
        .iter()
        .find(|object| (object.first..=object.last).contains(&index))
}

const fn object(
    first: u16,
    last: u16,
    code: ObjectCode,
    data_types: &'static [DataType],
    writable: Option<bool>,
) -> Object {
    Object {
        first,
        last,
        code,
        data_types,
        writable,
    }
}

/// Read only.
const fn ro(index: u16, data_types: &'static [DataType]) -> Object {
    object(index, index, ObjectCode::Var, data_types, Some(false))
}

/// Written by a master.
const fn rw(index: u16, data_types: &'static [DataType]) -> Object {
    object(index, index, ObjectCode::Var, data_types, Some(true))
}

/// Written by a master, or fixed in a simple device.
const fn var(index: u16, data_types: &'static [DataType]) -> Object {
    object(index, index, ObjectCode::Var, data_types, None)
}

/// Members of one type.
const fn array(
    first: u16,
    last: u16,
    data_types: &'static [DataType],
    writable: Option<bool>,
) -> Object {
    object(first, last, ObjectCode::Array, data_types, writable)
}

use DataType::{Integer8, Integer16, Integer32, Unsigned8, Unsigned16, Unsigned32, Unsigned64};

const IO: &[Object] = &[
    array(0x6000, 0x6000, &[Unsigned8], Some(false)),
    array(0x6200, 0x6200, &[Unsigned8], None),
    array(0x6400, 0x6400, &[Integer8], Some(false)),
    array(0x6401, 0x6401, &[Integer16], Some(false)),
    array(0x6402, 0x6402, &[Integer32], Some(false)),
    array(0x6410, 0x6410, &[Integer8], None),
    array(0x6411, 0x6411, &[Integer16], None),
    array(0x6412, 0x6412, &[Integer32], None),
];

const DRIVE: &[Object] = &[
    ro(0x603F, &[Unsigned16]),
    rw(0x6040, &[Unsigned16]),
    ro(0x6041, &[Unsigned16]),
    var(0x6060, &[Integer8]),
    ro(0x6061, &[Integer8]),
    ro(0x6064, &[Integer32]),
    ro(0x606C, &[Integer32]),
    var(0x6071, &[Integer16]),
    ro(0x6077, &[Integer16]),
    var(0x607A, &[Integer32]),
    var(0x6081, &[Unsigned32]),
    var(0x6083, &[Unsigned32]),
    var(0x60FF, &[Integer32]),
    ro(0x6502, &[Unsigned32]),
];

const ENCODER: &[Object] = &[
    var(0x6000, &[Unsigned16]),
    rw(0x6001, &[Unsigned32]),
    rw(0x6002, &[Unsigned32]),
    rw(0x6003, &[Unsigned32]),
    ro(0x6004, &[Unsigned32]),
    var(0x6005, &[Unsigned32]),
    ro(0x6008, &[Unsigned64]),
    rw(0x6009, &[Unsigned64]),
    ro(0x600C, &[Unsigned32]),
    array(0x6020, 0x6020, &[Integer32], Some(false)),
    Object {
        first: 0x6030,
        last: 0x6030,
        code: ObjectCode::Array,
        // As many bits as the device has.
        data_types: &[Integer16, Integer8, Integer32],
        writable: Some(false),
    },
    Object {
        first: 0x6040,
        last: 0x6040,
        code: ObjectCode::Array,
        data_types: &[Integer16, Integer8, Integer32],
        writable: Some(false),
    },
    array(0x6300, 0x6300, &[Unsigned8], Some(false)),
    array(0x6301, 0x6301, &[Unsigned8], Some(true)),
    array(0x6302, 0x6302, &[Unsigned8], Some(true)),
    array(0x6310, 0x6317, &[Integer32], Some(true)),
    array(0x6320, 0x6327, &[Integer32], Some(true)),
    array(0x6330, 0x6337, &[Unsigned16], Some(true)),
    array(0x6400, 0x6400, &[Unsigned8], Some(false)),
    array(0x6401, 0x6401, &[Integer32], None),
    array(0x6402, 0x6402, &[Integer32], None),
    var(0x6200, &[Unsigned16]),
    ro(0x6500, &[Unsigned16]),
    ro(0x6501, &[Unsigned32]),
    // 16 bits until version 3, 32 since.
    ro(0x6502, &[Unsigned16, Unsigned32]),
    ro(0x6503, &[Unsigned16]),
    ro(0x6504, &[Unsigned16]),
    ro(0x6505, &[Unsigned16]),
    ro(0x6506, &[Unsigned16]),
    ro(0x6507, &[Unsigned32]),
    ro(0x6508, &[Unsigned32]),
    // An offset is what it is modulo 2^32.
    ro(0x6509, &[Integer32, Unsigned32]),
    array(0x650A, 0x650A, &[Integer32], Some(false)),
    ro(0x650B, &[Unsigned32]),
];

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_object_has_one_entry() {
        for (profile, table) in [(401, IO), (402, DRIVE), (406, ENCODER)] {
            for object in table {
                assert!(object.first <= object.last);
                for index in object.first..=object.last {
                    let found = of(profile, index).map(|found| found.first);
                    assert_eq!(found, Some(object.first), "{profile} {index:04X}");
                }
            }
        }
        assert!(of(406, 0x7000).is_none() && of(404, 0x6000).is_none());
    }
}
