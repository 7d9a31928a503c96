//! The sections of a learned file besides its objects, and the errors of its node.

use std::collections::BTreeMap;

use od_eds::{Description, ObjectDescription, Section, Spanned, Value};
use od_wire::NodeId;

use super::probe::Lss;

/// Options of [`learn`](super::learn()).
#[derive(Clone, Copy, PartialEq, Eq, Debug, Default)]
pub struct Options {
    /// Probe limits by writing; the values are restored.
    pub writes: bool,
    /// Creation time in the file.
    pub today: Option<Today>,
}

/// A calendar date and time.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct Today {
    /// Year, as in 2026.
    pub year: u16,
    /// Month and day, from 1.
    pub month: u8,
    /// See `month`.
    pub day: u8,
    /// Hour and minute, from 0.
    pub hour: u8,
    /// See `hour`.
    pub minute: u8,
}

/// Allows the errors that the node itself has: a learned file describes what the node responds, and must be
/// usable in spite of them.
pub(super) fn allow_errors(description: &mut Description) {
    let loaded = od_eds::load(&od_eds::write(description));
    for finding in loaded.findings.iter().filter(|one| one.is_error()) {
        let Some(address) = finding.object else {
            continue;
        };
        let Some(object) = description.objects.get_mut(&address.index) else {
            continue;
        };
        let text = format!("{} the node answers so", finding.code());
        let extra = match object.entries.get_mut(&address.sub) {
            Some(entry) => &mut entry.extra,
            None => &mut object.extra,
        };
        let key = ";odkit-allow";
        if !extra
            .iter()
            .any(|(name, known)| name == key && *known == text)
        {
            extra.push((key.into(), text));
        }
    }
}

pub(super) fn sections(
    objects: &BTreeMap<u16, ObjectDescription>,
    node: NodeId,
    options: &Options,
    lss: Lss,
    faults: &[String],
) -> Vec<Section> {
    let writes = options.writes;
    let section = |name: &str, pairs: Vec<(&str, String)>| Section {
        name: Spanned::from(name.to_owned()),
        pairs: pairs
            .into_iter()
            .map(|(key, value)| (Spanned::from(key.to_owned()), Spanned::from(value)))
            .collect(),
    };
    let value = |index: u16, sub: u8| {
        let default = &objects.get(&index)?.entries.get(&sub)?.default;
        default.as_ref().map(|default| default.value.clone())
    };
    let number = |sub| match value(0x1018, sub) {
        Some(Value::Unsigned(number)) => format!("0x{number:08X}"),
        _ => "0".into(),
    };
    let name = match value(0x1008, 0) {
        Some(Value::Text(text)) => text,
        _ => format!("Node {}", node.raw()),
    };
    let pdos = |first: u16| objects.range(first..first + 0x200).count().to_string();
    let mut info = vec![
        ("VendorName", String::new()),
        ("VendorNumber", number(1)),
        ("ProductName", name.clone()),
        ("ProductNumber", number(2)),
        ("RevisionNumber", number(3)),
        ("OrderCode", String::new()),
    ];
    for rate in ["10", "20", "50", "125", "250", "500", "800", "1000"] {
        let key: &'static str = match rate {
            "10" => "BaudRate_10",
            "20" => "BaudRate_20",
            "50" => "BaudRate_50",
            "125" => "BaudRate_125",
            "250" => "BaudRate_250",
            "500" => "BaudRate_500",
            "800" => "BaudRate_800",
            _ => "BaudRate_1000",
        };
        info.push((key, "1".into()));
    }
    info.extend([
        ("SimpleBootUpMaster", "0".into()),
        ("SimpleBootUpSlave", "1".into()),
        ("Granularity", "8".into()),
        ("DynamicChannelsSupported", "0".into()),
        ("GroupMessaging", "0".into()),
        ("NrOfRXPDO", pdos(0x1400)),
        ("NrOfTXPDO", pdos(0x1800)),
        ("LSS_Supported", u8::from(lss == Lss::Yes).to_string()),
    ]);
    let mut lines = vec![
        format!("Learned by odkit from node {}.", node.raw()),
        "Not known: bit rates, which values are saved, which objects can be mapped.".into(),
        if writes {
            "Limits were probed.".into()
        } else {
            "Limits were not probed (--allow-writes).".to_owned()
        },
    ];
    if lss == Lss::Unknown {
        let how = if writes {
            "it did not show Pre-operational, so it was not stopped"
        } else {
            "--allow-writes also asks it in Stopped"
        };
        lines.push(format!(
            "Not known: LSS, as the node did not respond to it in its NMT state; {how}."
        ));
    }
    lines.extend(faults.iter().cloned());
    let count = ("Lines".to_owned(), lines.len().to_string());
    let numbered = (1..).zip(lines);
    let numbered = numbered.map(|(number, line): (u32, String)| (format!("Line{number}"), line));
    let comments = std::iter::once(count).chain(numbered);
    let comments = comments.map(|(key, value)| (Spanned::from(key), Spanned::from(value)));
    let dummies = [
        "Dummy0001",
        "Dummy0002",
        "Dummy0003",
        "Dummy0004",
        "Dummy0005",
        "Dummy0006",
        "Dummy0007",
    ];
    let today = options.today.unwrap_or(Today {
        year: 2000,
        month: 1,
        day: 1,
        hour: 0,
        minute: 0,
    });
    let time = || {
        let (hour, half) = match today.hour {
            0 => (12, "AM"),
            hour @ 1..=11 => (hour, "AM"),
            12 => (12, "PM"),
            hour => (hour - 12, "PM"),
        };
        format!("{hour:02}:{:02}{half}", today.minute)
    };
    let date = || format!("{:02}-{:02}-{:04}", today.month, today.day, today.year);
    vec![
        section(
            "FileInfo",
            vec![
                ("FileName", "learned.eds".into()),
                ("FileVersion", "1".into()),
                ("FileRevision", "0".into()),
                ("EDSVersion", "4.0".into()),
                ("Description", format!("Learned from {name}")),
                ("CreationTime", time()),
                ("CreationDate", date()),
                ("CreatedBy", "odkit learn".into()),
                ("ModificationTime", time()),
                ("ModificationDate", date()),
                ("ModifiedBy", "odkit learn".into()),
            ],
        ),
        section("DeviceInfo", info),
        section(
            "DummyUsage",
            dummies.map(|name| (name, "0".into())).to_vec(),
        ),
        Section {
            name: Spanned::from("Comments".to_owned()),
            pairs: comments.collect(),
        },
    ]
}
