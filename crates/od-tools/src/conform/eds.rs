//! The EDS of the node: its objects, and the cases that apply.

use od_eds::{Description, Finding, Tables};
use od_model::{Access, Address, Dictionary, Entry, Kind, Literal, Visible, values};
use od_wire::NodeId;

/// An EDS, read for a conformance test.
#[derive(Debug)]
pub struct Eds {
    /// The description.
    pub description: Description,
    /// The findings of the rules.
    pub findings: Vec<Finding>,
    tables: Tables,
}

/// Objects that a case may change without disturbing the node, before any others.
const QUIET: [(u16, u8); 8] = [
    (0x1017, 0),
    (0x100D, 0),
    (0x100C, 0),
    (0x1016, 1),
    (0x1800, 5),
    (0x1801, 5),
    (0x1800, 2),
    (0x1801, 2),
];

impl Eds {
    /// Reads an EDS, DCF or XDD text.
    pub fn read(text: &str) -> Self {
        let loaded = od_eds::load(text);
        Self {
            tables: Tables::new(&loaded.description),
            description: loaded.description,
            findings: loaded.findings,
        }
    }

    /// The dictionary.
    pub fn dictionary(&self) -> Dictionary<'_> {
        self.tables.dictionary()
    }

    /// The entry at an address.
    pub fn entry(&self, index: u16, sub: u8) -> Option<Entry> {
        self.dictionary().entry(index, sub)
    }

    /// Returns whether the EDS has an object with this index.
    pub fn has(&self, index: u16) -> bool {
        self.dictionary().object(index).is_some()
    }

    /// Returns whether a master can write an entry.
    pub fn writes(&self, index: u16, sub: u8) -> bool {
        self.entry(index, sub)
            .is_some_and(|entry| entry.access.writable())
    }

    /// The key of `[DeviceInfo]` as a number.
    pub fn info(&self, key: &str) -> Option<i128> {
        let section = self.description.section("DeviceInfo")?;
        od_model::values::integer(section.get(key)?.value.trim())
    }

    /// Product and vendor in `[DeviceInfo]`.
    pub fn title(&self) -> String {
        let key = |key| {
            let section = self.description.section("DeviceInfo")?;
            let text = Visible(section.get(key)?.value.trim()).line().into_owned();
            (!text.is_empty()).then_some(text)
        };
        key("ProductName").unwrap_or_else(|| "unnamed device".into())
    }

    /// Entries that can be read and written back without harm, those without side effects first. Commands
    /// (1003h, 1010h, 1011h, 1F50h to 1F5Fh), COB-IDs and the preset are left out.
    pub(crate) fn writable(&self) -> Vec<Entry> {
        let quiet = QUIET
            .iter()
            .filter_map(|(index, sub)| self.entry(*index, *sub));
        let rest = self.dictionary().entries().filter(|entry| {
            !QUIET.contains(&(entry.address.index, entry.address.sub)) && !self.acts(entry.address)
        });
        let both = quiet.chain(rest);
        both.filter(|entry| matches!(entry.access, Access::Rw | Access::Rwr | Access::Rww))
            .collect()
    }

    /// Returns whether writing an object does more than change its value. 2100h and 2101h are bit rate and node ID in
    /// the built-in devices only.
    fn acts(&self, address: Address) -> bool {
        let vendor = self
            .entry(0x1018, 1)
            .and_then(|entry| entry.default.integer(0));
        let is_built_in = matches!(
            vendor.or_else(|| self.info("VendorNumber")),
            Some(0x5F | 0xEC)
        );
        let is_own = matches!(address.index, 0x2100 | 0x2101);
        self.moves(address) || is_touchy(address) && (is_built_in || !is_own)
    }

    /// Number of the device profile (1000h).
    fn profile(&self) -> Option<i128> {
        let entry = self.entry(0x1000, 0)?;
        Some(entry.default.integer(0)? & 0xFFFF)
    }

    /// Returns whether a value moves a machine: the commands of a drive (CiA 402), the outputs of a module (CiA 401).
    pub(crate) fn moves(&self, address: Address) -> bool {
        match (self.profile(), address.index) {
            (Some(402), index @ 0x6000..=0x9FFF) => matches!(
                index & 0x7FF,
                0x40 | 0x42 | 0x60 | 0x71 | 0x7A | 0xC1 | 0xFF
            ),
            (Some(401), index @ 0x6200..=0x64FF) => {
                matches!(index, 0x6200..=0x6237 | 0x6300..=0x6327 | 0x6410..=0x6414)
            }
            _ => false,
        }
    }

    /// Error modes, error values and filter masks of the digital outputs of a module (CiA 401), which act on an output
    /// after an error or with its next value.
    pub(crate) fn reactions(&self) -> Vec<Entry> {
        let is_one = |entry: &Entry| {
            let index = entry.address.index;
            let is_list = matches!(index, 0x6200..=0x6237 | 0x6300..=0x6327);
            self.moves(entry.address) && is_list && matches!(index & 0xF, 6..=8)
        };
        let all = self.dictionary().entries().filter(is_one);
        all.filter(|entry| entry.access.writable()).collect()
    }

    /// The value after a restore, as bytes on the bus; `None` if the EDS has no default value.
    pub(crate) fn default(&self, entry: &Entry, node: NodeId) -> Option<Vec<u8>> {
        let size = entry.data_type.size();
        if let Some(number) = entry.default.integer(node.raw()) {
            return Some(number.to_le_bytes().get(..size?)?.to_vec());
        }
        match entry.default {
            Literal::Real(value) if size == Some(4) => Some((value as f32).to_le_bytes().to_vec()),
            Literal::Real(value) => Some(value.to_le_bytes().to_vec()),
            Literal::None => None,
            literal => Some(self.dictionary().literal_bytes(literal).to_vec()),
        }
    }

    /// Reason why the EDS does not allow a master to write this value: access, length or limits. `None` if it allows
    /// it, or does not have the object.
    pub(crate) fn excludes(&self, address: Address, bytes: &[u8], node: NodeId) -> Option<String> {
        let entry = self.entry(address.index, address.sub)?;
        let name = values::label(self.dictionary(), address);
        let len = bytes.len();
        if !entry.access.writable() {
            return Some(format!("{name} is {} in the EDS", entry.access));
        }
        let size = entry.data_type.size();
        if size.is_some_and(|size| size != len) {
            let name_of = entry.data_type.name();
            return Some(format!(
                "{name} is {name_of} in the EDS, which does not have {len} bytes"
            ));
        }
        let (least, _) = entry.data_type.integer_range()?;
        let mut wide = [0; 16];
        wide.get_mut(..len)?.copy_from_slice(bytes);
        let mut value = i128::from_le_bytes(wide);
        if least < 0 && value >> (8 * len - 1) == 1 {
            value -= 1 << (8 * len);
        }
        let limit = |literal: Literal| literal.integer(node.raw());
        let is_below = limit(entry.low).is_some_and(|low| value < low);
        let is_above = limit(entry.high).is_some_and(|high| value > high);
        (is_below || is_above).then(|| {
            let side = if is_below {
                "below the lower"
            } else {
                "above the upper"
            };
            format!("{name} = {value} is {side} limit of the EDS")
        })
    }

    /// The TPDOs or RPDOs: numbers from 0 on whose communication and mapping objects exist.
    pub(crate) fn pdos(&self, base: u16) -> Vec<u16> {
        let both = |pdo: &u16| self.has(base + pdo) && self.has(base + 0x200 + pdo);
        (0..0x200).filter(both).collect()
    }

    /// An index from `candidates` that the EDS does not have.
    pub(crate) fn absent(&self, candidates: &[u16]) -> Option<u16> {
        candidates.iter().copied().find(|index| !self.has(*index))
    }

    /// An index that the EDS does not have, of some that few devices have.
    pub(crate) fn missing(&self) -> Option<u16> {
        self.absent(&[
            0x1004, 0x1024, 0x1FFF, 0x1F7E, 0x5FFF, 0x9FFF, 0x103F, 0x1EFF,
        ])
    }

    /// Returns whether a condition of an `Applies:` line is met; `None` if the text is not a condition.
    ///
    /// `1017h`, `1018h:02`, `1017h rw`, `lss`, `tpdo`, `rpdo`, `cia401`, `cia402`, `cia406`.
    pub(crate) fn meets(&self, condition: &str) -> Option<bool> {
        let mut words = condition.split_whitespace();
        let first = words.next()?;
        let holds = match first {
            "lss" => self.info("LSS_Supported").is_some_and(|value| value != 0),
            "tpdo" => !self.pdos(0x1800).is_empty(),
            "rpdo" => !self.pdos(0x1400).is_empty(),
            "cia401" => self.profile() == Some(401),
            "cia402" => self.profile() == Some(402),
            "cia406" => self.profile() == Some(406),
            object => {
                let address = od_model::values::address(object)?;
                let (index, sub) = (address.index, address.sub);
                let there = if first.contains(':') {
                    self.entry(index, sub).is_some()
                } else {
                    self.has(index)
                };
                match words.next() {
                    None => there,
                    Some("rw") => self.writes(index, sub),
                    Some("ro") => there && !self.writes(index, sub),
                    Some(_) => return None,
                }
            }
        };
        words.next().is_none().then_some(holds)
    }
}

/// Objects that are commands, or that change what the test depends on.
pub(crate) fn is_touchy(address: Address) -> bool {
    let sub = address.sub;
    match address.index {
        0x1003 | 0x1005 | 0x1006 | 0x1010..=0x1015 | 0x1F50..=0x1F5F | 0x1200..=0x12FF => true,
        // COB-ID, inhibit time and SYNC start value can be written only while the PDO is not valid (CiA 301,
        // 7.5.2.37).
        0x1400..=0x15FF | 0x1800..=0x19FF => matches!(sub, 1 | 3 | 6),
        0x1600..=0x17FF | 0x1A00..=0x1BFF => true,
        0x2000..=0x2FFF => sub == 0 && matches!(address.index, 0x2100 | 0x2101),
        0x6003 => true,
        _ => false,
    }
}

/// Returns whether the value is a number.
pub(crate) fn is_number(entry: &Entry) -> bool {
    matches!(
        entry.data_type.kind(),
        Kind::Unsigned | Kind::Signed | Kind::Boolean
    )
}
