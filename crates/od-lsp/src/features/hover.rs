//! Hover: describes the object, key or value under the cursor, and the rules with a finding there.

use std::ops::Range;

use od_eds::check::Fixability;
use od_eds::outline::{self, Compact, Place};
use od_eds::{Description, Eds, Finding, say};
use od_model::{Access, Address, DataType, ObjectCode};

use crate::file::{File, Kind, Seen};
use crate::keys;
use crate::layout::{Pair, Section, Spot, bytes};
use crate::mentions::{self, listed, mapped, number, plain};
use crate::project;
use crate::standard;
use crate::types::{Hover, Markup};
use crate::words;
use crate::xdd;

/// The hover at a byte; `None` if there is no information.
pub(crate) fn at(file: &File, seen: &Seen, offset: usize) -> Option<Hover> {
    let spot = seen.layout.spot(offset);
    let mut parts: Vec<String> = spot.map_or_else(Vec::new, |spot| said(file, seen, spot));
    let mut here = None;
    if let Some((said, place)) = element(file.str(), seen, offset) {
        parts.push(said);
        here = Some(place);
    }
    if file.kind == Kind::Project
        && let Some(pair) = project::at(file.str(), offset)
        && let Some(says) = project::meaning(file.str(), &pair.key)
    {
        parts.push(format!("`{}`: {says}", file.part(pair.key.clone())));
        here = Some(pair.key);
    }
    for finding in &seen.findings {
        let Some(span) = finding.span().map(bytes) else {
            continue;
        };
        if span.start <= offset && offset <= span.end {
            here.get_or_insert(span);
            parts.push(explained(finding));
        }
    }
    if parts.is_empty() {
        return None;
    }
    let range = match spot {
        Some(Spot::Header(section)) => Some(section.header.clone()),
        Some(Spot::Key(_, pair)) => Some(pair.key.clone()),
        Some(Spot::Value(_, pair)) => Some(plain(file.str(), pair)),
        None => here,
    };
    Some(Hover {
        contents: Markup::markdown(parts.join("\n\n---\n\n")),
        range: range.map(|range| file.text.range(range)),
    })
}

fn said(file: &File, seen: &Seen, spot: Spot<'_>) -> Vec<String> {
    let section = spot.section();
    let about = about(file, seen, section);
    let own = match spot {
        Spot::Header(_) => None,
        Spot::Key(_, pair) => match listed(file.str(), section, pair) {
            Some(index) => Some(object(seen, Address::new(index, 0), true)),
            None => key(file, section, pair),
        },
        Spot::Value(_, pair) => value(file, seen, section, pair),
    };
    match (own, about) {
        (Some(own), Some(about)) => vec![format!("{own}\n\n{about}")],
        (own, about) => own.into_iter().chain(about).collect(),
    }
}

/// The subject of a section.
fn about(file: &File, seen: &Seen, section: &Section) -> Option<String> {
    let (at, whole) = match section.place {
        Place::Object(index) | Place::Compact(index, _) => (Address::new(index, 0), true),
        Place::Member(index, sub) => (Address::new(index, sub), false),
        Place::List(_) | Place::Other => {
            let name = file.part(section.name.clone());
            return mentions::header(file.str(), section)
                .map(|links| words::heading(&seen.description, links.object))
                .or_else(|| keys::section(name).map(str::to_owned));
        }
    };
    Some(object(seen, at, whole))
}

/// An object or a sub-object in words.
pub(crate) fn object(seen: &Seen, at: Address, whole: bool) -> String {
    let description = &seen.description;
    let mut lines = vec![words::heading(description, at)];
    let Some(object) = description.objects.get(&at.index) else {
        let unread = seen
            .problems
            .first()
            .filter(|_| description.objects.is_empty());
        lines.push(match unread {
            Some((_, why)) => format!(
                "odkit does not know the objects of this overlay: {}.",
                words::escaped(why)
            ),
            None => "The file does not define this object.".into(),
        });
        return lines.join("\n\n");
    };
    if whole && object.code.has_members() {
        let count = object.entries.len();
        let noun = if count == 1 {
            "sub-object"
        } else {
            "sub-objects"
        };
        lines.push(format!("{}, {count} {noun}", object.code.name()));
        return lines.join("\n\n");
    }
    let Some(entry) = object.entries.get(&at.sub) else {
        lines.push("The file does not define this sub-object.".into());
        return lines.join("\n\n");
    };
    let mappable = if *entry.mappable {
        ", mappable into a PDO"
    } else {
        ""
    };
    lines.push(format!("{}{mappable}", words::of_type(entry)));
    for (name, given) in [
        ("DefaultValue", &entry.default),
        ("ParameterValue", &entry.parameter),
    ] {
        let said = given.as_ref();
        let said = said.and_then(|given| words::value(description, at, entry, &given.value));
        if let Some(said) = said {
            lines.push(format!("{name}: {}", words::escaped(&said)));
        }
    }
    lines.join("\n\n")
}

fn key(file: &File, section: &Section, pair: &Pair) -> Option<String> {
    let key = file.part(pair.key.clone());
    let said = match section.place {
        Place::Object(_) | Place::Member(..) => keys::of_object(key),
        _ => keys::of_section(file.part(section.name.clone()), key),
    };
    let name = file.part(section.name.clone());
    let dummy = key.strip_prefix("Dummy").filter(|_| name == "DummyUsage");
    let dummy = dummy.and_then(|code| u16::from_str_radix(code, 16).ok());
    let dummy = dummy.and_then(DataType::from_code);
    let dummy = dummy.map_or_else(String::new, |own| format!(" It is {}.", own.name()));
    said.map(|said| format!("`{}`: {said}{dummy}", key.replace('`', "'")))
}

/// A value of another section in words: its meaning, and its number in the other base.
fn other(file: &File, section: &Section, pair: &Pair) -> Option<String> {
    let said = key(file, section, pair)?;
    let given = file.part(plain(file.str(), pair));
    let name = file.part(section.name.clone());
    let form = outline::section(name).and_then(|(_, known)| {
        let (_, form) = outline::key(known, file.part(pair.key.clone()))?;
        Some(form)
    });
    let is_number = matches!(form, Some(outline::Form::Number(_)));
    let number = number(file.str(), pair).filter(|_| is_number);
    Some(match number {
        Some(number @ 10..) => format!("{said}\n\n{number} ({number:X}h)"),
        Some(number @ 0..) if given != number.to_string() => format!("{said}\n\n{number}"),
        _ => said,
    })
}

/// A value in words.
fn value(file: &File, seen: &Seen, section: &Section, pair: &Pair) -> Option<String> {
    let text = file.str();
    let description = &seen.description;
    if let Some(index) = listed(text, section, pair) {
        return Some(object(seen, Address::new(index, 0), true));
    }
    if let Some(mapped) = mapped(text, section, pair) {
        let whole = description
            .objects
            .get(&mapped.object.index)
            .is_none_or(|object| !object.code.has_members());
        let dummy = DataType::from_code(mapped.object.index)
            .map(|dummy| format!("dummy entry, {}", dummy.name()));
        let about = dummy.unwrap_or_else(|| object(seen, mapped.object, whole));
        return Some(format!("maps {}\n\n{about}", words::mapping(mapped)));
    }
    let at = match section.place {
        Place::Object(index) => Address::new(index, 0),
        Place::Member(index, sub) => Address::new(index, sub),
        Place::Compact(index, Compact::Value) => {
            let sub = outline::number(file.part(pair.key.clone()))?;
            Address::new(index, u8::try_from(sub).ok()?)
        }
        _ => return other(file, section, pair),
    };
    let key = file.part(pair.key.clone()).to_ascii_lowercase();
    let code = || number(text, pair).and_then(|number| u16::try_from(number).ok());
    let given = file.part(plain(text, pair));
    match key.as_str() {
        "datatype" => Some(match DataType::from_code(code()?) {
            Some(known) => words::data_type(known),
            None => words::heading(description, Address::new(code()?, 0)),
        }),
        "objecttype" => ObjectCode::from_code(u8::try_from(code()?).ok()?).map(code_of),
        "accesstype" => {
            let mut all = Access::ALL.into_iter();
            let access = all.find(|access| access.name().eq_ignore_ascii_case(given))?;
            Some(access_of(access))
        }
        "pdomapping" => Some(words::mappable(code()? != 0).into()),
        "lowlimit" | "highlimit" => {
            let entry = description.entry(at)?;
            let limit = [&entry.low, &entry.high].into_iter().flatten();
            let mut own = limit.filter(|limit| limit.span.start as usize == pair.value.start);
            let said = words::value(
                description,
                Address::new(0x2000, 0),
                entry,
                &own.next()?.value,
            )?;
            Some(words::escaped(&said))
        }
        "defaultvalue" | "parametervalue" => {
            let name = standard::name(at.index, standard::profile(description));
            // The description of the object below includes the value.
            name.map_or_else(|| None, |_| self::key(file, section, pair))
        }
        _ => self::key(file, section, pair),
    }
}

fn code_of(code: ObjectCode) -> String {
    format!("{}: {}", code.name(), words::code(code))
}

fn access_of(access: Access) -> String {
    format!("`{}`: {}", access.name(), words::access(access))
}

/// Describes the XDD field at a byte and the object that it belongs to; also returns the place of the field.
fn element(text: &str, seen: &Seen, offset: usize) -> Option<(String, Range<usize>)> {
    let (element, field) = xdd::at(&seen.elements, offset)?;
    let place = field.map_or(&element.tag, |field| &field.value).clone();
    let (at, whole) = match element.place {
        Place::Object(index) => (Address::new(index, 0), true),
        Place::Member(index, sub) => (Address::new(index, sub), false),
        _ => {
            let key = &field?.key;
            let said = keys::of_section(&element.name, key)?;
            return Some((format!("`{key}`: {said}"), place));
        }
    };
    let mut about = object(seen, at, whole);
    for (lang, said) in xdd::texts(text, element) {
        let language = if lang.is_empty() {
            lang
        } else {
            format!(" ({lang})")
        };
        about.push_str(&format!("\n\n{}{language}", words::escaped(&said)));
    }
    let own = field.and_then(|field| field_of(&seen.description, at, &field.key));
    let said = own.map_or_else(|| about.clone(), |own| format!("{own}\n\n{about}"));
    Some((said, place))
}

/// Describes the value of an XDD field; `None` if the description of the object already includes it.
fn field_of(description: &Description, at: Address, key: &str) -> Option<String> {
    let object = description.objects.get(&at.index)?;
    let entry = || object.entries.get(&at.sub);
    match key {
        "ObjectType" if at.sub == 0 => Some(code_of(*object.code)),
        "DataType" => Some(words::data_type(*entry()?.data_type?)),
        "AccessType" => Some(access_of(*entry()?.access)),
        "PDOMapping" => Some(words::mappable(*entry()?.mappable).into()),
        "LowLimit" | "HighLimit" => {
            let entry = entry()?;
            let limit = match key {
                "LowLimit" => entry.low.as_ref()?,
                _ => entry.high.as_ref()?,
            };
            let nowhere = Address::new(0x2000, 0);
            let said = words::value(description, nowhere, entry, &limit.value)?;
            Some(words::escaped(&said))
        }
        _ => None,
    }
}

/// The rule of a finding, in the form of `odkit explain`.
pub(crate) fn explained(finding: &Finding) -> String {
    let rule = finding.rule;
    let fix = match rule.fixability {
        Fixability::None => "no fix; correct the file yourself",
        Fixability::Safe => "safe fix",
        Fixability::Unsafe => "unsafe fix; review the result",
        Fixability::Either => "safe fix, or an unsafe one if content is lost",
    };
    let said = say(finding, &Eds);
    format!(
        "**{}** {}\n\n{}\n\n{}\n\nFix: {fix}. Source: {}",
        rule.code,
        words::escaped(rule.title),
        words::escaped(&said.message),
        rule.why,
        rule.source
    )
}
