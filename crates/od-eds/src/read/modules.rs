//! Modular devices: the modules of a bus coupler extend its dictionary (CiA 306-1, modular devices).
//!
//! `[SupportedModules]` names them; `[M1FixedObjects]` lists objects that exist once a
//! module of this kind is plugged in, `[M1SubExtends]` objects to which every module adds
//! sub-indices.

use alloc::borrow::Cow;
use alloc::collections::{BTreeMap, BTreeSet};
use alloc::format;
use alloc::string::String;
use alloc::vec::Vec;

use crate::description::{Description, EntryDescription, ObjectDescription, Section};
use crate::log::Log;
use crate::read::sorted;
use crate::rules::lists::reader::{
    w0215_no_section, w0215_unlisted, w0249_extended_object_missing,
};
use crate::rules::standard::reader::w0609_key_value_not_valid;
use crate::rules::structure::reader::w0323_module_count;
use crate::scan::forms::{self, Form, ModulePart};
use crate::scan::names::Place;
use crate::scan::number::{self, integer};
use crate::scan::section::{Text, TextSection};
use crate::span::{Span, Spanned};

/// One kind of module.
#[derive(Clone, PartialEq, Debug, Default)]
pub struct Module {
    /// Its number in `[SupportedModules]`, from 1.
    pub number: u16,
    /// Its name there; empty if no list has it.
    pub name: String,
    /// Objects of the device while such a module is plugged in.
    pub fixed: BTreeMap<u16, ObjectDescription>,
    /// Objects to which each such module adds sub-indices.
    pub extensions: BTreeMap<u16, Extension>,
}

/// The sub-indices that a module adds to an object.
#[derive(Clone, PartialEq, Debug)]
pub struct Extension {
    /// The description of each sub-index.
    pub entry: EntryDescription,
    /// Their number.
    pub count: Count,
    /// ObjExtend in the file; 0 if it is missing.
    pub extend: u8,
}

/// Way in which the values of a module fill sub-indices.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Count {
    /// Number of new sub-indices per module.
    Each(u8),
    /// Number of bits per module; a new sub-index begins when the last one is full.
    Bits(u8),
}

/// The modules with sections in a description, by number.
pub fn modules(description: &Description) -> Vec<Module> {
    read(&description.sections, &mut Log::default())
}

/// The module numbers in the `[ConnectedModules]` of a DCF, in their order.
pub fn connected_modules(description: &Description) -> Vec<u16> {
    let Some(section) = description.section("ConnectedModules") else {
        return Vec::new();
    };
    let mut found: Vec<(i128, u16)> = section
        .pairs
        .iter()
        .filter_map(|(key, value)| {
            let module = u16::try_from(crate::scan::number::number(value)?).ok()?;
            Some((crate::scan::number::number(key)?, module))
        })
        .collect();
    found.sort_unstable();
    found.into_iter().map(|(_, module)| module).collect()
}

/// The description of the device with these modules, in the order of their slots.
///
/// Missing fixed objects are added. Extended objects get their
/// sub-indices after the existing ones, and sub-index 0 counts them. Unknown module
/// numbers are ignored, and so are values beyond sub-index 254.
pub fn with_modules(description: &Description, numbers: &[u16]) -> Description {
    let known = modules(description);
    let mut made = description.clone();
    // Bits that are still free in the last sub-index of an object.
    let mut left: BTreeMap<u16, u8> = BTreeMap::new();
    for number in numbers {
        let Some(module) = known.iter().find(|module| module.number == *number) else {
            continue;
        };
        for (index, object) in &module.fixed {
            let object = || object.clone();
            made.objects.entry(*index).or_insert_with(object);
        }
        for (index, extension) in &module.extensions {
            if let Some(object) = made.objects.get_mut(index) {
                extend(object, extension, left.entry(*index).or_default());
            }
        }
    }
    made
}

fn extend(object: &mut ObjectDescription, extension: &Extension, left: &mut u8) {
    let count = match extension.count {
        Count::Each(count) => count,
        Count::Bits(bits) => {
            let whole = extension
                .entry
                .data_type
                .and_then(|t| t.bits())
                .unwrap_or(8);
            match left.checked_sub(bits) {
                Some(rest) => {
                    *left = rest;
                    return;
                }
                None => {
                    *left = whole.saturating_sub(bits);
                    1
                }
            }
        }
    };
    for _ in 0..count {
        let last = object.entries.keys().next_back().copied().unwrap_or(0);
        if last >= 254 {
            return;
        }
        let sub = last + 1;
        let mut entry = extension.entry.clone();
        entry.name.value = format!("{} {sub}", entry.name.value);
        object.entries.insert(sub, entry);
        if let Some(highest) = object.entries.get_mut(&0) {
            let value = crate::description::Value::Unsigned(u64::from(sub));
            highest.default = Some(Spanned::from(value));
        }
    }
    object.sub_number = Some(Spanned::from(object.entries.len() as u32));
}

/// Reports problems with the modules of a file.
pub(crate) fn check(description: &Description, log: &mut Log) {
    let sections = &description.sections;
    let is_part = |section: &Section| {
        let name = &section.name;
        forms::module_part(name).is_some() || list_of(name).is_some()
    };
    if !sections.iter().any(is_part) {
        return;
    }
    let modules = read(sections, log);
    for section in sections {
        let part = forms::module_part(&section.name).filter(|part| part.extends);
        if let Some(part) = part
            && let Place::Object(index) = part.place
        {
            let module = modules.iter().find(|module| module.number == part.module);
            let fixed = module.is_some_and(|module| module.fixed.contains_key(&index));
            if !fixed && !description.objects.contains_key(&index) {
                log.push(w0249_extended_object_missing(
                    section.name.span,
                    index,
                    part.module,
                ));
            }
        }
    }
}

/// The module and the kind of a list: `M1FixedObjects` or `M1SubExtends`.
fn list_of(name: &str) -> Option<(u16, bool)> {
    let rest = name.strip_prefix(['M', 'm'])?;
    let digits = rest.bytes().take_while(u8::is_ascii_digit).count();
    let module = rest[..digits].parse().ok()?;
    let words = [("FixedObjects", false), ("SubExtends", true)];
    let is_word = |(word, _): &(&str, bool)| rest[digits..].eq_ignore_ascii_case(word);
    let (_, extends) = words.into_iter().find(is_word)?;
    Some((module, extends))
}

fn read(sections: &[Section], log: &mut Log) -> Vec<Module> {
    let mut modules: BTreeMap<u16, Module> = BTreeMap::new();
    let list = sections
        .iter()
        .find(|s| s.name.eq_ignore_ascii_case("SupportedModules"));
    for (key, value) in list.into_iter().flat_map(|list| &list.pairs) {
        let number = crate::scan::number::number(key).and_then(|number| u16::try_from(number).ok());
        if let Some(number) = number {
            let module = modules.entry(number).or_default();
            (module.number, module.name) = (number, value.value.clone());
        }
    }
    let mut parts: BTreeMap<(u16, bool), Vec<(Place, &Section)>> = BTreeMap::new();
    for section in sections {
        if let Some(ModulePart {
            module,
            extends,
            place,
        }) = forms::module_part(&section.name)
        {
            parts
                .entry((module, extends))
                .or_default()
                .push((place, section));
        }
    }
    for section in sections {
        if let Some(key) = list_of(&section.name) {
            parts.entry(key).or_default();
        }
    }
    for ((number, extends), found) in parts {
        let module = modules.entry(number).or_default();
        module.number = number;
        let word = if extends {
            "SubExtends"
        } else {
            "FixedObjects"
        };
        listed(sections, number, word, &found, log);
        if extends {
            for (place, section) in found {
                if let Place::Object(index) = place {
                    let own = extension(section, place, log).map(|own| (index, own));
                    module.extensions.extend(own);
                }
            }
        } else {
            let placed = found
                .into_iter()
                .map(|(place, section)| placed(section, place, &[]));
            module.fixed = sorted::objects(placed.collect(), log).objects;
        }
    }
    modules.into_values().collect()
}

fn borrow(text: &Spanned<String>) -> Text<'_> {
    Spanned::new(Cow::Borrowed(text.value.as_str()), text.span)
}

/// Renames the section of an object of a module to that of an object.
fn placed<'a>(section: &'a Section, place: Place, without: &[&str]) -> TextSection<'a> {
    let name = place.name().unwrap_or_default();
    let is_own = |key: &str| !without.iter().any(|word| key.eq_ignore_ascii_case(word));
    let pairs = section.pairs.iter().filter(|(key, _)| is_own(key));
    let pairs = pairs.map(|(key, value)| (borrow(key), borrow(value)));
    let header = section.name.span;
    let mut placed = TextSection::new(Spanned::new(Cow::Owned(name), header), header);
    placed.pairs.extend(pairs);
    placed
}

fn extension(section: &Section, place: Place, log: &mut Log) -> Option<Extension> {
    let own = placed(section, place, &["Count", "ObjExtend"]);
    let described = sorted::objects(alloc::vec![own], log);
    let object = described.objects.into_values().next()?;
    let entry = object.entries.into_values().next()?;
    let given = section.get("Count");
    let count = given.and_then(|given| count(given));
    if count.is_none() {
        log.push(w0323_module_count(section.name.span, given));
    }
    let given = section.get("ObjExtend");
    let extend = given.and_then(|given| crate::scan::number::number(given));
    if let Some(given) = given.filter(|_| extend.is_none_or(|extend| !matches!(extend, 0 | 1))) {
        let (name, given) = (&section.name, borrow(given));
        log.push(w0609_key_value_not_valid(
            name,
            "ObjExtend",
            &given,
            Form::Flag,
        ));
    }
    Some(Extension {
        entry,
        count: count.unwrap_or(Count::Each(1)),
        extend: extend.and_then(|n| u8::try_from(n).ok()).unwrap_or(0),
    })
}

/// `4`, or `0;2` for two bits.
fn count(text: &str) -> Option<Count> {
    let number = |text: &str| {
        let read = integer(text.trim(), &mut Vec::new())?;
        u8::try_from(read.value).ok()
    };
    let Some((subs, bits)) = text.split_once(';') else {
        return number(text).map(Count::Each);
    };
    match (number(subs)?, number(bits)?) {
        (0, bits @ 1..) => Some(Count::Bits(bits)),
        (subs @ 1.., _) => Some(Count::Each(subs)),
        _ => None,
    }
}

/// Compares the object list of a module with its sections.
fn listed(
    sections: &[Section],
    module: u16,
    word: &str,
    found: &[(Place, &Section)],
    log: &mut Log,
) {
    let name = format!("M{module}{word}");
    let list = sections
        .iter()
        .find(|section| section.name.eq_ignore_ascii_case(&name));
    let listed: Vec<(u16, Span)> = list
        .into_iter()
        .flat_map(|list| &list.pairs)
        .filter(|(key, _)| !key.eq_ignore_ascii_case("NrOfEntries"))
        .filter_map(|(_, value)| {
            let text = number::before_comment(value);
            let index = u16::try_from(integer(text, &mut Vec::new())?.value).ok()?;
            Some((index, value.span))
        })
        .collect();
    let described: BTreeSet<u16> = found
        .iter()
        .filter_map(|(place, _)| match place {
            Place::Object(index) => Some(*index),
            _ => None,
        })
        .collect();
    for (index, span) in &listed {
        if !described.contains(index) {
            log.push(w0215_no_section(*span, *index, module));
        }
    }
    let listed: BTreeSet<u16> = listed.into_iter().map(|(index, _)| index).collect();
    for (place, section) in found {
        let Place::Object(index) = place else {
            continue;
        };
        if !listed.contains(index) {
            log.push(w0215_unlisted(section.name.span, *index, &name));
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::description::Value;
    use od_model::Address;

    const TEXT: &str = "[OptionalObjects]\nSupportedObjects=1\n1=0x6000\n\
        [6000]\nParameterName=Inputs\nObjectType=8\nSubNumber=1\n\
        [6000sub0]\nParameterName=n\nDataType=5\nAccessType=ro\nDefaultValue=0\n\
        [SupportedModules]\nNrOfEntries=2\n1=Eight inputs\n2=Two inputs\n\
        [M1FixedObjects]\nNrOfEntries=1\n1=0x2000\n\
        [M1Fixed2000]\nParameterName=Filter\nDataType=5\nAccessType=rw\nDefaultValue=300\n\
        [M1SubExtends]\nNrOfEntries=1\n1=0x6000\n\
        [M1SubExt6000]\nParameterName=Input\nDataType=5\nAccessType=ro\nPDOMapping=1\nCount=2\n\
        [M2SubExt6000]\nParameterName=Input\nDataType=5\nAccessType=ro\nPDOMapping=1\nCount=0; 2\n\
        [ConnectedModules]\nNrOfEntries=2\n2=2\n1=1\n";

    #[test]
    fn modules_and_their_problems() {
        let parsed = crate::parse(TEXT);
        let codes: Vec<_> = parsed.findings.iter().map(|d| d.code()).collect();
        // The checks look at the value of the fixed object; the second list is missing.
        assert_eq!(codes, ["W0215"]);
        let found = modules(&parsed.description);
        assert_eq!((found.len(), found[0].name.as_str()), (2, "Eight inputs"));
        assert!(found[0].fixed.contains_key(&0x2000));
        assert_eq!(found[0].extensions[&0x6000].count, Count::Each(2));
        assert_eq!(found[1].extensions[&0x6000].count, Count::Bits(2));
        assert_eq!(connected_modules(&parsed.description), [1, 2]);
        for (wrong, code) in [
            ("Count=2", "Count=many"),
            ("1=0x2000", "1=0x2001"),
            ("AccessType=rw", "AccessType=rx"),
        ]
        .iter()
        .zip(["W0323", "W0215", "E0405"])
        .map(|((from, to), code)| (TEXT.replacen(from, to, 1), code))
        {
            let codes: Vec<_> = crate::parse(&wrong)
                .findings
                .iter()
                .map(|d| d.code())
                .collect();
            assert!(codes.contains(&code), "{code}: {codes:?}");
        }
    }

    #[test]
    fn modules_extend_a_device_in_their_order() {
        let base = crate::parse(TEXT).description;
        let made = with_modules(&base, &[1, 2, 2, 2, 2, 2, 9]);
        assert!(made.objects.contains_key(&0x2000));
        let subs: Vec<u8> = made.objects[&0x6000].entries.keys().copied().collect();
        // Two bits of the first module, one that four of the second share, one of the fifth.
        assert_eq!(subs, [0, 1, 2, 3, 4]);
        let highest = made.entry(Address::new(0x6000, 0)).unwrap();
        assert_eq!(highest.default.as_deref(), Some(&Value::Unsigned(4)));
        assert_eq!(made.objects[&0x6000].entries[&4].name.value, "Input 4");
    }
}
