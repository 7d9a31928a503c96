//! The text of an EDS as sections, keys and values with their byte ranges.

use std::ops::Range;

use od_eds::Span;
use od_eds::outline::{self, Place, TextSection};

/// The byte range of a span.
pub(crate) const fn bytes(span: Span) -> Range<usize> {
    span.start as usize..span.end as usize
}

#[derive(Clone, Debug)]
pub(crate) struct Section {
    /// Its subject.
    pub(crate) place: Place,
    /// The text between the brackets.
    pub(crate) name: Range<usize>,
    /// The brackets with the text between them.
    pub(crate) header: Range<usize>,
    pub(crate) pairs: Vec<Pair>,
}

/// A key and its value.
#[derive(Clone, Debug)]
pub(crate) struct Pair {
    pub(crate) key: Range<usize>,
    pub(crate) value: Range<usize>,
}

impl Section {
    /// The position after its last key.
    pub(crate) fn end(&self) -> usize {
        let last = self.pairs.last();
        last.map_or(self.header.end, |pair| pair.value.end.max(pair.key.end))
    }

    /// Index of its object.
    pub(crate) const fn index(&self) -> Option<u16> {
        match self.place {
            Place::Object(index) | Place::Member(index, _) | Place::Compact(index, _) => {
                Some(index)
            }
            Place::List(_) | Place::Other => None,
        }
    }

    /// The first pair with this key, in upper or lower case.
    pub(crate) fn get<'s>(&'s self, text: &str, key: &str) -> Option<&'s Pair> {
        let is = |pair: &&Pair| {
            let own = text.get(pair.key.clone());
            own.is_some_and(|own| own.eq_ignore_ascii_case(key))
        };
        self.pairs.iter().find(is)
    }
}

/// The part of a section at a position.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Spot<'a> {
    /// The header.
    Header(&'a Section),
    /// A key.
    Key(&'a Section, &'a Pair),
    /// A value.
    Value(&'a Section, &'a Pair),
}

impl<'a> Spot<'a> {
    pub(crate) const fn section(self) -> &'a Section {
        match self {
            Self::Header(section) | Self::Key(section, _) | Self::Value(section, _) => section,
        }
    }
}

/// The sections of a text, in file order.
#[derive(Clone, Debug, Default)]
pub(crate) struct Layout {
    pub(crate) sections: Vec<Section>,
}

impl Layout {
    pub(crate) fn of(text: &str) -> Self {
        Self::new(&outline::sections(text))
    }

    pub(crate) fn new(sections: &[TextSection<'_>]) -> Self {
        let sections = sections.iter().map(|placed| Section {
            place: outline::place(&placed.name),
            name: bytes(placed.name.span),
            header: bytes(placed.header),
            pairs: placed
                .pairs
                .iter()
                .map(|(key, value)| Pair {
                    key: bytes(key.span),
                    value: bytes(value.span),
                })
                .collect(),
        });
        Self {
            sections: sections.collect(),
        }
    }

    /// The section that contains the line of a byte.
    pub(crate) fn section_at(&self, offset: usize) -> Option<&Section> {
        let behind = self
            .sections
            .partition_point(|section| section.header.start <= offset);
        self.sections.get(behind.checked_sub(1)?)
    }

    /// The header, key or value at a byte, including its end.
    pub(crate) fn spot(&self, offset: usize) -> Option<Spot<'_>> {
        let holds = |range: &Range<usize>| range.start <= offset && offset <= range.end;
        let section = self.section_at(offset)?;
        if holds(&section.header) {
            return Some(Spot::Header(section));
        }
        let behind = section
            .pairs
            .partition_point(|pair| pair.key.start <= offset);
        let pair = section.pairs.get(behind.checked_sub(1)?)?;
        if holds(&pair.key) {
            Some(Spot::Key(section, pair))
        } else if holds(&pair.value) {
            Some(Spot::Value(section, pair))
        } else {
            None
        }
    }

    /// The first section of an object, a sub-object, or another subject.
    pub(crate) fn section_of(&self, place: Place) -> Option<&Section> {
        self.sections.iter().find(|section| section.place == place)
    }

    /// All sections of an object: its own, those of its sub-objects, and its compact lists.
    pub(crate) fn sections_of(&self, index: u16) -> impl Iterator<Item = &Section> {
        let sections = self.sections.iter();
        sections.filter(move |section| section.index() == Some(index))
    }
}
