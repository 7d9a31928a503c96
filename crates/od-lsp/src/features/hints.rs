//! Inlay hints: the meaning of a number, shown after it.

use std::ops::Range;

use od_eds::Description;
use od_eds::outline::{self, Place};
use od_model::{Address, DataType, ObjectCode};

use crate::cob_ids::{self, CobId};
use crate::file::{File, Seen};
use crate::layout::{Pair, Section};
use crate::mentions::{Mapped, is_mapping, is_value_key, listed, mapped, number, plain};
use crate::standard;
use crate::types::InlayHint;
use crate::words;
use crate::xdd::{Element, Field};

/// The hints of the values between two bytes.
pub(crate) fn of(file: &File, seen: &Seen, within: &Range<usize>) -> Vec<InlayHint> {
    let (layout, description) = (&seen.layout, &seen.description);
    let profile = standard::profile(description);
    let from = layout
        .sections
        .partition_point(|section| section.end() < within.start);
    let sections = layout.sections.iter().skip(from);
    let sections = sections.take_while(|section| section.header.start <= within.end);
    let pairs = sections.flat_map(|section| section.pairs.iter().map(move |pair| (section, pair)));
    let inside = |pair: &Pair| within.start <= pair.value.end && pair.value.start <= within.end;
    let shown = |at: usize, (label, tooltip)| InlayHint {
        position: file.text.position(at),
        label,
        kind: None,
        padding_left: true,
        tooltip,
    };
    let pairs = pairs.filter(|(_, pair)| inside(pair));
    let hints = pairs.filter_map(|(section, pair)| {
        let hint = hint(file.str(), description, section, pair, profile)?;
        Some(shown(plain(file.str(), pair).end, hint))
    });
    let elements = seen.elements.iter();
    let fields =
        elements.flat_map(|element| element.fields.iter().map(move |field| (element, field)));
    let inside = |field: &Field| within.start <= field.value.end && field.value.start <= within.end;
    let fields = fields.filter(|(_, field)| inside(field));
    let in_xdd = fields.filter_map(|(element, field)| {
        let hint = of_field(file.str(), description, element, field)?;
        // After the closing quotation mark.
        Some(shown(field.value.end + 1, hint))
    });
    hints.chain(in_xdd).collect()
}

/// The hint of a field of an XDD.
fn of_field(
    text: &str,
    description: &Description,
    element: &Element,
    field: &Field,
) -> Option<(String, Option<String>)> {
    let at = match element.place {
        Place::Object(index) => Address::new(index, 0),
        Place::Member(index, sub) => Address::new(index, sub),
        _ => return None,
    };
    let object = description.objects.get(&at.index)?;
    let entry = object.entries.get(&at.sub);
    match field.key.as_str() {
        "DataType" => Some((entry?.data_type?.name().into(), None)),
        "ObjectType" if matches!(element.place, Place::Object(_)) => {
            Some((object.code.name().into(), None))
        }
        "DefaultValue" | "ParameterValue" if is_mapping(at.index) && at.sub != 0 => {
            let mapped = Mapped::of(outline::number(text.get(field.value.clone())?)?)?;
            Some((
                words::mapping(mapped),
                words::mapped_name(description, mapped),
            ))
        }
        "DefaultValue" | "ParameterValue" if cob_ids::is_one(at) => {
            let values = [&entry?.default, &entry?.parameter].into_iter().flatten();
            let mut own = values.filter(|value| value.span.start as usize == field.value.start);
            Some((CobId::of(&own.next()?.value)?.words(at), None))
        }
        _ => None,
    }
}

fn hint(
    text: &str,
    description: &Description,
    section: &Section,
    pair: &Pair,
    profile: Option<u16>,
) -> Option<(String, Option<String>)> {
    if let Some(mapped) = mapped(text, section, pair) {
        let name = words::mapped_name(description, mapped);
        return Some((words::mapping(mapped), name));
    }
    if let Some(index) = listed(text, section, pair) {
        let own = words::name(description, Address::new(index, 0)).map(str::to_owned);
        let known = || standard::name(index, profile).map(|(name, _)| name.to_owned());
        return Some((own.or_else(known)?, None));
    }
    let key = text.get(pair.key.clone())?;
    let at = match section.place {
        Place::Object(index) => Address::new(index, 0),
        Place::Member(index, sub) => Address::new(index, sub),
        _ => return None,
    };
    if key.eq_ignore_ascii_case("DataType") {
        let code = u16::try_from(number(text, pair)?).ok()?;
        return Some((DataType::from_code(code)?.name().into(), None));
    }
    if key.eq_ignore_ascii_case("ObjectType") {
        let code = u8::try_from(number(text, pair)?).ok()?;
        return Some((ObjectCode::from_code(code)?.name().into(), None));
    }
    if is_value_key(key) && cob_ids::is_one(at) {
        let entry = description.entry(at)?;
        let values = [&entry.default, &entry.parameter].into_iter().flatten();
        let mut own = values.filter(|value| value.span.start as usize == pair.value.start);
        return Some((CobId::of(&own.next()?.value)?.words(at), None));
    }
    None
}
