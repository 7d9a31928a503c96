//! The XML of a file: elements, attributes and texts with their places.

use alloc::borrow::Cow;
use alloc::collections::BTreeMap;
use alloc::string::String;
use alloc::vec::Vec;

use roxmltree::{Attribute, Node};

use crate::log::Log;
use crate::scan::section::TextSection;
use crate::span::{Span, Spanned};

/// Shared by the parts of this module: places and findings.
pub(super) struct Reader<'a> {
    places: Places<'a>,
    pub(super) log: Log,
}

/// The number of characters is known for every place that is a multiple of this number of bytes. A column is counted from the
/// last such place.
const STEP: usize = 64;

/// Lines and columns of bytes.
pub(super) struct Places<'a> {
    text: &'a str,
    /// Start of each line.
    lines: Vec<usize>,
    /// Number of characters before every [`STEP`] bytes, since a file can be one line.
    chars: Vec<usize>,
}

impl<'a> Places<'a> {
    pub(super) fn new(text: &'a str) -> Self {
        let ends = text.bytes().enumerate().filter(|(_, b)| *b == b'\n');
        let lines = core::iter::once(0).chain(ends.map(|(at, _)| at + 1));
        let mut sum = 0;
        let chars = text.as_bytes().chunks(STEP).map(|bytes| {
            let before = sum;
            sum += count(bytes);
            before
        });
        Self {
            text,
            lines: lines.collect(),
            chars: chars.collect(),
        }
    }

    /// The empty range at a line and a column, both counted from 1.
    pub(super) fn at(&self, line: u32, column: u32) -> Span {
        let start = self.lines.get(line as usize - 1).copied().unwrap_or(0);
        let within = self.text[start..]
            .char_indices()
            .nth(column.saturating_sub(1) as usize)
            .map_or(self.text.len() - start, |(at, _)| at);
        let at = (start + within) as u32;
        Span {
            start: at,
            end: at,
            line,
            column,
        }
    }

    fn span(&self, range: core::ops::Range<usize>) -> Span {
        let line = self.lines.partition_point(|start| *start <= range.start);
        let start = self.lines[line - 1];
        Span {
            start: range.start as u32,
            end: range.end as u32,
            line: line as u32,
            column: (self.before(range.start) - self.before(start)) as u32 + 1,
        }
    }

    /// Number of characters before a byte.
    fn before(&self, at: usize) -> usize {
        let step = (at / STEP).min(self.chars.len().saturating_sub(1));
        let known = self.chars.get(step).copied().unwrap_or(0);
        known + count(&self.text.as_bytes()[step * STEP..at])
    }
}

/// Number of characters that begin in these bytes of UTF-8.
fn count(bytes: &[u8]) -> usize {
    let starts = bytes.iter().filter(|byte| **byte & 0xC0 != 0x80);
    starts.count()
}

impl<'a> Reader<'a> {
    /// A reader without findings.
    pub(super) fn new(text: &'a str) -> Self {
        Self {
            places: Places::new(text),
            log: Log::default(),
        }
    }

    /// The start tag of an element.
    pub(super) fn tag(&self, node: Node<'_, '_>) -> Span {
        let range = node.range();
        let text = &self.places.text[range.clone()];
        let end = text.find('>').map_or(text.len(), |at| at + 1);
        self.places.span(range.start..range.start + end)
    }

    /// The name in the start tag of an element.
    pub(super) fn tag_name(&self, node: Node<'_, '_>) -> Span {
        let start = node.range().start + 1;
        let ends = |c: char| c.is_whitespace() || matches!(c, '/' | '>');
        let rest = &self.places.text[start..];
        let end = start + rest.find(ends).unwrap_or(rest.len());
        self.places.span(start..end)
    }

    /// An attribute by its local name, without blanks at its ends; `None` if missing.
    pub(super) fn attribute(&self, node: Node<'_, '_>, name: &str) -> Option<Spanned<String>> {
        let found = node
            .attributes()
            .find(|a| a.name().eq_ignore_ascii_case(name))?;
        let span = self.places.span(found.range_value());
        Some(Spanned::new(one_line(found.value()), span))
    }

    /// The place of the name of an attribute.
    pub(super) fn name(&self, attribute: &Attribute<'_, '_>) -> Span {
        self.places.span(attribute.range_qname())
    }

    /// The text of an element, without blanks at its ends.
    pub(super) fn text(&self, node: Node<'_, '_>) -> Option<Spanned<String>> {
        let text = node.children().find(Node::is_text)?;
        let span = self.places.span(text.range());
        Some(Spanned::new(one_line(text.text()?), span))
    }
}

/// A text in one line, as in an EDS.
fn one_line(text: &str) -> String {
    let mut words = String::with_capacity(text.len());
    for (at, line) in text.trim().split(['\r', '\n']).enumerate() {
        if at > 0 && !words.ends_with(' ') {
            words.push(' ');
        }
        words.push_str(line.trim());
    }
    words
}

/// The child elements of this local name.
pub(super) fn children<'a, 'i>(
    node: Node<'a, 'i>,
    name: &'static str,
) -> impl Iterator<Item = Node<'a, 'i>> {
    node.children()
        .filter(move |child| child.is_element() && child.tag_name().name() == name)
}

/// All elements below of this local name.
pub(super) fn below<'a, 'i>(
    node: Node<'a, 'i>,
    name: &'static str,
) -> impl Iterator<Item = Node<'a, 'i>> {
    node.descendants()
        .filter(move |child| child.is_element() && child.tag_name().name() == name)
}

/// Elements by their uniqueID, to which others refer.
pub(super) struct Ids<'a, 'i>(BTreeMap<&'a str, Node<'a, 'i>>);

impl<'a, 'i> Ids<'a, 'i> {
    pub(super) fn new(root: Node<'a, 'i>) -> Self {
        let all = root.descendants().filter(Node::is_element);
        let named = all.filter_map(|node| Some((node.attribute("uniqueID")?, node)));
        let mut ids = BTreeMap::new();
        for (id, node) in named {
            ids.entry(id).or_insert(node);
        }
        Self(ids)
    }

    pub(super) fn get(&self, id: &str) -> Option<Node<'a, 'i>> {
        self.0.get(id).copied()
    }
}

/// A section that is being built.
pub(super) struct Made {
    pub(super) placed: TextSection<'static>,
}

impl Made {
    /// A section without keys.
    pub(super) fn new(name: impl Into<String>, header: Span) -> Self {
        Self {
            placed: TextSection::new(Spanned::new(Cow::Owned(name.into()), header), header),
        }
    }

    /// Adds a key if it has a value and does not exist yet.
    pub(super) fn put(&mut self, key: &str, value: Option<Spanned<String>>) {
        if let Some(value) = value
            && self.placed.get(key).is_none()
        {
            let key = Spanned::new(Cow::Owned(key.into()), value.span);
            let value = Spanned::new(Cow::Owned(value.value), value.span);
            self.placed.pairs.push((key, value));
        }
    }
}
