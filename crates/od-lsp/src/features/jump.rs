//! Jumps from a place to its subject: objects, lists, mappings, COB-IDs.

use std::ops::Range;

use od_eds::outline::Place;
use od_model::Address;

use crate::cob_ids::{self, CobId};
use crate::file::{File, Kind, Seen};
use crate::host::NoHost;
use crate::layout::{Spot, bytes};
use crate::mentions::{self, Mention, What, number, plain};
use crate::{project, uri, xdd};

/// Subject of a place.
enum Target {
    /// An object, or one of its sub-objects (`true`).
    Object(Address, bool),
    /// A COB-ID, and the value that holds it.
    Cob(Address, CobId, Range<usize>),
}

fn target(file: &File, seen: &Seen, offset: usize) -> Option<Target> {
    let text = file.str();
    if !seen.elements.is_empty() {
        return in_element(text, seen, offset);
    }
    match seen.layout.spot(offset)? {
        Spot::Header(section) => {
            let header = mentions::header(text, section)?;
            let is_sub = matches!(section.place, Place::Member(..));
            Some(Target::Object(header.object, is_sub))
        }
        Spot::Key(section, pair) | Spot::Value(section, pair) => {
            if let Some(mention) = mentions::value(text, section, pair) {
                return Some(Target::Object(mention.object, is_sub(seen, &mention)));
            }
            let key = text.get(pair.key.clone())?;
            if key.eq_ignore_ascii_case("DataType") {
                let index = u16::try_from(number(text, pair)?).ok()?;
                return Some(Target::Object(Address::new(index, 0), false));
            }
            if file.kind == Kind::Overlay {
                // The description is that of base and overlay together: its places are not those of this file.
                return None;
            }
            let mut ids = cob_ids::all(&seen.description);
            let own = ids.find(|(_, _, bytes)| bytes.start == pair.value.start);
            own.map(|(at, id, bytes)| Target::Cob(at, id, bytes))
        }
    }
}

/// The subject of a place in an XDD: of a mapping entry, a COB-ID, or the element itself.
fn in_element(text: &str, seen: &Seen, offset: usize) -> Option<Target> {
    let (element, field) = xdd::at(&seen.elements, offset)?;
    let holds = |mention: &Mention| (mention.bytes.start..=mention.bytes.end).contains(&offset);
    if let Some(mention) = mentions::of_element(text, element).find(holds) {
        return Some(Target::Object(mention.object, is_sub(seen, &mention)));
    }
    let mut ids = cob_ids::all(&seen.description);
    let cob = field.and_then(|field| ids.find(|(_, _, bytes)| *bytes == field.value));
    match (cob, element.place) {
        (Some((at, id, bytes)), _) => Some(Target::Cob(at, id, bytes)),
        (None, Place::Object(index)) => Some(Target::Object(Address::new(index, 0), false)),
        (None, Place::Member(index, sub)) => Some(Target::Object(Address::new(index, sub), true)),
        (None, _) => None,
    }
}

/// Place where the file describes an object or a sub-object: a header, or a start tag.
fn described(seen: &Seen, place: Place) -> Option<Range<usize>> {
    let element = || seen.elements.iter().find(|element| element.place == place);
    let header = seen.layout.section_of(place);
    header
        .map(|section| section.header.clone())
        .or_else(|| element().map(|element| element.tag.clone()))
}

/// The object or the sub-object whose header or start tag is at a byte.
fn describes(seen: &Seen, offset: usize) -> Option<Place> {
    match seen.layout.spot(offset) {
        Some(Spot::Header(section)) => Some(section.place),
        Some(_) => None,
        None => xdd::at(&seen.elements, offset).map(|(element, _)| element.place),
    }
}

/// Returns whether a mention is about one sub-object: a mapping entry for an object that has sub-objects.
fn is_sub(seen: &Seen, mention: &Mention) -> bool {
    let object = seen.description.objects.get(&mention.object.index);
    mention.what == What::Mapping && object.is_some_and(|object| object.code.has_members())
}

/// Place of the object's description; for a COB-ID, the other values with it, or the mapping of its PDO; for a
/// uniqueIDRef, the parameter.
pub(crate) fn definition(file: &File, seen: &Seen, offset: usize) -> Vec<Range<usize>> {
    if let Some(tag) = xdd::parameter(file.str(), &seen.elements, offset) {
        return vec![tag];
    }
    match target(file, seen, offset) {
        None => Vec::new(),
        Some(Target::Object(at, is_sub)) => {
            let own = Place::Member(at.index, at.sub);
            // The header of a sub-object leads to its object.
            let from_own = describes(seen, offset) == Some(own);
            let header = described(seen, own).filter(|_| is_sub && !from_own);
            let header = header.or_else(|| described(seen, Place::Object(at.index)));
            header.into_iter().collect()
        }
        Some(Target::Cob(at, id, own)) => {
            let like = like(seen, id).filter(|bytes| *bytes != own);
            let mut found: Vec<_> = like.collect();
            if found.is_empty() {
                let mapping = cob_ids::mapping_of(at.index).map(Place::Object);
                found.extend(mapping.and_then(|place| described(seen, place)));
            }
            found
        }
    }
}

/// The path of the file that is named at a place: the base of an overlay, the EDS of a DCF, the DCF of a node.
pub(crate) fn named_file(file: &File, seen: &Seen, offset: usize) -> Option<String> {
    let text = file.str();
    let name = match (file.kind, seen.layout.spot(offset)) {
        (Kind::Project, _) => project::file(text, offset)?,
        (Kind::Overlay, None) => {
            let base = od_eds::base_of(text)?;
            let place = bytes(base.span);
            (place.start <= offset && offset <= place.end).then_some(base.value)?
        }
        (_, Some(Spot::Value(section, pair))) => {
            let key = file.part(pair.key.clone()).to_ascii_lowercase();
            let section = file.part(section.name.clone()).to_ascii_lowercase();
            let is_file = key == "lasteds" && section == "fileinfo"
                || key.ends_with("dcfname") && section.starts_with("topology");
            text.get(plain(text, pair)).filter(|_| is_file)?
        }
        _ => return None,
    };
    Some(uri::join(&file.path, &name.replace('\\', "/")))
}

/// Place of an object's description in the base of an overlay.
pub(crate) fn in_base<'f>(
    file: &'f File,
    seen: &Seen,
    offset: usize,
) -> Option<(&'f File, Range<usize>)> {
    let base = file.below()?;
    let Target::Object(at, is_sub) = target(file, seen, offset)? else {
        return None;
    };
    let layout = &base.seen(&NoHost).layout;
    let member = layout.section_of(Place::Member(at.index, at.sub));
    let whole = || layout.section_of(Place::Object(at.index));
    let section = member.filter(|_| is_sub).or_else(whole)?;
    Some((base, section.header.clone()))
}

/// The base of an overlay, and all places there of the object at a place in the overlay.
pub(crate) fn references_in_base<'f>(
    file: &'f File,
    seen: &Seen,
    offset: usize,
    declared: bool,
) -> Option<(&'f File, Vec<Range<usize>>)> {
    let base = file.below()?;
    let Target::Object(at, is_sub) = target(file, seen, offset)? else {
        return None;
    };
    let found = of_object(base, base.seen(&NoHost), at, is_sub, declared);
    Some((base, found))
}

/// All places of the same object or COB-ID; without its definitions unless `declared`.
pub(crate) fn references(
    file: &File,
    seen: &Seen,
    offset: usize,
    declared: bool,
) -> Vec<Range<usize>> {
    match target(file, seen, offset) {
        None => Vec::new(),
        Some(Target::Cob(_, id, _)) => like(seen, id).collect(),
        Some(Target::Object(at, is_sub)) => of_object(file, seen, at, is_sub, declared),
    }
}

/// All places of an object, or only of one of its sub-objects.
fn of_object(
    file: &File,
    seen: &Seen,
    at: Address,
    is_sub: bool,
    declared: bool,
) -> Vec<Range<usize>> {
    let about = |mention: &Mention| match (is_sub, mention.what) {
        (true, What::Header | What::Mapping) => mention.object == at,
        (true, What::Entry) => false,
        (false, _) => mention.object.index == at.index,
    };
    let mut found: Vec<_> = mentions::all(file, seen)
        .filter(|mention| declared || mention.what != What::Header)
        .filter(about)
        .map(|mention| mention.bytes)
        .collect();
    if !is_sub {
        found.extend(typed(file, seen, at.index));
        found.sort_by_key(|bytes| bytes.start);
    }
    found
}

/// The values of DataType that are the index of a type which the file defines (0040h to 025Fh).
fn typed<'a>(
    file: &'a File,
    seen: &'a Seen,
    index: u16,
) -> impl Iterator<Item = Range<usize>> + 'a {
    let text = file.str();
    let own = (0x40..=0x25F).contains(&index);
    let sections = seen.layout.sections.iter().filter(move |_| own);
    sections.filter_map(move |section| {
        let pair = section.get(text, "DataType")?;
        let bytes = mentions::plain(text, pair);
        (number(text, pair) == Some(i128::from(index))).then_some(bytes)
    })
}

/// The values with this COB-ID.
fn like(seen: &Seen, id: CobId) -> impl Iterator<Item = Range<usize>> + '_ {
    let all = cob_ids::all(&seen.description);
    all.filter(move |(_, other, _)| other.is_like(id))
        .map(|(_, _, bytes)| bytes)
}
