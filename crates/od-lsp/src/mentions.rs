//! The mentions of objects in a text: headers, list entries, mapping entries; elements of an XDD.

use std::ops::Range;

use od_eds::outline::{self, Compact, Place};
use od_model::Address;

use crate::file::{File, Seen};
use crate::layout::{Pair, Section};
use crate::xdd::{self, Element};

/// Kind of a mention.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(crate) enum What {
    /// `[2000]`, `[2000sub1]`, `[2000Value]`, `[2000ObjectLinks]`, `index="2000"`
    Header,
    /// `1=0x2000` of a list or of links.
    Entry,
    /// `DefaultValue=0x20000010` of a mapping.
    Mapping,
}

/// A mention of an object.
#[derive(Clone, PartialEq, Eq, Debug)]
pub(crate) struct Mention {
    pub(crate) what: What,
    pub(crate) object: Address,
    /// The whole name or number.
    pub(crate) bytes: Range<usize>,
    /// The index in it; `None` if the index has no digits of its own.
    pub(crate) index: Option<Range<usize>>,
}

/// An entry of a PDO mapping.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(crate) struct Mapped {
    pub(crate) object: Address,
    pub(crate) bits: u8,
}

impl Mapped {
    /// The entry with this number; 0 maps nothing.
    pub(crate) fn of(number: i128) -> Option<Self> {
        let [bits, sub, low, high] = u32::try_from(number).ok()?.to_le_bytes();
        let index = u16::from_le_bytes([low, high]);
        (index != 0).then_some(Self {
            object: Address::new(index, sub),
            bits,
        })
    }
}

/// Returns whether this object is the mapping of a PDO.
pub(crate) const fn is_mapping(index: u16) -> bool {
    matches!(index, 0x1600..=0x17FF | 0x1A00..=0x1BFF)
}

/// The range of a value without a comment after it.
pub(crate) fn plain(text: &str, pair: &Pair) -> Range<usize> {
    let value = text.get(pair.value.clone()).unwrap_or_default();
    pair.value.start..pair.value.start + outline::before_comment(value).len()
}

/// The number in a value.
pub(crate) fn number(text: &str, pair: &Pair) -> Option<i128> {
    outline::number(text.get(pair.value.clone())?)
}

/// Returns whether this key has a value with which a node starts.
pub(crate) fn is_value_key(key: &str) -> bool {
    key.eq_ignore_ascii_case("DefaultValue") || key.eq_ignore_ascii_case("ParameterValue")
}

/// The mapping entry in a key-value pair.
pub(crate) fn mapped(text: &str, section: &Section, pair: &Pair) -> Option<Mapped> {
    let key = text.get(pair.key.clone())?;
    let holds = match section.place {
        Place::Member(index, 1..) => is_mapping(index) && is_value_key(key),
        Place::Compact(index, Compact::Value) => {
            is_mapping(index) && outline::number(key).is_some()
        }
        _ => false,
    };
    holds.then(|| Mapped::of(number(text, pair)?)).flatten()
}

/// The object in an entry of a list or of links.
pub(crate) fn listed(text: &str, section: &Section, pair: &Pair) -> Option<u16> {
    let names = matches!(section.place, Place::List(_)) || links(text, section).is_some();
    if !names || outline::number(text.get(pair.key.clone())?).is_none() {
        return None;
    }
    u16::try_from(number(text, pair)?).ok()
}

/// The object of `[2000ObjectLinks]`.
fn links(text: &str, section: &Section) -> Option<u16> {
    let (index, rest) = text.get(section.name.clone())?.split_at_checked(4)?;
    let Place::Object(index) = outline::place(index) else {
        return None;
    };
    rest.eq_ignore_ascii_case("ObjectLinks").then_some(index)
}

/// The digits of an index: at the end of a number `0x2000`, or before sub-index and length in `0x20000010`.
fn digits(text: &str, bytes: &Range<usize>, before: usize) -> Option<Range<usize>> {
    let number = text.get(bytes.clone())?;
    let hex = number
        .strip_prefix("0x")
        .or_else(|| number.strip_prefix("0X"))?;
    let is_plain = hex.len() == 4 + before && hex.bytes().all(|b| b.is_ascii_hexdigit());
    is_plain.then(|| bytes.start + 2..bytes.start + 6)
}

pub(crate) fn header(text: &str, section: &Section) -> Option<Mention> {
    let index = section.index().or_else(|| links(text, section))?;
    let sub = match section.place {
        Place::Member(_, sub) => sub,
        _ => 0,
    };
    Some(Mention {
        what: What::Header,
        object: Address::new(index, sub),
        bytes: section.name.clone(),
        index: Some(section.name.start..section.name.start + 4),
    })
}

pub(crate) fn value(text: &str, section: &Section, pair: &Pair) -> Option<Mention> {
    let bytes = plain(text, pair);
    if let Some(index) = listed(text, section, pair) {
        return Some(Mention {
            what: What::Entry,
            object: Address::new(index, 0),
            index: digits(text, &bytes, 0),
            bytes,
        });
    }
    let mapped = mapped(text, section, pair)?;
    Some(Mention {
        what: What::Mapping,
        object: mapped.object,
        index: digits(text, &bytes, 4),
        bytes,
    })
}

/// The mentions in an element of an XDD: its index, and the values of a mapping.
pub(crate) fn of_element<'a>(
    text: &'a str,
    element: &'a Element,
) -> impl Iterator<Item = Mention> + 'a {
    let header = match element.place {
        Place::Object(index) => xdd::attribute(text, &element.tag, "index").map(|bytes| Mention {
            what: What::Header,
            object: Address::new(index, 0),
            index: Some(bytes.clone()),
            bytes,
        }),
        _ => None,
    };
    let is_entry = matches!(element.place, Place::Member(index, 1..) if is_mapping(index));
    let fields = element.fields.iter().filter(move |_| is_entry);
    let entries = fields.filter(|field| is_value_key(&field.key));
    let entries = entries.filter_map(move |field| {
        let number = outline::number(text.get(field.value.clone())?)?;
        Some(Mention {
            what: What::Mapping,
            object: Mapped::of(number)?.object,
            index: digits(text, &field.value, 4),
            bytes: field.value.clone(),
        })
    });
    header.into_iter().chain(entries)
}

/// All mentions, in file order.
pub(crate) fn all<'a>(file: &'a File, seen: &'a Seen) -> impl Iterator<Item = Mention> + 'a {
    let text = file.str();
    let sections = seen.layout.sections.iter().flat_map(move |section| {
        let values = section.pairs.iter();
        let values = values.filter_map(move |pair| value(text, section, pair));
        header(text, section).into_iter().chain(values)
    });
    let elements = seen.elements.iter();
    sections.chain(elements.flat_map(move |element| of_element(text, element)))
}
