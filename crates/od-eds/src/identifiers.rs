//! CAN-IDs of a node and contents of its PDOs, as the start values of its description set them.

use alloc::format;
use alloc::vec::Vec;
use core::fmt;

use crate::description::Description;
use crate::subject::start_value;
use od_model::{Address, DataType};

/// A service of a node that has a CAN-ID of its own.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Debug)]
pub enum Service {
    /// SYNC, as a consumer or a producer.
    Sync,
    /// TIME.
    Time,
    /// EMCY messages.
    Emcy,
    /// A PDO that the node sends, from 1.
    Tpdo(u16),
    /// A PDO that the node receives, from 1.
    Rpdo(u16),
    /// Requests to the SDO server of this number, from 1.
    SdoRequest(u8),
    /// Responses of the SDO server of this number, from 1.
    SdoResponse(u8),
    /// Heartbeat, or responses of node guarding.
    Heartbeat,
}

impl fmt::Display for Service {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Sync => f.pad("SYNC"),
            Self::Time => f.pad("TIME"),
            Self::Emcy => f.pad("EMCY"),
            Self::Tpdo(number) => f.pad(&format!("TPDO {number}")),
            Self::Rpdo(number) => f.pad(&format!("RPDO {number}")),
            Self::SdoRequest(server) | Self::SdoResponse(server) => {
                f.pad(&format!("SDO server {server}"))
            }
            Self::Heartbeat => f.pad("heartbeat"),
        }
    }
}

/// A CAN-ID and the service that uses it.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct Used {
    /// The service.
    pub service: Service,
    /// The value that has the COB-ID; for a heartbeat 1017h.
    pub address: Address,
    /// CAN-ID, 11 or 29 bits.
    pub id: u32,
    /// Whether it has 29 bits.
    pub is_extended: bool,
    /// Whether the service is used: by bit 31 of a COB-ID, or bit 30 for SYNC and TIME.
    pub is_valid: bool,
    /// Whether the node sends frames with this CAN-ID.
    pub sends: bool,
}

/// The CAN-IDs of a node with this node ID, in the order of their services.
pub fn used(description: &Description, node: u8) -> Vec<Used> {
    let mut found = Vec::new();
    let number = |index, sub| number(description, Address::new(index, sub), node);
    // In SYNC and TIME bit 30 marks a producer; TIME has bit 31 for its consumer.
    for (service, index, valid, produce) in [
        (Service::Sync, 0x1005, 0, 1 << 30),
        (Service::Time, 0x1012, 3 << 30, 1 << 30),
    ] {
        if let Some(cob_id) = number(index, 0) {
            let is_valid = valid == 0 || cob_id & valid != 0;
            let sends = cob_id & produce != 0;
            found.push(of(service, (index, 0), cob_id, (is_valid, sends)));
        }
    }
    let has = |index: u16| description.objects.contains_key(&index);
    if has(0x1014) {
        let cob_id = number(0x1014, 0).unwrap_or(0x80 + u32::from(node));
        found.push(of(
            Service::Emcy,
            (0x1014, 0),
            cob_id,
            (cob_id >> 31 == 0, true),
        ));
    }
    for (first, base, sends) in [(0x1800, 0x180, true), (0x1400, 0x200, false)] {
        for (&index, _) in description.objects.range(first..first + 0x200) {
            let pdo = index - first;
            // The pre-defined connection set (CiA 301, chapter 7.3.3).
            let default = match pdo {
                0..=3 => base + 0x100 * u32::from(pdo) + u32::from(node),
                _ => 1 << 31,
            };
            let cob_id = number(index, 1).unwrap_or(default);
            let service = if sends { Service::Tpdo } else { Service::Rpdo };
            found.push(of(
                service(pdo + 1),
                (index, 1),
                cob_id,
                (cob_id >> 31 == 0, sends),
            ));
        }
    }
    for server in 0..0x80_u8 {
        let index = 0x1200 + u16::from(server);
        let default = |base: u32| match server {
            0 => base + u32::from(node),
            _ => 1 << 31,
        };
        if server == 0 || has(index) {
            let request = number(index, 1).unwrap_or(default(0x600));
            let response = number(index, 2).unwrap_or(default(0x580));
            let is_valid = (request | response) >> 31 == 0;
            let [to, from] = [Service::SdoRequest, Service::SdoResponse].map(|own| own(server + 1));
            found.push(of(to, (index, 1), request, (is_valid, false)));
            found.push(of(from, (index, 2), response, (is_valid, true)));
        }
    }
    let heartbeat = 0x700 + u32::from(node);
    found.push(of(Service::Heartbeat, (0x1017, 0), heartbeat, (true, true)));
    found
}

fn of(service: Service, at: (u16, u8), cob_id: u32, (is_valid, sends): (bool, bool)) -> Used {
    let is_extended = cob_id & 1 << 29 != 0;
    Used {
        service,
        address: Address::new(at.0, at.1),
        id: cob_id & if is_extended { 0x1FFF_FFFF } else { 0x7FF },
        is_extended,
        is_valid,
        sends,
    }
}

/// The start value as a number, on a node with this node ID.
pub fn number(description: &Description, address: Address, node: u8) -> Option<u32> {
    let value = start_value(description.entry(address)?)?;
    u32::try_from(value.integer(node)?).ok()
}

/// A mapping entry of a PDO: the mapped object and its number of bits.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct MappedValue {
    /// The mapped object.
    pub address: Address,
    /// Bits in the PDO.
    pub bits: u8,
}

impl MappedValue {
    /// Returns whether it only fills a gap (dummy mapping).
    pub fn is_dummy(&self) -> bool {
        self.address.index < 0x20
    }

    /// The type of the mapped object; `None` if it does not exist or has none.
    pub fn data_type(&self, description: &Description) -> Option<DataType> {
        Some(*description.entry(self.address)?.data_type?)
    }
}

/// The mapping entries of 1600h to 17FFh or 1A00h to 1BFFh that sub-index 0 counts; `None` for a
/// multiplexed PDO (254, 255).
pub fn mapping(description: &Description, index: u16) -> Option<Vec<MappedValue>> {
    let number = |sub| number(description, Address::new(index, sub), 0);
    let count = match number(0).unwrap_or(0) {
        254 | 255 => return None,
        count => u8::try_from(count.min(64)).unwrap_or(64),
    };
    let entries = (1..=count).filter_map(number).filter(|entry| *entry != 0);
    let entries = entries.map(|entry| {
        let [bits, sub, low, high] = entry.to_le_bytes();
        MappedValue {
            address: Address::new(u16::from_le_bytes([low, high]), sub),
            bits,
        }
    });
    Some(entries.collect())
}
