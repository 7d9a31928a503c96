//! Inlay hints: the meaning of a number, shown after it.

use std::ops::Range;

use od_eds::Description;
use od_eds::outline::Place;
use od_model::{Address, DataType, ObjectCode};

use crate::cob_ids::{self, CobId};
use crate::file::File;
use crate::layout::{Layout, Pair, Section};
use crate::mentions::{is_value_key, listed, mapped, number, plain};
use crate::standard;
use crate::types::InlayHint;
use crate::words;

/// The hints of the values between two bytes.
pub(crate) fn of(
    file: &File,
    layout: &Layout,
    description: &Description,
    within: &Range<usize>,
) -> Vec<InlayHint> {
    let profile = standard::profile(description);
    let from = layout
        .sections
        .partition_point(|section| section.end() < within.start);
    let sections = layout.sections.iter().skip(from);
    let sections = sections.take_while(|section| section.header.start <= within.end);
    let pairs = sections.flat_map(|section| section.pairs.iter().map(move |pair| (section, pair)));
    let inside = |pair: &Pair| within.start <= pair.value.end && pair.value.start <= within.end;
    pairs
        .filter(|(_, pair)| inside(pair))
        .filter_map(|(section, pair)| {
            let (label, tooltip) = hint(file.str(), description, section, pair, profile)?;
            Some(InlayHint {
                position: file.text.position(plain(file.str(), pair).end),
                label,
                kind: None,
                padding_left: true,
                tooltip,
            })
        })
        .collect()
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
