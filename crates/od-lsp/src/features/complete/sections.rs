//! The sections that can be added to a file: mandatory objects first.

use std::collections::BTreeMap;

use od_eds::outline::{List, Place, SECTIONS, data_type, profile_objects, specified};
use od_eds::{Description, EntryDescription, ObjectDescription, Spanned};
use od_model::{Access, DataType, ObjectCode};

use crate::features::complete::values::Choice;
use crate::file::Seen;
use crate::keys;
use crate::layout::{Layout, Section};
use crate::standard;

/// The mandatory objects of CiA 301.
const MANDATORY: [u16; 3] = [0x1000, 0x1001, 0x1018];

/// Completions of a section name; with the keys of an object if its section `is_empty`.
pub(super) fn of(seen: &Seen, current: Option<&Section>, is_empty: bool) -> Vec<Choice> {
    let description = &seen.description;
    let has = |index: u16| {
        let own = seen.layout.section_of(Place::Object(index));
        own.is_some_and(|own| current.is_none_or(|current| current.header != own.header))
    };
    let mut choices = Vec::new();
    for index in MANDATORY.into_iter().filter(|index| !has(*index)) {
        let mut choice = object(index, None, is_empty);
        choice.detail.push_str(", mandatory");
        choices.push(choice);
    }
    choices.extend(members(seen, current));
    for name in lacking(description, &seen.layout) {
        choices.push(Choice {
            text: Some(format!("{name}]")),
            note: keys::section(name).map(str::to_owned),
            ..Choice::new(name, "")
        });
    }
    let profile = standard::profile(description);
    let name = |index: u16| specified(index).map(|known| known.name);
    let of_standard = (0x1000..0x2000u16).filter(|index| {
        // Of a range of objects with one name, the first.
        name(*index).is_some() && name(*index) != name(index - 1)
    });
    let of_profile = profile.into_iter().flat_map(profile_objects);
    let others = of_standard.chain(of_profile.map(|(index, _)| index));
    let others = others.filter(|index| !has(*index) && !MANDATORY.contains(index));
    choices.extend(others.map(|index| object(index, profile, is_empty)));
    choices
}

fn object(index: u16, profile: Option<u16>, is_empty: bool) -> Choice {
    let named = standard::name(index, profile);
    let (name, source) = named.unwrap_or_default();
    let text = match specified(index) {
        Some(known) if is_empty => sections(index, known.name, known.code, known.access),
        _ => format!("{index:04X}]"),
    };
    Choice {
        text: Some(text),
        filter: Some(format!("{index:04X} {name}")),
        ..Choice::new(format!("{index:04X}"), format!("{name} ({source})"))
    }
}

/// The sections of an object of the standards, without the first bracket and the last line end.
fn sections(index: u16, name: &str, code: ObjectCode, access: Access) -> String {
    let mut name = name.to_owned();
    if let Some(first) = name.get_mut(..1) {
        first.make_ascii_uppercase();
    }
    let value = |sub: u8, name: &str, whole: bool| {
        let own = data_type(index, sub, whole).unwrap_or(DataType::Unsigned32);
        let mut entry = EntryDescription::new(name, own);
        entry.access = Spanned::from(if sub == 0 && !whole {
            Access::Const
        } else {
            access
        });
        entry
    };
    let object = if code.has_members() {
        let mut object = ObjectDescription::var(value(0, &name, true));
        object.code = Spanned::from(code);
        let first = match index {
            0x1018 => "Vendor-ID",
            _ => "Entry 1",
        };
        object.entries = BTreeMap::from([
            (0, value(0, "Highest sub-index supported", false)),
            (1, value(1, first, false)),
        ]);
        object
    } else {
        ObjectDescription::var(value(0, &name, true))
    };
    let objects = BTreeMap::from([(index, object)]);
    let text = od_eds::write(&Description {
        objects,
        ..Description::default()
    });
    let own = text
        .split_once(&format!("[{index:04X}]"))
        .map(|(_, own)| own);
    // The lists of the later object types are written after the object.
    let own = own.and_then(|own| {
        let lists = own
            .find("\n\n[Optional")
            .or_else(|| own.find("\n\n[Manufacturer"));
        own.get(..lists.unwrap_or(own.len()))
    });
    format!("{index:04X}]{}", own.unwrap_or_default().trim_end())
}

/// The next sub-objects of the object above.
fn members(seen: &Seen, current: Option<&Section>) -> Vec<Choice> {
    let Some(current) = current else {
        return Vec::new();
    };
    let before = seen.layout.sections.iter();
    let before = before.take_while(|section| section.header.start < current.header.start);
    let Some(index) = before.last().and_then(Section::index) else {
        return Vec::new();
    };
    let own = seen
        .layout
        .sections_of(index)
        .filter(|own| own.header != current.header);
    let subs: Vec<u8> = own
        .filter_map(|section| match section.place {
            Place::Member(_, sub) => Some(sub),
            _ => None,
        })
        .collect();
    let object = seen.description.objects.get(&index);
    if !object.is_some_and(|object| object.code.has_members()) && subs.is_empty() {
        return Vec::new();
    }
    let next = subs
        .iter()
        .max()
        .map_or(Some(0), |last| last.checked_add(1));
    let missing =
        (0..8).filter(|sub| data_type(index, *sub, false).is_some() && !subs.contains(sub));
    let mut all: Vec<u8> = next.into_iter().chain(missing).collect();
    all.dedup();
    let choice = |sub: u8| {
        let name = format!("{index:04X}sub{sub:X}");
        Choice {
            text: Some(format!("{name}]")),
            ..Choice::new(name, format!("sub-object of {index:04X}h"))
        }
    };
    all.into_iter().map(choice).collect()
}

/// The sections without a number in their name that a file lacks.
fn lacking<'a>(
    description: &'a Description,
    layout: &'a Layout,
) -> impl Iterator<Item = &'static str> + 'a {
    let names = SECTIONS.iter().map(|known| known.name);
    let names = names.filter(|name| !name.contains('#') && *name != "DeviceCommissioning");
    let lists = List::ALL.into_iter();
    let lists = lists.filter(|list| layout.section_of(Place::List(*list)).is_none());
    names
        .filter(|name| description.section(name).is_none())
        .chain(lists.map(List::name))
}
