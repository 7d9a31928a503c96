//! Completion of sections, keys, and the values of keys with a list of values.

use std::ops::Range;

use od_eds::network::keys::{OF_LIST, OF_LISTED};
use od_eds::outline::{self, Form, List, OBJECT_KEYS, Place};

use crate::features::complete::values::Choice;
use crate::file::{File, Kind, Seen};
use crate::keys;
use crate::layout::{Layout, Section};
use crate::project;
use crate::types::{CompletionItem, CompletionList, Markup, TextEdit};
use crate::xdd::{self, Cursor};

mod sections;
mod values;

/// Kinds of items.
const PROPERTY: u8 = 10;
const VALUE: u8 = 12;
const MODULE: u8 = 9;

/// The line under the cursor.
struct Line<'a> {
    file: &'a File,
    /// Its text before and after the cursor.
    before: &'a str,
    behind: &'a str,
    offset: usize,
}

impl Line<'_> {
    fn item(&self, kind: u8, choice: Choice, bytes: &Range<usize>, rank: usize) -> CompletionItem {
        CompletionItem {
            kind,
            sort_text: format!("{rank:04}"),
            filter_text: choice.filter.unwrap_or_else(|| choice.label.clone()),
            detail: choice.detail,
            documentation: choice.note.map(Markup::markdown),
            text_edit: TextEdit {
                range: self.file.text.range(bytes.clone()),
                new_text: choice.text.unwrap_or_else(|| choice.label.clone()),
            },
            label: choice.label,
        }
    }

    fn items(&self, kind: u8, choices: Vec<Choice>, bytes: &Range<usize>) -> Vec<CompletionItem> {
        let ranked = choices.into_iter().enumerate();
        ranked
            .map(|(rank, choice)| self.item(kind, choice, bytes, rank))
            .collect()
    }
}

/// Returns the completions at a byte.
pub(crate) fn at(file: &File, seen: &Seen, offset: usize) -> CompletionList {
    let bytes = file.text.line(file.text.line_at(offset));
    let line = Line {
        file,
        before: file.part(bytes.start..offset.min(bytes.end)),
        behind: file.part(offset.min(bytes.end)..bytes.end),
        offset,
    };
    let items = match xdd::at(&seen.elements, offset) {
        Some((element, Some(field))) => {
            let name = xdd::name(file.str(), field);
            let choices = values::of_attribute(seen, element.place, name);
            if choices.is_empty() {
                in_tag(&line)
            } else {
                line.items(VALUE, choices, &field.value)
            }
        }
        _ if od_eds::is_xml(file.str()) => in_tag(&line),
        _ if file.kind == Kind::Project => in_project(&line),
        _ => in_eds(&line, seen, bytes.start),
    };
    CompletionList {
        is_incomplete: false,
        items,
    }
}

/// The completions in a start tag of an XDD: attributes that the element lacks, or the values of an attribute.
fn in_tag(line: &Line<'_>) -> Vec<CompletionItem> {
    let text = line.file.str();
    let Some(tag) = xdd::tag(text, line.offset) else {
        return Vec::new();
    };
    match tag.cursor {
        Cursor::Name(typed) => {
            let attributes = od_eds::xdd::attributes(tag.element).iter();
            let others = attributes.filter(|own| {
                let has = xdd::attribute(text, &tag.range, own.name);
                has.is_none()
            });
            let choices = others.map(|own| Choice {
                text: Some(format!("{}=\"\"", own.name)),
                ..Choice::new(own.name, "")
            });
            line.items(PROPERTY, choices.collect(), &typed)
        }
        Cursor::Value(name, value) => {
            let choices = values::of_schema(tag.element, name);
            line.items(VALUE, choices, &value)
        }
    }
}

/// The keys of a project at the beginning of a line, or in braces.
fn in_project(line: &Line<'_>) -> Vec<CompletionItem> {
    let is_of_word = |c: char| c.is_ascii_alphanumeric() || c == '_';
    let before = line.before.trim_end_matches(is_of_word);
    let begins = before.trim().is_empty() || before.trim_end().ends_with(['{', ',', '-']);
    if !begins || before.contains('#') {
        return Vec::new();
    }
    let word = line.behind.find(|c| !is_of_word(c));
    let word = word.unwrap_or(line.behind.len());
    let sign = if line.behind[word..].trim_start().starts_with(':') {
        ""
    } else {
        ": "
    };
    let keys = project::keys(line.file.str(), line.offset).iter();
    let choices = keys.map(|(name, says)| Choice {
        text: Some(format!("{name}{sign}")),
        note: Some((*says).to_owned()),
        ..Choice::new(*name, "")
    });
    let start = line.offset + before.len() - line.before.len();
    line.items(PROPERTY, choices.collect(), &(start..line.offset + word))
}

/// The completions in a line of an EDS, which begins at this byte.
fn in_eds(line: &Line<'_>, seen: &Seen, start: usize) -> Vec<CompletionItem> {
    match line.before.trim_start().as_bytes().first() {
        Some(b';' | b'#') => Vec::new(),
        Some(b'[') => header(line, seen),
        _ => match (line.before.find('='), seen.layout.section_at(start)) {
            (Some(sign), Some(section)) => value(line, seen, section, sign),
            (None, Some(section)) => key(line, &seen.layout, section),
            (_, None) => Vec::new(),
        },
    }
}

fn header(line: &Line<'_>, seen: &Seen) -> Vec<CompletionItem> {
    let Some(open) = line.before.find('[') else {
        return Vec::new();
    };
    // After the closing bracket there is nothing to complete.
    if line.before.contains(']') {
        return Vec::new();
    }
    let start = line.offset - line.before.len() + open + 1;
    let end = match line.behind.find(']') {
        Some(close) => line.offset + close + 1,
        None => line.offset + line.behind.trim_end().len(),
    };
    let section = seen.layout.section_at(line.offset);
    let is_empty = section.is_none_or(|section| section.pairs.is_empty());
    let choices = sections::of(seen, section, is_empty);
    line.items(MODULE, choices, &(start..end))
}

fn key(line: &Line<'_>, layout: &Layout, section: &Section) -> Vec<CompletionItem> {
    let text = line.file.str();
    let typed = line.before.trim_start();
    let start = line.offset - typed.len();
    let sign = line.behind.find('=');
    let word = sign.unwrap_or(line.behind.len());
    let end = line.offset + line.behind.get(..word).unwrap_or_default().trim_end().len();
    let current =
        |pair: &crate::layout::Pair| (pair.key.start..=pair.key.end).contains(&line.offset);
    let has = |key: &str| {
        let own = section.pairs.iter().filter(|pair| !current(pair));
        own.filter_map(|pair| text.get(pair.key.clone()))
            .any(|own| own.eq_ignore_ascii_case(key))
    };
    let is_dcf = line.file.path.to_ascii_lowercase().ends_with(".dcf")
        || layout.sections.iter().any(|other| {
            let name = text.get(other.name.clone()).unwrap_or_default();
            name.to_ascii_lowercase().starts_with("devicecom")
        });
    let choices = names(text, section, is_dcf, line.offset)
        .into_iter()
        .filter(|(key, _)| !has(key));
    let choices = choices.map(|(key, note)| Choice {
        text: Some(match sign {
            Some(_) => key.clone(),
            None => format!("{key}="),
        }),
        note: note.map(str::to_owned),
        ..Choice::new(key, "")
    });
    line.items(PROPERTY, choices.collect(), &(start..end))
}

/// The keys that a section may have, with their descriptions.
fn names(
    text: &str,
    section: &Section,
    is_dcf: bool,
    cursor: usize,
) -> Vec<(String, Option<&'static str>)> {
    match section.place {
        Place::Object(_) | Place::Member(..) => {
            let of_dcf = |key: &str| {
                matches!(
                    key,
                    "ParameterValue" | "Denotation" | "UploadFile" | "DownloadFile" | "ParamRefd"
                )
            };
            let own = OBJECT_KEYS.into_iter();
            let own = own.filter(|key| is_dcf || !of_dcf(key));
            let own = own.filter(|key| {
                matches!(section.place, Place::Object(_))
                    || !matches!(*key, "SubNumber" | "CompactSubObj")
            });
            own.map(|key| (key.to_owned(), keys::of_object(key)))
                .collect()
        }
        Place::List(_) => {
            let count = "SupportedObjects";
            let next = format!("{}", last(text, section, cursor) + 1);
            let said = keys::of_section("OptionalObjects", count);
            vec![(count.into(), said), (next, None)]
        }
        Place::Compact(..) => vec![
            ("NrOfEntries".into(), None),
            (format!("{}", last(text, section, cursor) + 1), None),
        ],
        Place::Other => {
            let name = text.get(section.name.clone()).unwrap_or_default();
            if name.to_ascii_lowercase().starts_with("topology") {
                return of_topology(text, section, cursor);
            }
            let known = outline::section(name).map_or(&[][..], |(_, known)| known.keys);
            let mut all: Vec<(String, Option<&'static str>)> = Vec::new();
            for (key, _) in known {
                match *key {
                    "Dummy#" => all.extend(
                        (1..=7).map(|n| (format!("Dummy{n:04}"), keys::of_section(name, key))),
                    ),
                    key if key.contains('#') => {
                        all.push((
                            key.replace('#', &format!("{}", last(text, section, cursor) + 1)),
                            None,
                        ));
                    }
                    key => all.push((key.into(), keys::of_section(name, key))),
                }
            }
            all
        }
    }
}

/// The keys of a node list: those of the network, and those of the node at the cursor, or of a new one.
fn of_topology(
    text: &str,
    section: &Section,
    cursor: usize,
) -> Vec<(String, Option<&'static str>)> {
    let number = |key: &Range<usize>| {
        let rest = text.get(key.clone())?.get("Node".len()..)?;
        let end = rest.find(|c: char| !c.is_ascii_digit());
        rest[..end.unwrap_or(rest.len())].parse::<u32>().ok()
    };
    let keys = || section.pairs.iter().map(|pair| &pair.key);
    let is_here = |key: &&Range<usize>| (key.start..=key.end).contains(&cursor);
    let above = keys().rfind(|key| key.end < cursor).and_then(number);
    let before = &text[..cursor];
    let typed = before.rfind(['\n', '\r']).map_or(0, |at| at + 1)..cursor;
    let own = number(&typed).or_else(|| keys().find(is_here).and_then(number));
    let node = own.or(above).unwrap_or(1);
    let mut all: Vec<(String, Option<&'static str>)> = Vec::new();
    for id in [Some(node), (own.is_none() && node < 127).then(|| node + 1)] {
        let keys = OF_LISTED.iter();
        all.extend(id.into_iter().flat_map(|id| {
            let named = keys.clone();
            named.map(move |(end, says)| (format!("Node{id}{end}"), Some(*says)))
        }));
    }
    all.extend(
        OF_LIST
            .iter()
            .map(|(name, says)| ((*name).to_owned(), Some(*says))),
    );
    all
}

/// The largest number at the end of a key, without the key at the cursor: `3` of `Line3` or `3`.
fn last(text: &str, section: &Section, cursor: usize) -> u64 {
    let pairs = section.pairs.iter();
    let others = pairs.filter(|pair| !(pair.key.start..=pair.key.end).contains(&cursor));
    let keys = others.filter_map(|pair| text.get(pair.key.clone()));
    let numbers = keys.filter_map(|key| {
        let digits = key.trim_start_matches(|c: char| !c.is_ascii_digit());
        digits.parse::<u64>().ok()
    });
    numbers.max().unwrap_or(0).min(u64::from(u32::MAX))
}

fn value(line: &Line<'_>, seen: &Seen, section: &Section, sign: usize) -> Vec<CompletionItem> {
    let text = line.file.str();
    let key = line.before.get(..sign).unwrap_or_default().trim();
    let typed = line.before.get(sign + 1..).unwrap_or_default().trim_start();
    let start = line.offset - typed.len();
    let rest = outline::before_comment(line.behind);
    let end = line.offset + rest.trim_end().len();
    let choices = match section.place {
        Place::Object(_) | Place::Member(..) => values::of_object(seen, section, key),
        Place::List(list) => listed(line.file.str(), seen, section, list),
        _ => {
            let name = text.get(section.name.clone()).unwrap_or_default();
            let known = outline::section(name).and_then(|(_, known)| outline::key(known, key));
            match known {
                Some((_, Form::Flag)) => vec![Choice::new("0", "no"), Choice::new("1", "yes")],
                Some((_, Form::Version)) => {
                    let versions = ["4.0", "4.1", "4.2"].into_iter();
                    versions.map(|own| Choice::new(own, "CiA 306-1")).collect()
                }
                Some(("Baudrate", _)) => bit_rates(text, &seen.layout),
                _ => Vec::new(),
            }
        }
    };
    line.items(VALUE, choices, &(start..end))
}

/// The bit rates that [DeviceInfo] supports.
fn bit_rates(text: &str, layout: &Layout) -> Vec<Choice> {
    let name = |section: &&Section| text.get(section.name.clone()) == Some("DeviceInfo");
    let info = layout.sections.iter().find(name);
    let pairs = info.into_iter().flat_map(|info| &info.pairs);
    let rates = pairs.filter_map(|pair| {
        let rate = text.get(pair.key.clone())?.strip_prefix("BaudRate_")?;
        let is_supported = text.get(pair.value.clone())?.trim() == "1";
        is_supported.then(|| Choice::new(rate, "kbit/s"))
    });
    rates.collect()
}

/// The objects that a list lacks.
fn listed(text: &str, seen: &Seen, section: &Section, list: List) -> Vec<Choice> {
    let pairs = section.pairs.iter();
    let known: Vec<u16> = pairs
        .filter_map(|pair| crate::mentions::listed(text, section, pair))
        .collect();
    let objects = seen.description.objects.iter();
    objects
        .filter(|(index, _)| List::of(**index) == list && !known.contains(index))
        .map(|(index, object)| Choice::new(format!("0x{index:04X}"), object.name.value.as_str()))
        .collect()
}
