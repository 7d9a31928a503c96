//! Names of CiA 306: the sections that describe no object, and all keys.

use alloc::format;
use alloc::string::String;
use alloc::vec::Vec;

use crate::scan::names::{Place, place};
use crate::scan::number;

/// Form of a value in a section that describes no object.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Form {
    /// Any text.
    Text,
    /// 0 or 1.
    Flag,
    /// A number up to this one.
    Number(u32),
    /// `4.0`
    Version,
    /// `07-14-2026`
    Date,
    /// `09:30AM`
    Time,
}

impl Form {
    /// Returns whether the value is a number, which a comment after it does not change.
    pub(crate) const fn is_number(self) -> bool {
        matches!(self, Self::Flag | Self::Number(_) | Self::Version)
    }
}

/// A section with its keys; a `#` in a name stands for a number.
pub struct SectionForm {
    /// Name.
    pub name: &'static str,
    /// Keys and the forms of their values.
    pub keys: &'static [(&'static str, Form)],
}

const U8: Form = Form::Number(0xFF);
const U16: Form = Form::Number(0xFFFF);
const U32: Form = Form::Number(u32::MAX);

const COMMISSIONING: &[(&str, Form)] = &[
    ("NodeID", U8),
    ("NodeName", Form::Text),
    ("NodeRefd", Form::Text),
    ("Baudrate", U16),
    ("NetNumber", U32),
    ("NetworkName", Form::Text),
    ("NetRefd", Form::Text),
    ("CANopenManager", Form::Flag),
    ("LSS_SerialNumber", U32),
];

const COMMENTS: &[(&str, Form)] = &[("Lines", U16), ("Line#", Form::Text)];
const INDEX_LIST: &[(&str, Form)] = &[("NrOfEntries", U16), ("#", U16)];

/// The sections, in the order in which they are written.
pub const SECTIONS: &[SectionForm] = &[
    SectionForm {
        name: "FileInfo",
        keys: &[
            ("FileName", Form::Text),
            ("FileVersion", U8),
            ("FileRevision", U8),
            ("LastEDS", Form::Text),
            ("EDSVersion", Form::Version),
            ("Description", Form::Text),
            ("CreationTime", Form::Time),
            ("CreationDate", Form::Date),
            ("CreatedBy", Form::Text),
            ("ModificationTime", Form::Time),
            ("ModificationDate", Form::Date),
            ("ModifiedBy", Form::Text),
        ],
    },
    SectionForm {
        name: "DeviceInfo",
        keys: &[
            ("VendorName", Form::Text),
            ("VendorNumber", U32),
            ("ProductName", Form::Text),
            ("ProductNumber", U32),
            ("ProductVersion", U32),
            ("RevisionNumber", U32),
            ("OrderCode", Form::Text),
            ("BaudRate_10", Form::Flag),
            ("BaudRate_20", Form::Flag),
            ("BaudRate_50", Form::Flag),
            ("BaudRate_125", Form::Flag),
            ("BaudRate_250", Form::Flag),
            ("BaudRate_500", Form::Flag),
            ("BaudRate_800", Form::Flag),
            ("BaudRate_1000", Form::Flag),
            ("SimpleBootUpMaster", Form::Flag),
            ("SimpleBootUpSlave", Form::Flag),
            ("ExtendedBootUpMaster", Form::Flag),
            ("ExtendedBootUpSlave", Form::Flag),
            ("Granularity", Form::Number(64)),
            ("DynamicChannelsSupported", U8),
            ("CompactPDO", U8),
            ("GroupMessaging", Form::Flag),
            ("NrOfRXPDO", Form::Number(512)),
            ("NrOfTXPDO", Form::Number(512)),
            ("LSS_Supported", Form::Flag),
            ("NG_Slave", Form::Flag),
            ("NG_Master", Form::Flag),
            ("NrOfNG_MonitoredNodes", U16),
        ],
    },
    SectionForm {
        name: "DummyUsage",
        keys: &[("Dummy#", Form::Flag)],
    },
    SectionForm {
        name: "Comments",
        keys: COMMENTS,
    },
    SectionForm {
        name: "DeviceComissioning",
        keys: COMMISSIONING,
    },
    SectionForm {
        name: "DeviceCommissioning",
        keys: COMMISSIONING,
    },
    SectionForm {
        name: "SupportedModules",
        keys: &[("NrOfEntries", U16), ("#", Form::Text)],
    },
    SectionForm {
        name: "ConnectedModules",
        keys: INDEX_LIST,
    },
    SectionForm {
        name: "DynamicChannels",
        keys: &[
            ("NrOfSeg", U8),
            ("Type#", U16),
            ("Dir#", Form::Text),
            ("Range#", Form::Text),
            ("PPOffset#", U32),
        ],
    },
    SectionForm {
        name: "M#ModuleInfo",
        keys: &[
            ("ProductName", Form::Text),
            ("ProductVersion", U8),
            ("ProductRevision", U8),
            ("OrderCode", Form::Text),
        ],
    },
    SectionForm {
        name: "M#Comments",
        keys: COMMENTS,
    },
    SectionForm {
        name: "M#FixedObjects",
        keys: INDEX_LIST,
    },
    SectionForm {
        name: "M#SubExtends",
        keys: INDEX_LIST,
    },
    SectionForm {
        name: "Tools",
        keys: &[("Items", U16)],
    },
    SectionForm {
        name: "Tool#",
        keys: &[("Name", Form::Text), ("Command", Form::Text)],
    },
];

/// The keys of an object or a member.
pub const OBJECT_KEYS: [&str; 16] = [
    "ParameterName",
    "ObjectType",
    "SubNumber",
    "DataType",
    "LowLimit",
    "HighLimit",
    "AccessType",
    "DefaultValue",
    "PDOMapping",
    "ObjFlags",
    "CompactSubObj",
    "ParameterValue",
    "Denotation",
    "UploadFile",
    "DownloadFile",
    "ParamRefd",
];

/// The section with this name, and its position in [`SECTIONS`].
pub fn section(name: &str) -> Option<(usize, &'static SectionForm)> {
    SECTIONS
        .iter()
        .enumerate()
        .find(|(_, known)| is(name, known.name))
}

/// A known key: its spelling, unless it contains a number, and its form.
pub fn key(known: &SectionForm, key: &str) -> Option<(&'static str, Form)> {
    known.keys.iter().copied().find(|(name, _)| is(key, name))
}

/// Returns whether the section has a known form but is not in [`SECTIONS`]: objects of modules, and links.
pub(crate) fn is_of_objects(name: &str) -> bool {
    let links = name.split_at_checked(4).is_some_and(|(index, rest)| {
        rest.eq_ignore_ascii_case("ObjectLinks") && matches!(place(index), Place::Object(_))
    });
    links || module_part(name).is_some()
}

/// The subject of a section `[M1Fixed2000]`, `[M1Fixed2000sub1]` or `[M1SubExt6000]`.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(crate) struct ModulePart {
    pub(crate) module: u16,
    /// `true`: `SubExt`; `false`: `Fixed`.
    pub(crate) extends: bool,
    pub(crate) place: Place,
}

/// Reads the name of a section that describes an object of a module.
pub(crate) fn module_part(name: &str) -> Option<ModulePart> {
    let rest = name.strip_prefix(['M', 'm'])?;
    let digits = rest.bytes().take_while(u8::is_ascii_digit).count();
    let module = rest[..digits].parse().ok()?;
    let rest = &rest[digits..];
    let (extends, index) =
        [(false, "Fixed"), (true, "SubExt")]
            .into_iter()
            .find_map(|(extends, word)| {
                let (start, index) = rest.split_at_checked(word.len())?;
                start.eq_ignore_ascii_case(word).then_some((extends, index))
            })?;
    match place(index) {
        place @ (Place::Object(_) | Place::Member(..)) => Some(ModulePart {
            module,
            extends,
            place,
        }),
        _ => None,
    }
}

/// The numbers of a text between these characters; `None` for a part that is not a number.
pub(crate) fn parts(text: &str, at: char) -> Vec<Option<u32>> {
    text.split(at).map(|part| part.parse().ok()).collect()
}

/// Year, month and day of `07-14-2026`; `None` if there is no such day.
pub(crate) fn day(text: &str) -> Option<(u32, u32, u32)> {
    let [Some(month), Some(day), Some(year @ 1000..=9999)] = parts(text, '-')[..] else {
        return None;
    };
    let is_leap = year % 4 == 0 && (year % 100 != 0 || year % 400 == 0);
    let days = match month {
        2 => 28 + u32::from(is_leap),
        4 | 6 | 9 | 11 => 30,
        1..=12 => 31,
        _ => 0,
    };
    (1..=days).contains(&day).then_some((year, month, day))
}

/// Converts `2026-07-14` to `07-14-2026`; other texts stay.
pub(crate) fn date(given: &str) -> String {
    let mut parts = given.splitn(3, '-');
    let turned = match (parts.next(), parts.next(), parts.next()) {
        (Some(year), Some(month), Some(day)) if year.len() == 4 => {
            day.get(..2).map(|day| format!("{month}-{day}-{year}"))
        }
        _ => None,
    };
    turned.unwrap_or_else(|| given.into())
}

/// Converts `14:30:00+02:00` to `02:30PM`; other texts stay.
pub(crate) fn time(given: &str) -> String {
    let mut parts = given.splitn(3, ':');
    let number = |part: Option<&str>, end: u8| {
        let number: Option<u8> = part?.parse().ok();
        number.filter(|number| *number < end)
    };
    match (number(parts.next(), 24), number(parts.next(), 60)) {
        (Some(hour), Some(minute)) => {
            let half = if hour < 12 { "AM" } else { "PM" };
            format!("{:02}:{minute:02}{half}", (hour + 11) % 12 + 1)
        }
        _ => given.into(),
    }
}

/// Returns whether this is the name, in any case, with a number in place of a `#`.
fn is(name: &str, pattern: &str) -> bool {
    let Some((before, behind)) = pattern.split_once('#') else {
        return name.eq_ignore_ascii_case(pattern);
    };
    let len = name.len();
    let Some(digits) = len.checked_sub(behind.len()) else {
        return false;
    };
    match (name.get(..before.len()), name.get(before.len()..digits)) {
        (Some(start), Some(number)) if !number.is_empty() => {
            start.eq_ignore_ascii_case(before)
                && name[digits..].eq_ignore_ascii_case(behind)
                && match pattern {
                    "Dummy#" => number.bytes().all(|b| b.is_ascii_hexdigit()),
                    "#" => number::integer(number, &mut Vec::new()).is_some(),
                    _ => number.bytes().all(|b| b.is_ascii_digit()),
                }
        }
        _ => false,
    }
}

/// The word that `word` misspells: one or two letters are wrong, missing, too many or exchanged.
pub(crate) fn near<'a>(word: &str, words: impl Iterator<Item = &'a str>) -> Option<&'a str> {
    match word.len() {
        0..=3 => None,
        4..=6 => nearest(word, words, 1),
        _ => nearest(word, words, 2),
    }
}

/// Returns the word that differs in the fewest letters, at most `most` (wrong, missing, too many or
/// exchanged). Case does not count; a word is not near itself.
pub fn nearest<'a>(
    word: &str,
    words: impl Iterator<Item = &'a str>,
    most: usize,
) -> Option<&'a str> {
    words
        .map(|known| (distance(word, known, most), known))
        .filter(|(distance, _)| (1..=most).contains(distance))
        .min_by_key(|(distance, _)| *distance)
        .map(|(_, known)| known)
}

/// Number of letters that differ; if it is above `most`, any number above `most`.
fn distance(a: &str, b: &str, most: usize) -> usize {
    // A quick check first, for texts with millions of keys: a wrong letter changes at most two
    // bits.
    let letters = |text: &str| {
        let bytes = text.bytes().map(|b| b.to_ascii_lowercase() % 64);
        bytes.fold(0u64, |all, bit| all | 1 << bit)
    };
    let far = || (letters(a) ^ letters(b)).count_ones() as usize > 2 * most;
    if a.len().abs_diff(b.len()) > most || a.len() > 40 || far() {
        return most + 1;
    }
    let lower = |text: &str| -> Vec<u8> { text.bytes().map(|b| b.to_ascii_lowercase()).collect() };
    let (a, b) = (lower(a), lower(b));
    let mut before: Vec<usize> = Vec::new();
    let mut row: Vec<usize> = (0..=b.len()).collect();
    for (i, x) in a.iter().enumerate() {
        let mut next = Vec::with_capacity(row.len());
        next.push(i + 1);
        for (j, y) in b.iter().enumerate() {
            let mut best = (row[j] + usize::from(x != y))
                .min(row[j + 1] + 1)
                .min(next[j] + 1);
            if i > 0 && j > 0 && *x == b[j - 1] && a[i - 1] == *y {
                best = best.min(before[j - 1] + 1);
            }
            next.push(best);
        }
        before = core::mem::replace(&mut row, next);
    }
    row.last().copied().unwrap_or(most + 1)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sections_and_keys_in_any_case_and_with_any_number() {
        let name = |text| section(text).map(|(_, known)| known.name);
        assert_eq!(name("fileINFO"), Some("FileInfo"));
        assert_eq!(name("M12SubExtends"), Some("M#SubExtends"));
        assert_eq!(name("MSubExtends"), None);
        assert_eq!(name("M1Fixed2000"), None);
        assert!(is_of_objects("M1Fixed2000sub1") && is_of_objects("1F20ObjectLinks"));
        assert!(!is_of_objects("M1Fixed20") && !is_of_objects("Fixed2000"));
        let device = section("DeviceInfo").unwrap().1;
        assert_eq!(
            key(device, "nrofrxpdo"),
            Some(("NrOfRXPDO", Form::Number(512)))
        );
        assert_eq!(key(device, "Baudrate_100"), None);
        let dummies = section("DummyUsage").unwrap().1;
        assert_eq!(key(dummies, "dummy001B"), Some(("Dummy#", Form::Flag)));
    }

    #[test]
    fn iso_8601_dates_and_times_are_converted() {
        assert_eq!(date("2026-07-14"), "07-14-2026");
        assert_eq!(date("2026-07-14T10:00"), "07-14-2026");
        assert_eq!(date("07-14-2026"), "07-14-2026");
        assert_eq!(date("2026-7"), "2026-7");
        assert_eq!(time("14:30:00+02:00"), "02:30PM");
        assert_eq!(
            (time("00:05").as_str(), time("12:00").as_str()),
            ("12:05AM", "12:00PM")
        );
        assert_eq!(
            (time("09:30AM").as_str(), time("25:00").as_str()),
            ("09:30AM", "25:00")
        );
    }

    #[test]
    fn misspelled_words_are_near() {
        let find = |word| near(word, OBJECT_KEYS.into_iter());
        assert_eq!(find("DefualtValue"), Some("DefaultValue"));
        assert_eq!(find("datatyp"), Some("DataType"));
        assert_eq!(find("LowLimits"), Some("LowLimit"));
        assert_eq!(find("Description"), None);
    }
}
