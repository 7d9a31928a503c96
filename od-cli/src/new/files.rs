//! The files of a new crate, from templates with gaps.

use std::path::PathBuf;

use od_eds::{Description, Tables};
use od_model::{Address, Dictionary, Kind, Literal};
use od_runtime::CobId;
use od_runtime::encoder::EncoderProfile;

/// The device description that the crate contains.
pub(super) struct DeviceFile {
    /// `eds` or `dcf`.
    pub(super) ending: &'static str,
    /// The file that goes into the crate.
    pub(super) bytes: Vec<u8>,
    pub(super) description: Description,
}

/// A crate that is to be.
pub(super) struct Project<'p> {
    pub(super) name: &'p str,
    pub(super) device: &'p DeviceFile,
    /// Changes that fixed errors of the file.
    pub(super) notes: &'p [String],
    /// A checkout to depend on.
    pub(super) odkit: Option<PathBuf>,
}

/// Words that cannot name a crate, or have another meaning in code that uses the crate.
const TAKEN: [&str; 14] = [
    "test",
    "core",
    "std",
    "alloc",
    "proc_macro",
    "self",
    "super",
    "crate",
    "od_model",
    "odkit",
    "od_bench",
    "dictionary",
    "build",
    "main",
];

/// Can a crate have this name?
pub(super) fn check_name(name: &str) -> Result<(), String> {
    let starts = name.starts_with(|c: char| c.is_ascii_alphabetic());
    let fits = |c: char| c.is_ascii_alphanumeric() || c == '-' || c == '_';
    let identifier = name.replace('-', "_");
    if !starts || !name.chars().all(fits) || name.len() > 64 {
        return Err(format!(
            "`{name}` is not a valid crate name; start with a letter, then letters, digits, `-` or `_`"
        ));
    }
    if TAKEN.contains(&identifier.as_str()) || is_keyword(&identifier) {
        return Err(format!("`{name}` is reserved in Rust; choose another name"));
    }
    Ok(())
}

fn is_keyword(word: &str) -> bool {
    const WORDS: &str = "abstract as async await become box break const continue do dyn else enum \
        extern false final fn for gen if impl in let loop macro match mod move mut override priv \
        pub ref return static struct trait true try type typeof union unsafe unsized use virtual \
        where while yield";
    WORDS.split_whitespace().any(|keyword| keyword == word)
}

impl Project<'_> {
    /// Paths and contents.
    pub(super) fn files(&self) -> Vec<(String, Vec<u8>)> {
        let text = |template: &str| self.fill(template).into_bytes();
        vec![
            (
                "Cargo.toml".into(),
                text(include_str!("template/Cargo.toml.in")),
            ),
            (".gitignore".into(), b"/target\n".to_vec()),
            (
                "README.md".into(),
                text(include_str!("template/README.md.in")),
            ),
            (self.eds_name(), self.device.bytes.clone()),
            (
                "src/lib.rs".into(),
                text(include_str!("template/lib.rs.in")),
            ),
            (
                "src/main.rs".into(),
                text(include_str!("template/main.rs.in")),
            ),
            (
                "tests/scripts.rs".into(),
                text(include_str!("template/scripts.rs.in")),
            ),
            (
                "tests/scripts/boot-up.script".into(),
                text(include_str!("template/boot-up.script.in")),
            ),
        ]
    }

    fn eds_name(&self) -> String {
        format!("{}.{}", self.name, self.device.ending)
    }

    fn fill(&self, template: &str) -> String {
        let description = &self.device.description;
        let node_id = description.commissioned_node_id().unwrap_or(1);
        let tables = Tables::new(description);
        let dictionary = tables.dictionary();
        let is_encoder = EncoderProfile::for_dictionary(dictionary).is_some();
        let first = dictionary.objects().next().map_or(0, |object| object.index);
        let absent = (0x2000..=0xFFFF).find(|index| dictionary.object(*index).is_none());
        let device = if is_encoder {
            include_str!("template/encoder.rs.in")
        } else {
            include_str!("template/behaviour.rs.in")
        };
        template
            .replace("{{device}}", device.trim_end())
            .replace("{{absent}}", &format!("{:04X}h", absent.unwrap_or(0x0FFF)))
            .replace("{{name}}", self.name)
            .replace("{{crate}}", &self.name.replace('-', "_"))
            .replace("{{edits}}", &edits(dictionary))
            .replace("{{eds}}", &self.eds_name())
            .replace("{{title}}", &title(description, self.name))
            .replace("{{node_id}}", &node_id.to_string())
            .replace(
                "{{boot_up}}",
                &format!("{:03X}#00", 0x700 + u16::from(node_id)),
            )
            .replace("{{reads}}", &reads(&tables, node_id))
            .replace("{{first}}", &format!("0x{first:04X}"))
            .replace("{{dependencies}}", &self.dependencies())
            .replace("{{fixed}}", &self.fixed())
    }

    fn dependencies(&self) -> String {
        let crates = [
            ("od-bench", "od-bench", ", features = [\"serve\"]"),
            ("odkit", "odkit", ""),
        ];
        let version = env!("CARGO_PKG_VERSION");
        let lines = crates.map(|(name, folder, features)| match &self.odkit {
            Some(root) => {
                // A literal string of TOML holds any path without an apostrophe.
                let path = root.join(folder).display().to_string();
                let path = toml(&path);
                format!("{name} = {{ path = {path}{features} }}")
            }
            None if features.is_empty() => format!("{name} = \"{version}\""),
            None => format!("{name} = {{ version = \"{version}\"{features} }}"),
        });
        lines.join("\n")
    }

    /// For README: what the file in the crate says otherwise than the one it was made from.
    fn fixed(&self) -> String {
        if self.notes.is_empty() {
            return String::new();
        }
        let lines: Vec<String> = self
            .notes
            .iter()
            .map(|note| format!("- {note}\n"))
            .collect();
        format!(
            "\n## Fixed errors\n\nThe EDS file had errors. The copy in this folder was changed:\n\n{}",
            lines.concat()
        )
    }
}

/// Lines of the macro call that remove what a node does not serve: without them the crate does not
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

fn toml(text: &str) -> String {
    if text.contains('\'') {
        format!("{text:?}")
    } else {
        format!("'{text}'")
    }
}

/// A name to show, as the file gives it; without what would end a Rust string or a line.
fn title(description: &Description, name: &str) -> String {
    let product = description
        .section("DeviceInfo")
        .and_then(|info| info.get("ProductName"))
        .map(|product| product.value.trim().to_owned());
    let plain = |c: char| !c.is_control() && !matches!(c, '"' | '\\' | '{' | '}');
    match product {
        Some(product) if !product.is_empty() => product.chars().filter(|c| plain(*c)).collect(),
        _ => name.to_owned(),
    }
}

/// Script lines that read what the device is: numbers of the communication area that nobody
/// can have changed.
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_are_ones_that_cargo_takes() {
        for name in ["my-device", "a", "Enc_58"] {
            assert_eq!(check_name(name), Ok(()), "{name}");
        }
        for name in ["", "5x", "-a", "a b", "ü", "test", "fn", "od-model", "a/b"] {
            assert!(check_name(name).is_err(), "{name}");
        }
        assert_eq!(toml("/a b"), "'/a b'");
    }
}
