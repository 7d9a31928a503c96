//! Objects 1000h to 1FFFh: CiA 301, and CiA 302.

use od_model::{Access, DataType, ObjectCode};

/// One object, or a range of objects of the same kind.
pub(crate) struct Standard {
    first: u16,
    last: u16,
    /// Its name in the standard.
    pub(crate) name: &'static str,
    pub(crate) members: Members,
    /// Index of an object that it needs; 0: none.
    pub(crate) needs: u16,
}

/// Its object code, and the values in it.
pub(crate) enum Members {
    /// A VAR.
    Var(Value),
    /// An ARRAY, with the value of each sub-object from sub-index 1 on.
    Array(Value),
    /// A RECORD: sub-index, value, and whether the sub-object is mandatory.
    Record(&'static [(u8, Value, bool)]),
}

/// Type and access of a value.
pub(crate) struct Value {
    pub(crate) data_type: DataType,
    pub(crate) access: Access,
}

impl Standard {
    /// Returns the same object, which also needs another one.
    const fn needs(self, other: u16) -> Self {
        Self {
            needs: other,
            ..self
        }
    }

    pub(crate) const fn code(&self) -> ObjectCode {
        match self.members {
            Members::Var(_) => ObjectCode::Var,
            Members::Array(_) => ObjectCode::Array,
            Members::Record(_) => ObjectCode::Record,
        }
    }

    /// The value that the standard specifies for a sub-index.
    pub(crate) fn value(&self, sub: u8) -> Option<&Value> {
        match &self.members {
            Members::Var(value) if sub == 0 => Some(value),
            Members::Array(value) if (1..=254).contains(&sub) => Some(value),
            Members::Record(members) => {
                let found = members.iter().find(|(known, _, _)| *known == sub);
                found.map(|(_, value, _)| value)
            }
            _ => None,
        }
    }

    /// Returns whether an object of this code has the same values on the bus.
    pub(crate) fn is_like(&self, own: ObjectCode) -> bool {
        let right = self.code();
        // An ARRAY and a RECORD with one type are the same on the bus, and so are a VAR of type
        // DOMAIN and an object of code DOMAIN.
        own == right
            || own.has_members() && right.has_members()
            || matches!((own, right), (ObjectCode::Domain, ObjectCode::Var))
    }

    /// The standard that defines it.
    pub(crate) const fn source(&self) -> &'static str {
        match self.first {
            0x1F00..=0x1F9F => "CiA 302",
            _ => "CiA 301",
        }
    }
}

/// An object of CiA 301 or CiA 302, for texts.
pub struct Specified {
    /// Its name in the standard.
    pub name: &'static str,
    /// The standard that defines it.
    pub source: &'static str,
    /// VAR, ARRAY or RECORD.
    pub code: ObjectCode,
    /// Access to its value, or to sub-index 1.
    pub access: Access,
}

/// The object that CiA 301 or CiA 302 specifies at an index.
pub fn specified(index: u16) -> Option<Specified> {
    let standard = of(index)?;
    let first = standard.value(0).or_else(|| standard.value(1));
    Some(Specified {
        name: standard.name,
        source: standard.source(),
        code: standard.code(),
        access: first.map_or(Access::Rw, |value| value.access),
    })
}

/// The type of a value of an object of the standards, or of a sub-object of the records 0020h to
/// 0023h. `is_whole`: the only value of a VAR.
pub fn data_type(index: u16, sub: u8, is_whole: bool) -> Option<DataType> {
    let members = match (index, is_whole) {
        (0x20, false) => TPDO,
        (0x22, false) => SDO_CLIENT,
        (0x23, false) => IDENTITY,
        (0x21, false) => &[],
        _ => {
            let standard = of(index)?;
            return match (&standard.members, is_whole, sub) {
                (Members::Var(value), true, _) => Some(value.data_type),
                (Members::Var(_), false, _) | (_, true, _) => None,
                (_, _, 0) => Some(Unsigned8),
                (Members::Record([]), _, _) => mapped(sub),
                _ => standard.value(sub).map(|value| value.data_type),
            };
        }
    };
    match (sub, members) {
        (0, _) => Some(Unsigned8),
        (_, []) => mapped(sub),
        _ => {
            let found = members.iter().find(|(known, _, _)| *known == sub);
            found.map(|(_, value, _)| value.data_type)
        }
    }
}

/// The type of a mapping entry.
const fn mapped(sub: u8) -> Option<DataType> {
    match sub {
        1..=64 => Some(Unsigned32),
        _ => None,
    }
}

/// Returns whether a standard specifies an ARRAY at this index.
pub(crate) fn is_standard_array(index: u16) -> bool {
    of(index).is_some_and(|standard| matches!(standard.members, Members::Array(_)))
}

/// Returns whether the sub-indices of an object are the node IDs of other devices, so that any of them may be missing.
pub(crate) const fn has_node_ids(index: u16) -> bool {
    matches!(index, 0x1028 | 0x1F20..=0x1F22 | 0x1F25..=0x1F27 | 0x1F81..=0x1F88 | 0x1F8A)
}

/// The entry of an index.
pub(crate) fn of(index: u16) -> Option<&'static Standard> {
    let at = TABLE.partition_point(|entry| entry.last < index);
    TABLE.get(at).filter(|entry| entry.first <= index)
}

const fn value(data_type: DataType, access: Access) -> Value {
    Value { data_type, access }
}

const fn var(index: u16, name: &'static str, data_type: DataType, access: Access) -> Standard {
    Standard {
        first: index,
        last: index,
        name,
        members: Members::Var(value(data_type, access)),
        needs: 0,
    }
}

const fn array(index: u16, name: &'static str, data_type: DataType, access: Access) -> Standard {
    Standard {
        first: index,
        last: index,
        name,
        members: Members::Array(value(data_type, access)),
        needs: 0,
    }
}

const fn record(
    first: u16,
    last: u16,
    name: &'static str,
    members: &'static [(u8, Value, bool)],
) -> Standard {
    Standard {
        first,
        last,
        name,
        members: Members::Record(members),
        needs: 0,
    }
}

use Access::{Const, Ro, Rw, Wo};
use DataType::{Domain, OctetString, Unsigned8, Unsigned16, Unsigned32, Unsigned64, VisibleString};

const IDENTITY: &[(u8, Value, bool)] = &[
    (1, value(Unsigned32, Ro), true),
    (2, value(Unsigned32, Ro), false),
    (3, value(Unsigned32, Ro), false),
    (4, value(Unsigned32, Ro), false),
];

const OS_COMMAND: &[(u8, Value, bool)] = &[
    (1, value(OctetString, Wo), true),
    (2, value(Unsigned8, Ro), true),
    (3, value(OctetString, Ro), true),
];

/// An ARRAY in the standard, although each sub-object has its own access.
const OS_PROMPT: &[(u8, Value, bool)] = &[
    (1, value(Unsigned8, Wo), true),
    (2, value(Unsigned8, Ro), true),
    (3, value(Unsigned8, Ro), false),
];

/// The server that the pre-defined connection set specifies.
const DEFAULT_SDO: &[(u8, Value, bool)] = &[
    (1, value(Unsigned32, Ro), true),
    (2, value(Unsigned32, Ro), true),
    (3, value(Unsigned8, Rw), false),
];

const SDO_SERVER: &[(u8, Value, bool)] = &[
    (1, value(Unsigned32, Rw), true),
    (2, value(Unsigned32, Rw), true),
    (3, value(Unsigned8, Rw), false),
];

const SDO_CLIENT: &[(u8, Value, bool)] = &[
    (1, value(Unsigned32, Rw), true),
    (2, value(Unsigned32, Rw), true),
    (3, value(Unsigned8, Rw), true),
];

const RPDO: &[(u8, Value, bool)] = &[
    (1, value(Unsigned32, Rw), true),
    (2, value(Unsigned8, Rw), true),
    (3, value(Unsigned16, Rw), false),
    (4, value(Unsigned8, Rw), false),
    (5, value(Unsigned16, Rw), false),
];

const TPDO: &[(u8, Value, bool)] = &[
    (1, value(Unsigned32, Rw), true),
    (2, value(Unsigned8, Rw), true),
    (3, value(Unsigned16, Rw), false),
    (4, value(Unsigned8, Rw), false),
    (5, value(Unsigned16, Rw), false),
    (6, value(Unsigned8, Rw), false),
];

/// The objects by ascending index.
const TABLE: &[Standard] = &[
    var(0x1000, "device type", Unsigned32, Ro),
    var(0x1001, "error register", Unsigned8, Ro),
    var(0x1002, "manufacturer status register", Unsigned32, Ro),
    array(0x1003, "pre-defined error field", Unsigned32, Ro),
    var(0x1005, "COB-ID SYNC message", Unsigned32, Rw),
    var(0x1006, "communication cycle period", Unsigned32, Rw).needs(0x1005),
    var(0x1007, "synchronous window length", Unsigned32, Rw).needs(0x1005),
    var(0x1008, "manufacturer device name", VisibleString, Const),
    var(
        0x1009,
        "manufacturer hardware version",
        VisibleString,
        Const,
    ),
    var(
        0x100A,
        "manufacturer software version",
        VisibleString,
        Const,
    ),
    var(0x100C, "guard time", Unsigned16, Rw).needs(0x100D),
    var(0x100D, "life time factor", Unsigned8, Rw).needs(0x100C),
    array(0x1010, "store parameters", Unsigned32, Rw).needs(0x1011),
    array(0x1011, "restore default parameters", Unsigned32, Rw).needs(0x1010),
    var(0x1012, "COB-ID time stamp message", Unsigned32, Rw),
    var(0x1013, "high resolution time stamp", Unsigned32, Rw),
    var(0x1014, "COB-ID EMCY", Unsigned32, Rw),
    var(0x1015, "inhibit time EMCY", Unsigned16, Rw).needs(0x1014),
    array(0x1016, "consumer heartbeat time", Unsigned32, Rw),
    var(0x1017, "producer heartbeat time", Unsigned16, Rw),
    record(0x1018, 0x1018, "identity object", IDENTITY),
    var(0x1019, "synchronous counter overflow value", Unsigned8, Rw).needs(0x1005),
    array(0x1020, "verify configuration", Unsigned32, Rw),
    var(0x1021, "store EDS", Domain, Ro),
    var(0x1022, "store format", Unsigned16, Ro).needs(0x1021),
    record(0x1023, 0x1023, "OS command", OS_COMMAND),
    var(0x1024, "OS command mode", Unsigned8, Wo).needs(0x1023),
    record(0x1025, 0x1025, "OS debugger interface", OS_COMMAND),
    record(0x1026, 0x1026, "OS prompt", OS_PROMPT),
    array(0x1027, "module list", Unsigned16, Ro),
    array(0x1028, "emergency consumer object", Unsigned32, Rw),
    array(0x1029, "error behavior object", Unsigned8, Rw),
    var(0x102A, "NMT inhibit time", Unsigned16, Rw),
    record(0x1200, 0x1200, "SDO server parameter", DEFAULT_SDO),
    record(0x1201, 0x127F, "SDO server parameter", SDO_SERVER),
    record(0x1280, 0x12FF, "SDO client parameter", SDO_CLIENT),
    record(0x1400, 0x15FF, "RPDO communication parameter", RPDO),
    record(0x1600, 0x17FF, "RPDO mapping parameter", &[]),
    record(0x1800, 0x19FF, "TPDO communication parameter", TPDO),
    record(0x1A00, 0x1BFF, "TPDO mapping parameter", &[]),
    array(0x1F20, "store DCF", Domain, Rw),
    array(0x1F21, "store format", Unsigned8, Rw).needs(0x1F20),
    array(0x1F22, "concise DCF", Domain, Rw),
    array(0x1F23, "store EDS of NMT slaves", Domain, Rw),
    array(0x1F24, "store format of EDS", Unsigned8, Rw).needs(0x1F23),
    // Each master.dcf of dcfgen has UNSIGNED8: W0631 accepts it.
    array(0x1F25, "request configuration", Unsigned32, Wo),
    array(0x1F26, "expected configuration date", Unsigned32, Rw).needs(0x1F27),
    array(0x1F27, "expected configuration time", Unsigned32, Rw).needs(0x1F26),
    array(0x1F50, "program data", Domain, Wo),
    // A device may have it without 1F50h: a master starts the boot loader with it, and only the boot loader has 1F50h.
    array(0x1F51, "program control", Unsigned8, Rw),
    array(0x1F53, "expected software date", Unsigned32, Rw).needs(0x1F54),
    array(0x1F54, "expected software time", Unsigned32, Rw).needs(0x1F53),
    array(0x1F55, "expected software identification", Unsigned32, Rw),
    array(0x1F56, "program software identification", Unsigned32, Ro),
    array(0x1F57, "flash status identification", Unsigned32, Ro),
    var(0x1F80, "NMT startup", Unsigned32, Rw),
    array(0x1F81, "NMT slave assignment", Unsigned32, Rw).needs(0x1F80),
    array(0x1F82, "request NMT", Unsigned8, Rw),
    array(0x1F83, "request node guarding", Unsigned8, Rw),
    array(0x1F84, "device type identification", Unsigned32, Rw).needs(0x1F81),
    array(0x1F85, "vendor identification", Unsigned32, Rw).needs(0x1F81),
    array(0x1F86, "product code", Unsigned32, Rw).needs(0x1F81),
    array(0x1F87, "revision number", Unsigned32, Rw).needs(0x1F81),
    array(0x1F88, "serial number", Unsigned32, Rw).needs(0x1F81),
    var(0x1F89, "boot time", Unsigned32, Rw).needs(0x1F81),
    array(0x1F8A, "restore configuration", Unsigned8, Rw).needs(0x1F81),
    array(
        0x1F90,
        "NMT flying master timing parameters",
        Unsigned16,
        Rw,
    )
    .needs(0x1F80),
    array(
        0x1F91,
        "self starting nodes timing parameters",
        Unsigned16,
        Rw,
    )
    .needs(0x1F80),
    Standard {
        first: 0x1FA0,
        last: 0x1FCF,
        name: "object scanner list",
        members: Members::Array(value(Unsigned32, Rw)),
        needs: 0,
    },
    Standard {
        first: 0x1FD0,
        last: 0x1FFF,
        name: "object dispatching list",
        members: Members::Array(value(Unsigned64, Rw)),
        needs: 0,
    },
];

#[cfg(test)]
pub(super) mod tests {
    use super::*;

    /// The index ranges of the table.
    pub(in crate::standards) fn ranges() -> impl Iterator<Item = (u16, u16)> {
        TABLE.iter().map(|entry| (entry.first, entry.last))
    }

    #[test]
    fn the_table_is_sorted_and_searched() {
        for pair in TABLE.windows(2) {
            assert!(pair[0].last < pair[1].first, "{:04X}", pair[1].first);
        }
        for entry in TABLE {
            assert!(entry.first <= entry.last);
            assert_eq!(of(entry.first).map(|found| found.name), Some(entry.name));
            assert_eq!(of(entry.last).map(|found| found.name), Some(entry.name));
        }
        for index in [0x0FFF, 0x1004, 0x102B, 0x1300, 0x1C00, 0x2000] {
            assert!(of(index).is_none(), "{index:04X}");
        }
    }

    #[test]
    fn the_types_of_values_are_those_of_the_standards() {
        for (index, sub, is_whole, data_type) in [
            (0x1000, 0, true, Some(Unsigned32)),
            (0x1000, 0, false, None),
            (0x1001, 0, true, Some(Unsigned8)),
            (0x1018, 0, false, Some(Unsigned8)),
            (0x1018, 4, false, Some(Unsigned32)),
            (0x1018, 5, false, None),
            (0x1018, 0, true, None),
            (0x1010, 127, false, Some(Unsigned32)),
            (0x1600, 0, false, Some(Unsigned8)),
            (0x1A00, 1, false, Some(Unsigned32)),
            (0x1BFF, 64, false, Some(Unsigned32)),
            (0x1BFF, 65, false, None),
            (0x2000, 0, true, None),
            // The records that the standard describes as types.
            (0x20, 0, false, Some(Unsigned8)),
            (0x20, 2, false, Some(Unsigned8)),
            (0x20, 3, false, Some(Unsigned16)),
            (0x21, 64, false, Some(Unsigned32)),
            (0x21, 65, false, None),
            (0x22, 1, false, Some(Unsigned32)),
            (0x23, 4, false, Some(Unsigned32)),
            (0x23, 5, false, None),
        ] {
            let found = super::data_type(index, sub, is_whole);
            assert_eq!(found, data_type, "{index:04X}:{sub:02X}");
        }
    }
}
