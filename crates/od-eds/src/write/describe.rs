//! Makes a description from a dictionary.

use alloc::string::{String, ToString};
use alloc::vec::Vec;
use alloc::{format, vec};

use crate::description::Description;
use crate::description::{EntryDescription, ObjectDescription, Section, Value};
use crate::span::Spanned;
use od_model::Object;
use od_model::{Dictionary, Entry, Group, Literal};

/// Facts about a device besides its objects (CiA 306-1, chapters 4.5 and 4.6).
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct About<'a> {
    /// Name of the file, for example `GXMM.eds`.
    pub file: &'a str,
    /// Description of the device, in one line.
    pub description: &'a str,
    /// Date of the file, `MM-DD-YYYY`; a fixed date makes the file the same each time.
    pub date: &'a str,
    /// Vendor name.
    pub vendor: &'a str,
    /// Supported bit rates in kbit/s. CiA 306 has no key for 100 kbit/s.
    pub bit_rates: &'a [u16],
    /// The device is an LSS slave.
    pub lss: bool,
    /// The device enters Operational without a master (if 1F80h says so) and without configuration.
    pub simple_boot_up: bool,
    /// Lines of `[Comments]`.
    pub comments: &'a [&'a str],
}

/// The bit rates in kbit/s for which CiA 306-1 has a key.
const BIT_RATES: [u16; 8] = [10, 20, 50, 125, 250, 500, 800, 1000];

/// Makes the description of a dictionary, with the sections about the device.
///
/// Product and revision come from 1018h, the name from 1008h. If [`write`](crate::write()) writes
/// the description, the text gives the same dictionary.
///
/// ```
/// use od_eds::{About, Tables, describe, load, parse, write};
///
/// let loaded = load("[1000]\nParameterName=Device type\nDataType=0x0007\nAccessType=ro\n");
/// let tables = Tables::new(&loaded.description);
/// let about = About {
///     file: "x.eds", description: "", date: "11-21-2026", vendor: "", bit_rates: &[500],
///     lss: false, simple_boot_up: true, comments: &[],
/// };
/// let text = write(&describe(tables.dictionary(), &about));
/// assert!(text.contains("BaudRate_500=1\n"));
/// let again = Tables::new(&parse(&text).description);
/// assert!(again.dictionary() == tables.dictionary());
/// ```
pub fn describe(dictionary: Dictionary<'_>, about: &About<'_>) -> Description {
    Description {
        sections: sections(dictionary, about),
        objects: dictionary
            .objects()
            .map(|made| (made.index, object(dictionary, &made)))
            .collect(),
    }
}

fn object(dictionary: Dictionary<'_>, object: &Object) -> ObjectDescription {
    let members = dictionary.members(object);
    let entries = members.map(|member| (member.address.sub, entry(dictionary, &member)));
    ObjectDescription {
        code: Spanned::from(object.code),
        name: Spanned::from(dictionary.text(object.name).to_string()),
        sub_number: object
            .code
            .has_members()
            .then(|| Spanned::from(u32::from(object.count))),
        entries: entries.collect(),
        flags: 0,
        extra: Vec::new(),
        span: Default::default(),
    }
}

fn entry(dictionary: Dictionary<'_>, entry: &Entry) -> EntryDescription {
    let mut made = EntryDescription {
        access: Spanned::from(entry.access),
        mappable: Spanned::from(entry.mappable),
        default: value(dictionary, entry.default),
        low: value(dictionary, entry.low),
        high: value(dictionary, entry.high),
        ..EntryDescription::new(dictionary.text(entry.name), entry.data_type)
    };
    // A saved value always names its group, so that a tool without defaults by index reads it, too.
    if entry.group != Group::None || made.group_at(entry.address) != Group::None {
        made.group = Some(Spanned::from(entry.group));
    }
    made
}

fn value(dictionary: Dictionary<'_>, literal: Literal) -> Option<Spanned<Value>> {
    let value = match literal {
        Literal::None => return None,
        Literal::Unsigned(number) => Value::Unsigned(number),
        Literal::Signed(number) => Value::Signed(number),
        Literal::Real(number) => Value::Real(number),
        Literal::NodeId(offset) => Value::NodeId(offset),
        Literal::Text(range) => Value::Text(dictionary.text(range).to_string()),
        Literal::Bytes(range) => Value::Bytes(dictionary.blob(range).to_vec()),
    };
    Some(Spanned::from(value))
}

fn sections(dictionary: Dictionary<'_>, about: &About<'_>) -> Vec<Section> {
    let flag = |yes: bool| if yes { "1" } else { "0" }.to_string();
    let number = |sub| {
        let entry = dictionary.entry(0x1018, sub);
        let number = entry
            .and_then(|entry| entry.default.integer(0))
            .unwrap_or(0);
        format!("0x{number:08X}")
    };
    let name = match dictionary.entry(0x1008, 0).map(|entry| entry.default) {
        Some(Literal::Text(range)) => dictionary.text(range).to_string(),
        _ => String::new(),
    };
    let pdos = |first: u16| {
        let objects = dictionary.objects();
        let count = objects.filter(|object| (first..first + 0x200).contains(&object.index));
        count.count()
    };
    // A mapping is dynamic if its sub-index 0 can be written.
    let dynamic = [0x1600, 0x1A00]
        .iter()
        .filter_map(|index| dictionary.entry(*index, 0))
        .any(|count| count.access.writable());
    let text = |text: &str| text.to_string();
    let mut info = vec![
        (text("VendorName"), text(about.vendor)),
        (text("VendorNumber"), number(1)),
        (text("ProductName"), name.clone()),
        (text("ProductNumber"), number(2)),
        (text("RevisionNumber"), number(3)),
        (text("OrderCode"), name),
    ];
    for rate in BIT_RATES {
        let has = about.bit_rates.contains(&rate);
        info.push((format!("BaudRate_{rate}"), flag(has)));
    }
    info.extend([
        (text("SimpleBootUpMaster"), flag(false)),
        (text("SimpleBootUpSlave"), flag(about.simple_boot_up)),
        (
            text("Granularity"),
            if dynamic { "8" } else { "0" }.to_string(),
        ),
        (text("DynamicChannelsSupported"), flag(false)),
        (text("GroupMessaging"), flag(false)),
        (text("NrOfRXPDO"), pdos(0x1400).to_string()),
        (text("NrOfTXPDO"), pdos(0x1800).to_string()),
        (text("LSS_Supported"), flag(about.lss)),
        (text("CompactPDO"), flag(false)),
    ]);
    let file = [
        ("FileName", about.file),
        ("FileVersion", "1"),
        ("FileRevision", "0"),
        ("EDSVersion", "4.0"),
        ("Description", about.description),
        ("CreationTime", "12:00PM"),
        ("CreationDate", about.date),
        ("CreatedBy", "odkit"),
        ("ModificationTime", "12:00PM"),
        ("ModificationDate", about.date),
        ("ModifiedBy", "odkit"),
    ];
    let file = file.map(|(key, value)| (text(key), text(value)));
    let dummies = (1..=7).map(|code| (format!("Dummy{code:04}"), flag(false)));
    let lines = (1..).zip(about.comments);
    let lines = lines.map(|(number, line)| (format!("Line{number}"), text(line)));
    let count = (text("Lines"), about.comments.len().to_string());
    let mut sections = vec![
        section("FileInfo", file),
        section("DeviceInfo", info),
        section("DummyUsage", dummies),
    ];
    if !about.comments.is_empty() {
        sections.push(section("Comments", [count].into_iter().chain(lines)));
    }
    sections
}

/// A section with these keys and values, which have no place in a text.
pub(crate) fn section(name: &str, pairs: impl IntoIterator<Item = (String, String)>) -> Section {
    Section {
        name: Spanned::from(name.to_string()),
        pairs: pairs
            .into_iter()
            .map(|(key, value)| (Spanned::from(key), Spanned::from(value)))
            .collect(),
    }
}
