//! Facts about the device of a file, for the templates.

use std::ops::RangeInclusive;

use od_eds::{Description, Tables};
use od_model::{Address, Dictionary, Kind, Literal, Visible, values};
use od_runtime::CobId;
use od_runtime::encoder::{EncoderProfile, Total};

use super::template::Gap;

/// The device description that the crate contains.
pub(super) struct DeviceFile {
    /// `eds` or `dcf`.
    pub(super) ending: &'static str,
    /// The file that goes into the crate.
    pub(super) bytes: Vec<u8>,
    pub(super) description: Description,
    /// Changes that fixed errors of the file.
    pub(super) notes: Vec<String>,
    /// Errors of the file that the user has to decide about.
    pub(super) left: Vec<String>,
}

/// Bit rates of CiA 301 in kbit/s, by their index in the LSS table; 0 if the index has none.
pub(super) const BIT_RATES: [u16; 9] = [1000, 800, 500, 250, 125, 0, 50, 20, 10];

impl DeviceFile {
    /// Returns the unit of 6502h if the device is an encoder (CiA 406).
    pub(super) fn encoder(&self) -> Option<Total> {
        let tables = Tables::new(&self.description);
        let profile = EncoderProfile::for_dictionary(tables.dictionary());
        profile.map(|profile| profile.total)
    }

    /// Returns whether something is saved: values by 1010h, or the node ID by LSS.
    pub(super) fn saves(&self) -> bool {
        let objects = &self.description.objects;
        let saves = objects.contains_key(&0x1010) || objects.contains_key(&0x1011);
        saves || self.has_lss()
    }

    pub(super) fn has_lss(&self) -> bool {
        is_set(&self.description, "LSS_Supported")
    }

    /// Bit rate in kbit/s: that of a DCF. Without one it is 500, if the file supports 500 or names no bit
    /// rate; otherwise the highest one that file and board support.
    ///
    /// # Errors
    /// A sentence, if the board has none of them.
    pub(super) fn bit_rate(&self, board: &[u16]) -> Result<u16, String> {
        let description = &self.description;
        let given = description.commissioning().and_then(|node| node.bit_rate);
        let given = given.filter(|rate| *rate != 0 && BIT_RATES.contains(rate));
        let has = |rate: &u16| *rate != 0 && is_set(description, &format!("BaudRate_{rate}"));
        let all = [500].into_iter().chain(BIT_RATES).filter(has);
        let all: Vec<u16> = match given {
            Some(rate) => vec![rate],
            None => all.collect(),
        };
        let usual = [500];
        let all = if all.is_empty() { &usual[..] } else { &all };
        let rate = all.iter().find(|rate| board.contains(rate));
        rate.copied().ok_or_else(|| {
            let list = |rates: &[u16]| {
                let rates: Vec<String> = rates
                    .iter()
                    .filter(|rate| **rate != 0)
                    .map(u16::to_string)
                    .collect();
                rates.join(", ")
            };
            let (own, board) = (list(all), list(board));
            format!("the file names a bit rate of {own} kbit/s, and the board has {board} kbit/s")
        })
    }

    /// The gaps of the templates and their contents.
    pub(super) fn gaps(&self, name: &str, bit_rate: u16) -> Vec<Gap> {
        let description = &self.description;
        let node_id = description.commissioned_node_id().unwrap_or(1);
        let tables = Tables::new(description);
        let dictionary = tables.dictionary();
        let first = dictionary.objects().next().map_or(0, |object| object.index);
        let absent = (0x2000..=0xFFFF).find(|index| dictionary.object(*index).is_none());
        let encoder = match self.encoder() {
            Some(Total::Steps) => {
                "EncoderProfile {\n    total: Total::Steps,\n    ..EncoderProfile::CIA406\n}"
            }
            _ => "EncoderProfile::CIA406",
        };
        let image = if self.saves() {
            "use odkit::storage::image;\n"
        } else {
            ""
        };
        let boot_up = format!("{:03X}#00", 0x700 + u16::from(node_id));
        let (names, own) = if self.has_lss() {
            ("LssProfile, NodeId, Profile", " + image::OWN_CAPACITY")
        } else {
            ("NodeId, Profile", "")
        };
        let title = title(description, name);
        vec![
            ("name", name.to_owned()),
            ("crate", name.replace('-', "_").to_ascii_lowercase()),
            // For a page of documentation, which is Markdown.
            ("shown", Visible(&title).markdown()),
            ("title", title),
            ("eds", format!("{name}.{}", self.ending)),
            ("absent", format!("{:04X}h", absent.unwrap_or(0x0FFF))),
            ("edits", edits(dictionary)),
            ("node_id", node_id.to_string()),
            ("boot_up", boot_up),
            ("reads", reads(&tables, node_id)),
            ("first", format!("0x{first:04X}")),
            ("encoder", encoder.to_owned()),
            ("bit_rate", bit_rate.to_string()),
            ("without", self.without()),
            ("profile", self.profile(bit_rate)),
            ("own", own.to_owned()),
            ("names", format!("{image}use odkit::{{{names}}};")),
            ("fixed", self.fixed()),
            ("rust_version", env!("CARGO_PKG_RUST_VERSION").to_owned()),
        ]
    }

    /// The line of the macro call that leaves out services for which the file has no object.
    fn without(&self) -> String {
        let has = |indices: RangeInclusive<u16>| {
            let mut objects = self.description.objects.range(indices);
            objects.next().is_some()
        };
        let services = [
            ("lss", self.has_lss()),
            ("rpdos", has(0x1400..=0x17FF)),
            ("guarding", has(0x100C..=0x100D)),
            ("consumer", has(0x1016..=0x1016)),
            ("storage", self.saves()),
        ];
        let missing = services.iter().filter(|(_, has)| !has);
        let missing: Vec<&str> = missing.map(|(name, _)| *name).collect();
        if missing.is_empty() {
            String::new()
        } else {
            format!(
                "        // Services that the file has no object for.\n        without {};\n",
                missing.join(", ")
            )
        }
    }

    /// The profile of the device: that of CiA 301, with LSS if the file asks for it.
    fn profile(&self, bit_rate: u16) -> String {
        if !self.has_lss() {
            return String::from("Profile::CIA301");
        }
        let rates = BIT_RATES.iter().enumerate();
        let rates = rates.map(|(index, rate)| {
            if *rate == bit_rate {
                format!("Some({index})")
            } else {
                String::from("None")
            }
        });
        let rates: Vec<String> = rates.collect();
        format!(
            "Profile {{\n    // An LSS master can set the node ID. The bit rate is that of the \
             firmware.\n    lss: Some(LssProfile {{\n        bit_rates: [{}],\n        \
             ..LssProfile::CIA305\n    }}),\n    ..Profile::CIA301\n}}",
            rates.join(", ")
        )
    }

    /// The changes in the crate's copy, for its README.
    fn fixed(&self) -> String {
        let list = |title: &str, text: &str, lines: &[String]| {
            let lines: Vec<String> = lines.iter().map(|line| format!("- {line}\n")).collect();
            if lines.is_empty() {
                String::new()
            } else {
                format!("\n## {title}\n\n{text}\n\n{}", lines.concat())
            }
        };
        let fixed = "The EDS file had errors. The copy in this folder was changed, old → new:";
        let left = "A device can be built with these errors, and a master may fail. Correct the copy; \
                    `odkit check` shows the lines.";
        list("Fixed errors", fixed, &self.notes) + &list("Still wrong", left, &self.left)
    }
}

/// Returns whether a key of [DeviceInfo] exists and is not 0.
fn is_set(description: &Description, key: &str) -> bool {
    let info = description.section("DeviceInfo");
    let value = info.and_then(|info| info.get(key));
    value
        .and_then(|value| values::integer(value.value.trim()))
        .is_some_and(|number| number != 0)
}

/// Lines of the macro call that remove objects that a node does not serve: with them the crate would not
/// compile.
fn edits(dictionary: Dictionary<'_>) -> String {
    let mut lines = String::new();
    let sync = dictionary.entry(0x1005, 0);
    if let Some(cob_id) = sync.and_then(|entry| entry.default.integer(0)) {
        let cob_id = CobId::new(cob_id as u32);
        if cob_id.produces_sync() && !dictionary.has(0x1006) {
            let consumed = cob_id.raw() & !(1 << 30);
            lines += "        // Without 1006h the node does not produce SYNC.\n";
            lines += &format!("        modify 0x1005 {{ default = {consumed:#010X} }}\n");
        }
    }
    lines
}

/// The name in the file, without characters that would end a Rust string or a line.
fn title(description: &Description, name: &str) -> String {
    let product = description
        .section("DeviceInfo")
        .and_then(|info| info.get("ProductName"))
        .map(|product| product.value.trim().to_owned());
    let plain = |c: char| !od_model::is_hidden(c) && !matches!(c, '"' | '\\' | '{' | '}');
    match product {
        Some(product) if !product.is_empty() => product.chars().filter(|c| plain(*c)).collect(),
        _ => name.to_owned(),
    }
}

/// Script lines that read constant values of the communication area, which no master can
/// change.
fn reads(tables: &Tables, node_id: u8) -> String {
    let dictionary = tables.dictionary();
    let mut lines = String::new();
    for (index, sub) in [(0x1000, 0), (0x1018, 1), (0x1018, 2), (0x1018, 3)] {
        let Ok(entry) = dictionary.find(Address::new(index, sub)) else {
            continue;
        };
        let known = !matches!(entry.default, Literal::None) && entry.access.readable();
        let number = entry.default.integer(node_id).filter(|_| known);
        if let (Some(number), Kind::Unsigned) = (number, entry.data_type.kind()) {
            let place = Address::new(index, sub);
            lines.push_str(&format!("sdo read {place} = 0x{number:X}\n"));
        }
    }
    lines
}
