//! The messages of a DBC: mapped PDOs, and the frames of every node.

use alloc::collections::BTreeSet;
use alloc::string::{String, ToString};
use alloc::vec::Vec;
use alloc::{format, vec};

use super::names::{symbol, unique, unit};
use crate::description::{Description, EntryDescription, Value};
use crate::finding::Finding;
use crate::identifiers::{MappedValue, Service, Used, mapping, number};
use crate::rules::convert::{w1110_multiplexed_pdo, w1111_no_room_in_message, w1112_not_a_number};
use crate::span::Spanned;
use od_model::{Address, DataType, Kind};

/// Interpretation of the bits of a signal.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) enum Sign {
    Unsigned,
    Signed,
    Real,
}

/// Bits of a message; little-endian, with factor 1.
#[derive(Clone, Debug)]
pub(super) struct Signal {
    pub(super) name: String,
    pub(super) first: u32,
    pub(super) bits: u32,
    pub(super) sign: Sign,
    /// Limits of the object; `None` if it has none.
    pub(super) limits: Option<(i128, i128)>,
    pub(super) unit: String,
    /// Object and type; empty if the name is enough.
    pub(super) comment: String,
    /// Values that have names.
    pub(super) values: &'static [(u8, &'static str)],
}

#[derive(Clone, Debug)]
pub(super) struct Message {
    pub(super) name: String,
    /// CAN-ID, with bit 31 for one of 29 bits.
    pub(super) id: u32,
    pub(super) length: u32,
    /// Whether the node sends it; otherwise it receives it.
    pub(super) sends: bool,
    pub(super) signals: Vec<Signal>,
    pub(super) comment: String,
}

const STATES: &[(u8, &str)] = &[
    (0, "Boot-up"),
    (4, "Stopped"),
    (5, "Operational"),
    (127, "Pre-operational"),
];
const COMMANDS: &[(u8, &str)] = &[
    (1, "Start remote node"),
    (2, "Stop remote node"),
    (128, "Enter pre-operational"),
    (129, "Reset node"),
    (130, "Reset communication"),
];
const REQUESTS: &[(u8, &str)] = &[
    (0x22, "Download expedited"),
    (0x23, "Download 4 bytes"),
    (0x27, "Download 3 bytes"),
    (0x2B, "Download 2 bytes"),
    (0x2F, "Download 1 byte"),
    (0x21, "Download segmented"),
    (0x40, "Upload"),
    (0x80, "Abort"),
];
const RESPONSES: &[(u8, &str)] = &[
    (0x42, "Upload expedited"),
    (0x43, "Upload 4 bytes"),
    (0x47, "Upload 3 bytes"),
    (0x4B, "Upload 2 bytes"),
    (0x4F, "Upload 1 byte"),
    (0x41, "Upload segmented"),
    (0x60, "Download"),
    (0x80, "Abort"),
];

/// The frame of the NMT master, which every node receives.
pub(super) fn nmt() -> Message {
    let command = Signal {
        values: COMMANDS,
        ..plain("NMT_command", 0, 8)
    };
    Message {
        name: "NMT".into(),
        id: 0,
        length: 2,
        sends: false,
        signals: vec![command, plain("NMT_node_ID", 8, 8)],
        comment: "NMT commands; node ID 0 is for all nodes".into(),
    }
}

/// The message of a service; `None` if there is none to describe, perhaps with a finding.
pub(super) fn message(
    description: &Description,
    used: &Used,
    node: u8,
    found: &mut Vec<Finding>,
) -> Option<Message> {
    let own = |name: &str| format!("N{node}_{name}");
    let (name, length, signals) = match used.service {
        Service::Sync => {
            let counter = number(description, Address::new(0x1019, 0), node).unwrap_or(0);
            match counter {
                0 => ("SYNC".to_string(), 0, Vec::new()),
                _ => ("SYNC".to_string(), 1, vec![plain("SYNC_counter", 0, 8)]),
            }
        }
        Service::Time => {
            let after_midnight = Signal {
                unit: "ms".into(),
                ..plain("Time_after_midnight", 0, 28)
            };
            let days = Signal {
                unit: "d".into(),
                ..plain("Days_since_1984", 32, 16)
            };
            ("TIME".to_string(), 6, vec![after_midnight, days])
        }
        Service::Emcy => {
            let signals = vec![
                plain("Emergency_error_code", 0, 16),
                plain("Error_register", 16, 8),
                plain("Manufacturer_specific", 24, 40),
            ];
            (own("EMCY"), 8, signals)
        }
        Service::Heartbeat => {
            let state = Signal {
                values: STATES,
                ..plain("NMT_state", 0, 7)
            };
            (own("Heartbeat"), 1, vec![state, plain("Toggle_bit", 7, 1)])
        }
        Service::SdoRequest(server) => (own(&sdo("request", server)), 8, transfer(REQUESTS)),
        Service::SdoResponse(server) => (own(&sdo("response", server)), 8, transfer(RESPONSES)),
        Service::Tpdo(number) => {
            let (length, signals) = pdo(description, used, 0x19FF + number, found)?;
            (own(&format!("TPDO{number}")), length, signals)
        }
        Service::Rpdo(number) => {
            let (length, signals) = pdo(description, used, 0x15FF + number, found)?;
            (own(&format!("RPDO{number}")), length, signals)
        }
    };
    let comment = if used.is_valid {
        String::new()
    } else {
        "Not valid by default (bit 31 of its COB-ID)".into()
    };
    Some(Message {
        name,
        id: used.id | u32::from(used.is_extended) << 31,
        length,
        sends: used.sends,
        signals,
        comment,
    })
}

fn sdo(what: &str, server: u8) -> String {
    match server {
        1 => format!("SDO_{what}"),
        server => format!("SDO{server}_{what}"),
    }
}

/// The first frame of a transfer; segments have other content.
fn transfer(values: &'static [(u8, &'static str)]) -> Vec<Signal> {
    let command = Signal {
        values,
        ..plain("SDO_command", 0, 8)
    };
    vec![
        command,
        plain("SDO_index", 8, 16),
        plain("SDO_sub_index", 24, 8),
        plain("SDO_data", 32, 32),
    ]
}

fn plain(name: &str, first: u32, bits: u32) -> Signal {
    Signal {
        name: name.into(),
        first,
        bits,
        sign: Sign::Unsigned,
        limits: None,
        unit: String::new(),
        comment: String::new(),
        values: &[],
    }
}

/// Length and signals of a PDO.
fn pdo(
    description: &Description,
    used: &Used,
    index: u16,
    found: &mut Vec<Finding>,
) -> Option<(u32, Vec<Signal>)> {
    let Some(mapped) = mapping(description, index) else {
        found.push(w1110_multiplexed_pdo(Address::new(index, 0)));
        return None;
    };
    let mut names = BTreeSet::new();
    let (mut signals, mut first) = (Vec::new(), 0);
    for value in mapped {
        let bits = u32::from(value.bits);
        if first + bits > 64 {
            found.push(w1111_no_room_in_message(used.address, value.address));
            break;
        }
        if !value.is_dummy() && bits > 0 {
            let mut signal = signal(description, value, first, found);
            signal.name = unique(&mut names, signal.name);
            signals.push(signal);
        }
        first += bits;
    }
    (first > 0).then_some((first.div_ceil(8), signals))
}

fn signal(
    description: &Description,
    value: MappedValue,
    first: u32,
    found: &mut Vec<Finding>,
) -> Signal {
    let MappedValue { address, bits } = value;
    let data_type = value.data_type(description);
    let kind = data_type.map(DataType::kind);
    if matches!(kind, Some(Kind::Text | Kind::Bytes)) {
        found.extend(data_type.map(|data_type| w1112_not_a_number(address, data_type)));
    }
    let sign = match kind {
        Some(Kind::Signed) => Sign::Signed,
        // A part of a REAL is not a REAL.
        Some(Kind::Real) if data_type.and_then(DataType::bits) == Some(bits) => Sign::Real,
        _ => Sign::Unsigned,
    };
    let object = description.objects.get(&address.index);
    let entry = description.entry(address);
    let name = match (object, entry) {
        (Some(object), Some(entry)) if object.code.has_members() => {
            format!("{} {}", *object.name, *entry.name)
        }
        (_, Some(entry)) => (*entry.name).clone(),
        _ => String::from("Object"),
    };
    let shown = format!("{:04X}h:{:02X}", address.index, address.sub);
    let comment = match data_type {
        Some(data_type) => format!("{shown} {name} ({})", data_type.name()),
        None => format!("{shown}, which does not exist"),
    };
    Signal {
        name: symbol(&name),
        sign,
        limits: entry.filter(|_| sign != Sign::Real).and_then(limits),
        unit: unit(&name).into(),
        comment,
        ..plain("", first, bits.into())
    }
}

/// The limits of a value; a missing limit is that of the type.
fn limits(entry: &EntryDescription) -> Option<(i128, i128)> {
    let (smallest, largest) = entry.data_type?.integer_range()?;
    let limit = |limit: &Option<Spanned<Value>>| limit.as_ref()?.integer(0);
    let (low, high) = (limit(&entry.low), limit(&entry.high));
    (low.is_some() || high.is_some()).then(|| (low.unwrap_or(smallest), high.unwrap_or(largest)))
}
