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

/// The types that a profile gives the value of an object, or each of its sub-objects.
pub fn profile_types(profile: u16, index: u16) -> &'static [DataType] {
    of(profile, index).map_or(&[], |object| object.data_types)
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

use DataType::{
    Boolean, Integer8, Integer16, Integer32, Real32, Unsigned8, Unsigned16, Unsigned32, Unsigned64,
};

/// An ARRAY of CiA 401, of one type.
const fn io(first: u16, last: u16, data_types: &'static [DataType], writable: bool) -> Object {
    array(first, last, data_types, Some(writable))
}

/// By ascending index.
const IO: &[Object] = &[
    io(0x6000, 0x6000, &[Unsigned8], false),
    io(0x6002, 0x6003, &[Unsigned8], true),
    rw(0x6005, &[Boolean]),
    io(0x6006, 0x6008, &[Unsigned8], true),
    io(0x6020, 0x6027, &[Boolean], false),
    io(0x6030, 0x603F, &[Boolean], true),
    io(0x6050, 0x6057, &[Boolean], true),
    io(0x6060, 0x6067, &[Boolean], true),
    io(0x6070, 0x6077, &[Boolean], true),
    io(0x6100, 0x6100, &[Unsigned16], false),
    io(0x6102, 0x6103, &[Unsigned16], true),
    io(0x6106, 0x6108, &[Unsigned16], true),
    io(0x6120, 0x6120, &[Unsigned32], false),
    io(0x6122, 0x6123, &[Unsigned32], true),
    io(0x6126, 0x6128, &[Unsigned32], true),
    io(0x6200, 0x6200, &[Unsigned8], true),
    io(0x6202, 0x6202, &[Unsigned8], true),
    io(0x6206, 0x6208, &[Unsigned8], true),
    io(0x6220, 0x6227, &[Boolean], true),
    io(0x6240, 0x6247, &[Boolean], true),
    io(0x6250, 0x6257, &[Boolean], true),
    io(0x6260, 0x6267, &[Boolean], true),
    io(0x6270, 0x6277, &[Boolean], true),
    io(0x6300, 0x6300, &[Unsigned16], true),
    io(0x6302, 0x6302, &[Unsigned16], true),
    io(0x6306, 0x6308, &[Unsigned16], true),
    io(0x6320, 0x6320, &[Unsigned32], true),
    io(0x6322, 0x6322, &[Unsigned32], true),
    io(0x6326, 0x6328, &[Unsigned32], true),
    io(0x6400, 0x6400, &[Integer8], false),
    io(0x6401, 0x6401, &[Integer16], false),
    io(0x6402, 0x6402, &[Integer32], false),
    io(0x6403, 0x6403, &[Real32], false),
    io(0x6410, 0x6410, &[Integer8], true),
    io(0x6411, 0x6411, &[Integer16], true),
    io(0x6412, 0x6412, &[Integer32], true),
    io(0x6413, 0x6413, &[Real32], true),
    io(0x6421, 0x6421, &[Unsigned8], true),
    io(0x6422, 0x6422, &[Unsigned32], false),
    // A byte in many devices, as a BOOLEAN is on the bus.
    rw(0x6423, &[Boolean, Unsigned8]),
    io(0x6424, 0x6425, &[Integer32], true),
    io(0x6426, 0x6428, &[Unsigned32], true),
    io(0x6429, 0x642F, &[Real32], true),
    array(0x6430, 0x6430, &[Unsigned32], None),
    io(0x6431, 0x6432, &[Integer32], true),
    io(0x6443, 0x6443, &[Unsigned8], true),
    io(0x6444, 0x6444, &[Integer32], true),
    io(0x6445, 0x6445, &[Real32], true),
    array(0x6450, 0x6450, &[Unsigned32], None),
];

/// Objects of one axis; those of the others are 800h apart.
const DRIVE: &[Object] = &[
    rw(0x6007, &[Integer16]),
    ro(0x603F, &[Unsigned16]),
    rw(0x6040, &[Unsigned16]),
    ro(0x6041, &[Unsigned16]),
    var(0x6042, &[Integer16]),
    ro(0x6043, &[Integer16]),
    ro(0x6044, &[Integer16]),
    var(0x605A, &[Integer16]),
    var(0x605B, &[Integer16]),
    var(0x605C, &[Integer16]),
    var(0x605D, &[Integer16]),
    var(0x605E, &[Integer16]),
    var(0x6060, &[Integer8]),
    ro(0x6061, &[Integer8]),
    ro(0x6062, &[Integer32]),
    ro(0x6063, &[Integer32]),
    ro(0x6064, &[Integer32]),
    var(0x6065, &[Unsigned32]),
    var(0x6066, &[Unsigned16]),
    var(0x6067, &[Unsigned32]),
    var(0x6068, &[Unsigned16]),
    ro(0x6069, &[Integer32]),
    ro(0x606B, &[Integer32]),
    ro(0x606C, &[Integer32]),
    var(0x606D, &[Unsigned16]),
    var(0x606E, &[Unsigned16]),
    var(0x606F, &[Unsigned16]),
    var(0x6070, &[Unsigned16]),
    var(0x6071, &[Integer16]),
    var(0x6072, &[Unsigned16]),
    var(0x6073, &[Unsigned16]),
    ro(0x6074, &[Integer16]),
    var(0x6075, &[Unsigned32]),
    var(0x6076, &[Unsigned32]),
    ro(0x6077, &[Integer16]),
    ro(0x6078, &[Integer16]),
    ro(0x6079, &[Unsigned32]),
    var(0x607A, &[Integer32]),
    array(0x607B, 0x607B, &[Integer32], None),
    var(0x607C, &[Integer32]),
    array(0x607D, 0x607D, &[Integer32], None),
    var(0x607E, &[Unsigned8]),
    var(0x607F, &[Unsigned32]),
    var(0x6080, &[Unsigned32]),
    var(0x6081, &[Unsigned32]),
    var(0x6082, &[Unsigned32]),
    var(0x6083, &[Unsigned32]),
    var(0x6084, &[Unsigned32]),
    var(0x6085, &[Unsigned32]),
    var(0x6086, &[Integer16]),
    var(0x6087, &[Unsigned32]),
    array(0x608F, 0x6092, &[Unsigned32, Integer32], None),
    var(0x6098, &[Integer8]),
    array(0x6099, 0x6099, &[Unsigned32], None),
    var(0x609A, &[Unsigned32]),
    var(0x60B0, &[Integer32]),
    var(0x60B1, &[Integer32]),
    var(0x60B2, &[Integer16]),
    var(0x60B8, &[Unsigned16]),
    ro(0x60B9, &[Unsigned16]),
    var(0x60C5, &[Unsigned32]),
    var(0x60C6, &[Unsigned32]),
    ro(0x60F4, &[Integer32]),
    ro(0x60FC, &[Integer32]),
    ro(0x60FD, &[Unsigned32]),
    array(0x60FE, 0x60FE, &[Unsigned32], None),
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
