//! A node of a network.

use alloc::collections::BTreeMap;
use alloc::string::String;
use alloc::vec::Vec;

use super::concise::Write;
use crate::description::Description;
use crate::span::Span;
use crate::subject::start_value;
use od_model::Address;

/// A setting of a node, by its place in the project.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Setting {
    /// A key of the node.
    Key(&'static str),
    /// A PDO below the key, by its number.
    Pdo(&'static str, u16),
}

/// A node with the writes that configure it.
#[derive(Clone, Debug)]
pub struct Node {
    /// Its name in the network.
    pub name: String,
    /// Node ID, 1 to 127.
    pub id: u8,
    /// The description of the device.
    pub description: Description,
    /// The writes of its concise DCF, in their order.
    pub writes: Vec<Write>,
    /// The file from which the master reads them (1F22h); empty without a file.
    pub configuration_file: String,
    /// Identity that the master expects (1F87h, 1F88h); 0: any.
    pub revision_number: u32,
    /// Serial number that the master expects; 0: any.
    pub serial_number: u32,
    /// Factor between the heartbeat of the node and the consumer time of the master.
    pub heartbeat_multiplier: f64,
    /// Whether the node watches the heartbeat of the master.
    pub consumes_heartbeat: bool,
    /// Bits of 1F81h: boot, mandatory, …; with retry factor and guard time.
    pub assignment: u32,
    /// Settings for the partner PDO on the master, by the index of a PDO: inhibit time, event timer, SYNC start
    /// value, and the COB-ID, which a PDO of a project has even if it is not enabled.
    pub partners: BTreeMap<u16, [u32; 4]>,
    /// The program file of 1F58h, its version in 1F55h, and the sub-index of 1F8Ah.
    pub software: (String, u32, u8),
    /// Its place in the project or the node list; that of an empty span is not known.
    pub place: Span,
    /// The places of its settings.
    pub places: Vec<(Setting, Span)>,
}

impl Node {
    /// A node that its master boots, without configuration.
    pub fn new(name: String, id: u8, description: Description) -> Self {
        Self {
            name,
            id,
            description,
            writes: Vec::new(),
            configuration_file: String::new(),
            revision_number: 0,
            serial_number: 0,
            heartbeat_multiplier: 3.0,
            consumes_heartbeat: false,
            assignment: 0x0305,
            partners: BTreeMap::new(),
            software: (String::new(), 0, 0),
            place: Span::default(),
            places: Vec::new(),
        }
    }

    /// The place of a setting; that of the node if the project does not have the setting.
    pub(crate) fn place_of(&self, setting: Setting) -> Span {
        let found = self.places.iter().find(|(own, _)| *own == setting);
        found.map_or(self.place, |(_, span)| *span)
    }

    /// The time between two SYNC messages that it produces, in microseconds; 0 if it produces none.
    pub(super) fn sync_period(&self) -> u32 {
        match self.number(0x1005, 0) >> 30 & 1 {
            0 => 0,
            _ => self.number(0x1006, 0),
        }
    }

    pub(super) fn has(&self, index: u16) -> bool {
        self.description.objects.contains_key(&index)
    }

    pub(super) fn has_entry(&self, index: u16, sub: u8) -> bool {
        self.description.entry(Address::new(index, sub)).is_some()
    }

    /// The start value as a number; 0 if the file gives none.
    pub(super) fn number(&self, index: u16, sub: u8) -> u32 {
        let entry = self.description.entry(Address::new(index, sub));
        let number = entry
            .and_then(start_value)
            .and_then(|value| value.integer(self.id));
        number
            .and_then(|number| u32::try_from(number).ok())
            .unwrap_or(0)
    }

    /// A number of `[DeviceInfo]`, otherwise of the identity object.
    pub(super) fn identity(&self, key: &str, sub: u8) -> u32 {
        let info = self.description.section("DeviceInfo");
        let text = info.and_then(|info| info.get(key)).map(|text| text.trim());
        let number = text
            .filter(|text| !text.is_empty())
            .and_then(crate::scan::number::number);
        let number = number.and_then(|number| u32::try_from(number).ok());
        number.unwrap_or_else(|| self.number(0x1018, sub))
    }

    /// Sub-indices of an object above 0, by ascending number.
    pub(super) fn members(&self, index: u16) -> Vec<u8> {
        let object = self.description.objects.get(&index);
        let subs = object.map(|object| object.entries.keys().copied().filter(|sub| *sub > 0));
        subs.map(Iterator::collect).unwrap_or_default()
    }
}
