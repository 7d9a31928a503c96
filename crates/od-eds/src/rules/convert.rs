//! Rules whose codes begin with 11: targets of `odkit convert` that cannot express the whole description. A warning is about a
//! loss that a master sees on the bus; a remark is about any other loss.

use od_model::{Address, DataType};

use crate::fact::{Fact, Key};
use crate::finding::{Finding, Form, Rule};
use crate::span::Span;

table! {
    W1101 (example)
    W1102 (example)
    W1103 (example)
    W1104 (example)
    W1105 (example)
    I1106 (example)
    I1107 (example)
    I1108 (example)
    W1109 (example)
    W1110 (example)
    W1111 (example)
    W1112 (example)
    W1113 (example)
}

pub(crate) static W1101: Rule = Rule {
    title: "CANopenNode has no storage for the value",
    why: "OD.c has a variable for each value, and its length does not change. A DOMAIN or OCTET_STRING without a default value has no length, so the node aborts each request for it with 06090011h until the application provides the data.",
    source: "CANopenNode 4, 301/CO_ODinterface.h: OD_stream_t",
    example: "[2100] DataType=0x000F, without a DefaultValue",
    says: "OD.c has no storage for a {type} without a default value",
    help: "provide the data by `OD_extension_init`, or add a DefaultValue",
    ..Rule::of("W1101")
};

pub(crate) fn w1101_no_storage(address: Address, section: Span, data_type: DataType) -> Finding {
    W1101.at(section).about(address).fact("type", data_type)
}

pub(crate) static W1102: Rule = Rule {
    title: "CANopenNode does not add the node ID to the value",
    why: "CANopenNode adds the node ID to the COB-IDs of the pre-defined connection set: 1014h, 1200h, 1400h to 1403h and 1800h to 1803h. Every other value of OD.c is the same for all node IDs; odkit writes it without the node ID.",
    source: "CANopenNode 4, 301/CO_PDO.c, 301/CO_Emergency.c, 301/CO_SDOserver.c",
    example: "[2100] DefaultValue=$NODEID+0x10",
    says: "{DefaultValue} depends on the node ID, and CANopenNode does not add it here",
    help: "add `--node-id 5` to write the value of one node",
    ..Rule::of("W1102")
};

/// The finding about a default with `$NODEID`.
pub(crate) fn w1102_node_id_not_added(address: Address, value: Span) -> Finding {
    W1102.at(value).about(address).key(Key::DefaultValue)
}

pub(crate) static W1103: Rule = Rule {
    title: "CANopenNode adds the node ID to a fixed COB-ID",
    why: "CANopenNode takes a COB-ID of the pre-defined connection set without node ID for one that follows the node ID: a node with node ID 5 sends 185h where 1800h:01 is 180h. A master that expects the fixed COB-ID does not hear the node.",
    source: "CANopenNode 4, 301/CO_PDO.c, 301/CO_Emergency.c",
    example: "[1800sub1] DefaultValue=0x180",
    says: "CANopenNode adds the node ID to COB-ID {id:03X}h",
    help: "write `{DefaultValue=$NODEID+0x{id:X}}` if it follows the node ID, or another COB-ID",
    ..Rule::of("W1103")
};

pub(crate) fn w1103_node_id_added(address: Address, value: Span, id: u32) -> Finding {
    let finding = W1103.at(value).about(address).key(Key::DefaultValue);
    finding.fact("id", i128::from(id))
}

pub(crate) static W1104: Rule = Rule {
    title: "CANopenNode cannot serve the PDO",
    why: "CANopenNode takes the PDOs one after the other, from 1400h, 1600h, 1800h and 1A00h on, and each has at most 8 mapping entries. After a gap it serves another PDO than the master configures; a PDO with more entries is not valid.",
    source: "CANopenNode 4, CANopen.c: CO_CANopenInitPDO; 301/CO_PDO.h: CO_PDO_MAX_MAPPED_ENTRIES",
    example: "[1400], [1402], without [1401]",
    says: "CANopenNode needs {missing}, since it takes PDOs one after the other",
    help: "add {section}; it may be a PDO that is not valid (bit 31 of its COB-ID)",
    also: &[W1104_MANY],
    ..Rule::of("W1104")
};

const W1104_MANY: Form = Form {
    says: "{count:mapping entry|mapping entries} of a PDO; CANopenNode has 8",
    help: "map at most 8 objects",
};

pub(crate) fn w1104_gap(missing: u16) -> Finding {
    let finding = W1104.finding().about(Address::new(missing, 0));
    let finding = finding.fact("missing", Fact::Index(missing));
    finding.fact("section", Fact::Section(missing, None))
}

pub(crate) fn w1104_many(address: Address, value: Span, count: i128) -> Finding {
    let finding = W1104.at(value).about(address).form(&W1104_MANY);
    finding.fact("count", count)
}

pub(crate) static W1105: Rule = Rule {
    title: "CANopenNode has no row for the object",
    why: "The list of objects of OD.c ends at index 0, and an object has at most 255 sub-objects. odkit leaves out the object, or its last sub-object; a node aborts each request for it.",
    source: "CANopenNode 4, 301/CO_ODinterface.h: OD_entry_t",
    example: "[2100], an ARRAY with sub-indices 0 to 255",
    says: "an object dictionary of CANopenNode cannot have this object",
    ..Rule::of("W1105")
};

/// The finding about an object, or a sub-object, that is left out.
pub(crate) fn w1105_object_without_row(address: Address, section: Span) -> Finding {
    W1105.at(section).about(address)
}

pub(crate) static I1106: Rule = Rule {
    title: "CANopenNode does not check limits",
    why: "OD.c has no LowLimit and no HighLimit: the node accepts each value that a master writes. The application checks it in the `write` function of an extension.",
    source: "CANopenNode 4, 301/CO_ODinterface.h: OD_extension_t",
    example: "[2100] LowLimit=1",
    says: "the node does not check the limits of {count:value|values}",
    help: "check them in the `write` function of an `OD_extension_t`",
    ..Rule::of("I1106")
};

pub(crate) fn i1106_limits_not_checked(count: usize) -> Finding {
    I1106.finding().fact("count", count as i128)
}

pub(crate) static I1107: Rule = Rule {
    title: "CANopenNode needs an object that is missing",
    why: "OD.c compiles, but CANopen.c does not, or its init functions fail, unless the services of these objects are off in CO_driver_target.h: heartbeat consumer (1016h), SYNC producer (1006h), EMCY (1003h, 1014h).",
    source: "CANopenNode 4, CANopen.c and 301/CO_config.h",
    example: "a file without [1016]",
    says: "CANopenNode needs {objects}, unless CO_driver_target.h switches the service off",
    help: "add the objects, or set CO_CONFIG_EM, CO_CONFIG_HB_CONS or CO_CONFIG_SYNC in CO_driver_target.h",
    ..Rule::of("I1107")
};

pub(crate) fn i1107_needed_object_missing(missing: impl Iterator<Item = u16>) -> Finding {
    let missing = missing.map(Fact::Index).collect();
    I1107.finding().fact("objects", Fact::List(missing))
}

pub(crate) static I1108: Rule = Rule {
    title: "CANopenNode maps single bits only on request",
    why: "CANopenNode maps whole bytes unless CO_CONFIG_PDO has CO_CONFIG_PDO_BITWISE_MAPPING; without it the PDO is not valid.",
    source: "CANopenNode 4, 301/CO_config.h: CO_CONFIG_PDO_BITWISE_MAPPING",
    example: "[1A00sub1] DefaultValue=0x20000001",
    says: "a mapping entry of {bits:bit|bits} needs CO_CONFIG_PDO_BITWISE_MAPPING",
    help: "add it to CO_CONFIG_PDO",
    ..Rule::of("I1108")
};

pub(crate) fn i1108_single_bits_on_request(address: Address, value: Span, bits: u8) -> Finding {
    let finding = I1108.at(value).about(address);
    finding.fact("bits", i128::from(bits))
}

pub(crate) static W1109: Rule = Rule {
    title: "CANopenNode does not start without the object",
    why: "CO_CANopenInit returns CO_ERROR_ILLEGAL_ARGUMENT: EMCY needs 1001h and the NMT slave needs 1017h, whatever CO_driver_target.h says.",
    source: "CANopenNode 4, CANopen.c: CO_CANopenInit; 301/CO_NMT_Heartbeat.c: CO_NMT_init",
    example: "a file without [1017]",
    says: "CANopenNode does not start without {object}",
    help: "add {section}; a 1017h of 0 sends no heartbeat",
    ..Rule::of("W1109")
};

pub(crate) fn w1109_cannot_start(missing: u16) -> Finding {
    let finding = W1109.finding().about(Address::new(missing, 0));
    let finding = finding.fact("object", Fact::Index(missing));
    finding.fact("section", Fact::Section(missing, None))
}

pub(crate) static W1110: Rule = Rule {
    title: "DBC cannot describe a multiplexed PDO",
    why: "The frames of a multiplexed PDO name the object that they carry (CiA 301, MPDO), so it has no signals. odkit leaves the message out.",
    source: "CiA 301, multiplexed PDO",
    example: "[1A00sub0] DefaultValue=255",
    says: "DBC cannot describe a multiplexed PDO",
    ..Rule::of("W1110")
};

pub(crate) fn w1110_multiplexed_pdo(mapping: Address) -> Finding {
    W1110.finding().about(mapping)
}

pub(crate) static W1111: Rule = Rule {
    title: "mapped object has no room in the message",
    why: "A PDO has 64 bits. odkit leaves out the object that does not fit, and those after it.",
    source: "CiA 301, PDO mapping",
    example: "[1A00sub3] maps 32 bits after 64",
    says: "{mapped} has no room in the 64 bits of the PDO",
    help: "remove a mapping entry, or map a shorter object",
    ..Rule::of("W1111")
};

pub(crate) fn w1111_no_room_in_message(pdo: Address, mapped: Address) -> Finding {
    let finding = W1111.finding().about(pdo);
    finding.fact("mapped", Fact::Object(mapped))
}

pub(crate) static W1112: Rule = Rule {
    title: "DBC has only numbers",
    why: "A signal of a DBC is a number. odkit writes the bits of a string or DOMAIN as an unsigned number, lowest byte first.",
    source: "DBC file format, signals",
    example: "[1A00sub1] maps a VISIBLE_STRING",
    says: "the mapped {type} is written as an unsigned number",
    ..Rule::of("W1112")
};

pub(crate) fn w1112_not_a_number(mapped: Address, data_type: DataType) -> Finding {
    W1112.finding().about(mapped).fact("type", data_type)
}

pub(crate) static W1113: Rule = Rule {
    title: "two messages of a node have one CAN-ID",
    why: "A DBC has one message for a CAN-ID. odkit keeps the first one in the order SYNC, TIME, EMCY, TPDO, RPDO, SDO, heartbeat.",
    source: "DBC file format, messages",
    example: "[1801sub1] DefaultValue=$NODEID+0x180",
    says: "another message has CAN-ID {id:03X}h",
    help: "write another COB-ID, or `--node-id` for the node ID of the device",
    ..Rule::of("W1113")
};

pub(crate) fn w1113_same_can_id(cob_id: Address, id: u32) -> Finding {
    let finding = W1113.finding().about(cob_id);
    finding.fact("id", i128::from(id))
}
