//! A device description: owned, editable, with the position of each part in the text.
//!
//! The EDS reader, the spec table of the macro and the patches of a variant make a [`Description`].
//! The checks read it, and the writer writes it. [`Tables`](crate::Tables) make the dictionary of a
//! node from it.

pub(crate) mod tables;

use alloc::collections::BTreeMap;
use alloc::format;
use alloc::string::String;
use alloc::vec::Vec;

use od_model::{Access, Address, DataType, Group, Kind, ObjectCode};

use crate::span::{Span, Spanned};

/// A default, a limit or a configured value, owned.
#[derive(Clone, PartialEq, Debug)]
pub enum Value {
    /// BOOLEAN, UNSIGNED, TIME_OF_DAY and TIME_DIFFERENCE.
    Unsigned(u64),
    /// INTEGER.
    Signed(i64),
    /// REAL32 and REAL64.
    Real(f64),
    /// `$NODEID+n`.
    NodeId(u32),
    /// VISIBLE_STRING.
    Text(String),
    /// OCTET_STRING, UNICODE_STRING and DOMAIN.
    Bytes(Vec<u8>),
}

impl Value {
    /// The number for a node with this ID; `None` for texts, bytes and reals.
    pub fn integer(&self, node_id: u8) -> Option<i128> {
        match self {
            Self::Unsigned(v) => Some(i128::from(*v)),
            Self::Signed(v) => Some(i128::from(*v)),
            Self::NodeId(offset) => Some(i128::from(*offset) + i128::from(node_id)),
            Self::Real(_) | Self::Text(_) | Self::Bytes(_) => None,
        }
    }

    /// Returns whether the value is in the range of the type; `$NODEID+n` has to be for every node ID.
    pub fn fits(&self, data_type: DataType) -> bool {
        match (data_type.kind(), self) {
            (Kind::Text, Self::Text(_)) | (Kind::Bytes, Self::Bytes(_)) => true,
            (Kind::Real, Self::Real(value)) => match data_type {
                DataType::Real32 => value.abs() <= f64::from(f32::MAX),
                _ => true,
            },
            (Kind::Unsigned, Self::NodeId(offset)) => {
                data_type.holds_node_id()
                    && data_type
                        .integer_range()
                        .is_some_and(|(_, high)| i128::from(*offset) + 127 <= high)
            }
            (_, Self::NodeId(_)) => false,
            (_, value) => match (value.integer(0), data_type.integer_range()) {
                (Some(value), Some((low, high))) => (low..=high).contains(&value),
                _ => false,
            },
        }
    }
}

/// One value of an object: a section of an EDS with a DataType.
///
/// Equality compares the content and ignores the place in the text.
#[derive(Clone, Debug)]
pub struct EntryDescription {
    /// ParameterName.
    pub name: Spanned<String>,
    /// DataType; `None` if it is missing or unknown, which is an error.
    pub data_type: Option<Spanned<DataType>>,
    /// AccessType.
    pub access: Spanned<Access>,
    /// PDOMapping.
    pub mappable: Spanned<bool>,
    /// DefaultValue.
    pub default: Option<Spanned<Value>>,
    /// LowLimit.
    pub low: Option<Spanned<Value>>,
    /// HighLimit.
    pub high: Option<Spanned<Value>>,
    /// ParameterValue of a DCF.
    pub parameter: Option<Spanned<Value>>,
    /// Sub-index of 1010h that saves it. `None` if the text gives none: then a value that a master
    /// can write belongs to the group of its index.
    pub group: Option<Spanned<Group>>,
    /// Room in the store for a string or DOMAIN, in bytes; a longer default makes it larger. 0: no room,
    /// because the application streams the value. `None`: 64, or 1,024 for a DOMAIN that a master can write.
    pub capacity: Option<u16>,
    /// ObjFlags; 0 if missing.
    pub flags: u32,
    /// Keys without a field in this version of odkit, in file order.
    pub extra: Vec<(String, String)>,
    /// The section header; for a macro call the token in its place.
    pub span: Span,
}

impl PartialEq for EntryDescription {
    fn eq(&self, other: &Self) -> bool {
        // List all fields by name, so that a new one is not forgotten.
        let Self {
            name,
            data_type,
            access,
            mappable,
            default,
            low,
            high,
            parameter,
            group,
            capacity,
            flags,
            extra,
            span: _,
        } = self;
        *name == other.name
            && *data_type == other.data_type
            && *access == other.access
            && *mappable == other.mappable
            && *default == other.default
            && *low == other.low
            && *high == other.high
            && *parameter == other.parameter
            && *group == other.group
            && *capacity == other.capacity
            && *flags == other.flags
            && *extra == other.extra
    }
}

impl EntryDescription {
    /// A read-only entry of this type and name, without limits; for tables and patches.
    pub fn new(name: impl Into<String>, data_type: DataType) -> Self {
        Self {
            name: Spanned::from(name.into()),
            data_type: Some(Spanned::from(data_type)),
            access: Spanned::from(Access::Ro),
            mappable: Spanned::from(false),
            default: None,
            low: None,
            high: None,
            parameter: None,
            group: None,
            capacity: None,
            flags: 0,
            extra: Vec::new(),
            span: Span::default(),
        }
    }

    /// The name that a DCF gives this value in its application (Denotation).
    pub fn denotation(&self) -> Option<&str> {
        let mut extra = self.extra.iter();
        let (_, value) = extra.find(|(key, _)| key.eq_ignore_ascii_case("Denotation"))?;
        (!value.is_empty()).then_some(value)
    }

    /// The group that saves this value at `address`.
    pub fn group_at(&self, address: Address) -> Group {
        match &self.group {
            Some(group) => group.value,
            // Commands and logs can be written, too, but hold nothing to save.
            None if matches!(address.index, 0x1003 | 0x1010 | 0x1011 | 0x1F50..=0x1F5F) => {
                Group::None
            }
            None if self.access.writable() && *self.access != Access::Wo => {
                Group::of_index(address.index)
            }
            None => Group::None,
        }
    }
}

/// One object: a VAR with one entry, or an ARRAY or RECORD with its members.
///
/// Equality compares the content and ignores the place in the text.
#[derive(Clone, Debug)]
pub struct ObjectDescription {
    /// ObjectType; VAR if the text gives none.
    pub code: Spanned<ObjectCode>,
    /// ParameterName of the object.
    pub name: Spanned<String>,
    /// SubNumber as given; counted if the text gives none for an object with members.
    pub sub_number: Option<Spanned<u32>>,
    /// The values by sub-index; a VAR has exactly sub-index 0.
    pub entries: BTreeMap<u8, EntryDescription>,
    /// ObjFlags; 0 if missing.
    pub flags: u32,
    /// Keys without a field in this version of odkit, in file order.
    pub extra: Vec<(String, String)>,
    /// The section header; for a macro call the token in its place.
    pub span: Span,
}

impl PartialEq for ObjectDescription {
    fn eq(&self, other: &Self) -> bool {
        let Self {
            code,
            name,
            sub_number,
            entries,
            flags,
            extra,
            span: _,
        } = self;
        *code == other.code
            && *name == other.name
            && *sub_number == other.sub_number
            && *entries == other.entries
            && *flags == other.flags
            && *extra == other.extra
    }
}

impl ObjectDescription {
    /// A VAR.
    pub fn var(entry: EntryDescription) -> Self {
        Self {
            code: Spanned::from(ObjectCode::Var),
            name: entry.name.clone(),
            sub_number: None,
            flags: 0,
            extra: Vec::new(),
            span: entry.span,
            entries: BTreeMap::from([(0, entry)]),
        }
    }
}

/// A section that describes no object: `[FileInfo]`, `[DeviceInfo]`, `[DummyUsage]` …
#[derive(Clone, PartialEq, Debug, Default)]
pub struct Section {
    /// The name between the brackets.
    pub name: Spanned<String>,
    /// Keys and values in file order.
    pub pairs: Vec<(Spanned<String>, Spanned<String>)>,
}

impl Section {
    /// The first value of `key`, in upper or lower case.
    pub fn get(&self, key: &str) -> Option<&Spanned<String>> {
        self.pairs
            .iter()
            .find(|(k, _)| k.eq_ignore_ascii_case(key))
            .map(|(_, v)| v)
    }
}

/// The whole content of an EDS or DCF.
#[derive(Clone, PartialEq, Debug, Default)]
pub struct Description {
    /// The sections that describe no object, in file order.
    pub sections: Vec<Section>,
    /// The objects.
    pub objects: BTreeMap<u16, ObjectDescription>,
}

impl Description {
    /// The first section with this name, in upper or lower case.
    pub fn section(&self, name: &str) -> Option<&Section> {
        self.sections
            .iter()
            .find(|s| s.name.eq_ignore_ascii_case(name))
    }

    /// The entry at an address.
    pub fn entry(&self, address: Address) -> Option<&EntryDescription> {
        self.objects.get(&address.index)?.entries.get(&address.sub)
    }

    /// Every entry with its address, in order.
    pub fn entries(&self) -> impl Iterator<Item = (Address, &EntryDescription)> {
        self.objects.iter().flat_map(|(index, object)| {
            object
                .entries
                .iter()
                .map(|(sub, entry)| (Address::new(*index, *sub), entry))
        })
    }

    /// The node and its network in a DCF's `[DeviceComissioning]`, in either
    /// spelling; empty or invalid values are left out.
    pub fn commissioning(&self) -> Option<Commissioning<'_>> {
        let section = self
            .section("DeviceComissioning")
            .or_else(|| self.section("DeviceCommissioning"))?;
        let text = |key| {
            let value = section.get(key)?;
            (!value.is_empty()).then_some(value.value.as_str())
        };
        let number = |key| crate::scan::number::number(section.get(key)?);
        let node_id = number("NodeID").and_then(|id| u8::try_from(id).ok());
        Some(Commissioning {
            node_id: node_id.filter(|id| (1..=127).contains(id)),
            node_name: text("NodeName"),
            bit_rate: number("Baudrate").and_then(|rate| u16::try_from(rate).ok()),
            network: number("NetNumber").and_then(|number| u32::try_from(number).ok()),
            network_name: text("NetworkName"),
            is_manager: number("CANopenManager").map(|flag| flag != 0),
            serial_number: number("LSS_SerialNumber").and_then(|n| u32::try_from(n).ok()),
        })
    }

    /// The node ID that a DCF's `[DeviceComissioning]` gives (either spelling), if it is 1–127.
    pub fn commissioned_node_id(&self) -> Option<u8> {
        self.commissioning()?.node_id
    }
}

/// One node and its network in a DCF (CiA 306-1, DeviceComissioning).
#[derive(Clone, Copy, PartialEq, Eq, Debug, Default)]
pub struct Commissioning<'a> {
    /// Node ID, 1–127; `None` for 255, which is a node without one.
    pub node_id: Option<u8>,
    /// NodeName.
    pub node_name: Option<&'a str>,
    /// Bit rate in kbit/s.
    pub bit_rate: Option<u16>,
    /// NetNumber.
    pub network: Option<u32>,
    /// NetworkName.
    pub network_name: Option<&'a str>,
    /// Whether the node is the CANopen manager.
    pub is_manager: Option<bool>,
    /// LSS_SerialNumber.
    pub serial_number: Option<u32>,
}

/// Bit rate in kbit/s at each index of the LSS bit timing table (CiA 305, chapter 6.4.3); index 5 is reserved.
const KBIT: [u16; 9] = [1000, 800, 500, 250, 125, 0, 50, 20, 10];

impl Description {
    /// Returns whether a key of `[DeviceInfo]` is present and not 0.
    pub fn info_is_set(&self, key: &str) -> bool {
        let info = self.section("DeviceInfo");
        let value = info.and_then(|info| info.get(key));
        let number = value.and_then(|value| od_model::values::integer(value.value.trim()));
        number.is_some_and(|number| number != 0)
    }

    /// Returns the bit rates that LSS can set, by their index in the bit timing table; all of the
    /// table if the file names none. `None`: the file lacks `LSS_Supported=1` (CiA 306-1).
    pub fn lss_bit_rates(&self) -> Option<[bool; 9]> {
        if !self.info_is_set("LSS_Supported") {
            return None;
        }
        let named = KBIT.map(|kbit| kbit != 0 && self.info_is_set(&format!("BaudRate_{kbit}")));
        Some(if named.contains(&true) {
            named
        } else {
            KBIT.map(|kbit| kbit != 0)
        })
    }
}

const COMMISSIONING: &str = "DeviceComissioning";

impl Description {
    /// Sets a key of `[DeviceComissioning]`, in the spelling of the file.
    ///
    /// ```
    /// let mut description = od_eds::Description::default();
    /// description.commission("NodeID", "5");
    /// assert_eq!(description.commissioned_node_id(), Some(5));
    /// ```
    pub fn commission(&mut self, key: &str, value: &str) {
        let is_it = |section: &Section| {
            let name = &section.name.value;
            name.eq_ignore_ascii_case(COMMISSIONING)
                || name.eq_ignore_ascii_case("DeviceCommissioning")
        };
        let at = match self.sections.iter().position(is_it) {
            Some(at) => at,
            None => {
                self.sections.push(Section {
                    name: Spanned::from(String::from(COMMISSIONING)),
                    pairs: Vec::new(),
                });
                self.sections.len() - 1
            }
        };
        let pairs = &mut self.sections[at].pairs;
        let value = Spanned::from(String::from(value));
        match pairs.iter_mut().find(|(k, _)| k.eq_ignore_ascii_case(key)) {
            Some((_, old)) => *old = value,
            None => pairs.push((Spanned::from(String::from(key)), value)),
        }
    }
}

impl Value {
    /// A value from its bytes on the bus.
    ///
    /// ```
    /// use od_eds::Value;
    /// use od_model::DataType;
    ///
    /// assert_eq!(Value::from_wire(DataType::Integer8, vec![0xFF]), Value::Signed(-1));
    /// ```
    pub fn from_wire(data_type: DataType, bytes: Vec<u8>) -> Self {
        let mut wide = [0; 8];
        let size = bytes.len().min(8);
        wide[..size].copy_from_slice(&bytes[..size]);
        match data_type.kind() {
            Kind::Text => Self::Text(String::from_utf8_lossy(&bytes).into_owned()),
            Kind::Bytes | Kind::Record => Self::Bytes(bytes),
            Kind::Boolean | Kind::Unsigned => Self::Unsigned(u64::from_le_bytes(wide)),
            Kind::Signed => {
                let unused = 64 - 8 * size.max(1) as u32;
                Self::Signed(i64::from_le_bytes(wide) << unused >> unused)
            }
            Kind::Real if size == 4 => {
                let [a, b, c, d, ..] = wide;
                Self::Real(f64::from(f32::from_le_bytes([a, b, c, d])))
            }
            Kind::Real => Self::Real(f64::from_le_bytes(wide)),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_configuration_names_its_node() {
        let text = "[DeviceCommissioning]\nNodeId=0x11\nNodeName=Left\nBaudrate=500\nNetNumber=\n\
            CANopenManager=1\nLSS_SerialNumber=42\n\
            [2000]\nParameterName=a\nObjectType=2\nDenotation=Image\n";
        let description = crate::load::parse(text).description;
        let expected = Commissioning {
            node_id: Some(17),
            node_name: Some("Left"),
            bit_rate: Some(500),
            is_manager: Some(true),
            serial_number: Some(42),
            ..Commissioning::default()
        };
        assert_eq!(description.commissioning(), Some(expected));
        assert_eq!(description.commissioned_node_id(), Some(17));
        let image = &description.objects[&0x2000].entries[&0];
        assert_eq!(image.denotation(), Some("Image"));
        assert_eq!(Description::default().commissioning(), None);
    }
}
