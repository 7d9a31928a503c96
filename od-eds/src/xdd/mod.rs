//! XDD and XDC text (CiA 311): what an EDS and a DCF say, in XML.
//!
//! The reader takes what belongs to an object from where CiA 311 keeps it: the
//! object's own attributes, or the parameter that it refers to, with the template
//! and the types that the parameter refers to. The result is what an EDS of the same
//! device gives, values and findings included; [`parse`](crate::parse) and
//! [`Document`](crate::Document) come here by themselves when a text is XML.
//!
//! Elements are known by their local names, so the namespaces of CiA 311 1.0 and 1.1
//! are the same, and so are project files (`.xpd`) that hold one device.

use alloc::borrow::Cow;
use alloc::collections::BTreeMap;
use alloc::format;
use alloc::string::String;
use alloc::vec::Vec;

use roxmltree::{Document, Node};

use crate::finding::{Finding, Place};
use crate::read::Parsed;
use crate::read::sorted::from_sections;
use crate::rules;
use crate::scan::placed::Placed;
use crate::span::{Span, Spanned};

mod info;
mod objects;
mod parameters;
mod types;
mod write;

pub use write::write;

/// Is this text XML, not an EDS?
pub fn is_xml(text: &str) -> bool {
    text.trim_start_matches('\u{FEFF}')
        .trim_start()
        .starts_with('<')
}

/// Reads an XDD or an XDC.
///
/// Never fails, never panics. A text that is no well-formed XML gives an empty
/// description and the place where it breaks.
pub fn parse(text: &str) -> Parsed {
    let xml = match Document::parse(text) {
        Ok(xml) => xml,
        Err(error) => {
            let place = error.pos();
            let span = Span {
                line: place.row,
                column: place.col,
                ..Span::default()
            };
            let finding = rules::E0113
                .told(span, format!("the XML breaks here: {error}"))
                .with_help("mend the XML; nothing is read of a file that is none");
            return Parsed {
                diagnostics: alloc::vec![located(finding, text)],
                ..Parsed::default()
            };
        }
    };
    let mut reader = Reader {
        places: Places::new(text),
        log: Vec::new(),
    };
    let root = xml.root();
    let mut sections = info::sections(root, &mut reader);
    sections.append(&mut objects::sections(root, &mut reader));
    let mut parsed = from_sections(sections, reader.log);
    // What mends an EDS would break an XML.
    for finding in &mut parsed.diagnostics {
        finding.fix = None;
    }
    parsed
}

/// A finding at a line and column, with its bytes.
fn located(mut finding: Finding, text: &str) -> Finding {
    if let Place::Text(span) = &mut finding.place {
        let places = Places::new(text);
        let line = places
            .lines
            .get(span.line as usize - 1)
            .copied()
            .unwrap_or(0);
        let within = text[line..]
            .char_indices()
            .nth(span.column.saturating_sub(1) as usize)
            .map_or(text.len() - line, |(at, _)| at);
        span.start = (line + within) as u32;
        span.end = span.start;
    }
    finding
}

/// What the parts of this module share: places and findings.
struct Reader<'a> {
    places: Places<'a>,
    log: Vec<Finding>,
}

/// Lines and columns of bytes.
struct Places<'a> {
    text: &'a str,
    /// Where each line begins.
    lines: Vec<usize>,
}

impl<'a> Places<'a> {
    fn new(text: &'a str) -> Self {
        let ends = text.bytes().enumerate().filter(|(_, b)| *b == b'\n');
        let lines = core::iter::once(0).chain(ends.map(|(at, _)| at + 1));
        Self {
            text,
            lines: lines.collect(),
        }
    }

    fn span(&self, range: core::ops::Range<usize>) -> Span {
        let line = self.lines.partition_point(|start| *start <= range.start);
        let start = self.lines[line - 1];
        Span {
            start: range.start as u32,
            end: range.end as u32,
            line: line as u32,
            column: self.text[start..range.start].chars().count() as u32 + 1,
        }
    }
}

impl Reader<'_> {
    /// The start tag of an element.
    fn tag(&self, node: Node<'_, '_>) -> Span {
        let range = node.range();
        let text = &self.places.text[range.clone()];
        let end = text.find('>').map_or(text.len(), |at| at + 1);
        self.places.span(range.start..range.start + end)
    }

    /// An attribute by its local name, with blanks cut off; `None` where it is missing.
    fn attribute(&self, node: Node<'_, '_>, name: &str) -> Option<Spanned<String>> {
        let found = node
            .attributes()
            .find(|a| a.name().eq_ignore_ascii_case(name))?;
        let span = self.places.span(found.range_value());
        Some(Spanned::new(one_line(found.value()), span))
    }

    /// The text of an element, with blanks cut off.
    fn text(&self, node: Node<'_, '_>) -> Option<Spanned<String>> {
        let text = node.children().find(Node::is_text)?;
        let span = self.places.span(text.range());
        Some(Spanned::new(one_line(text.text()?), span))
    }
}

/// A text as an EDS can hold it: in one line.
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
fn children<'a, 'i>(node: Node<'a, 'i>, name: &'static str) -> impl Iterator<Item = Node<'a, 'i>> {
    node.children()
        .filter(move |child| child.is_element() && child.tag_name().name() == name)
}

/// All elements below of this local name.
fn below<'a, 'i>(node: Node<'a, 'i>, name: &'static str) -> impl Iterator<Item = Node<'a, 'i>> {
    node.descendants()
        .filter(move |child| child.is_element() && child.tag_name().name() == name)
}

/// A section as an EDS has it, made of elements and attributes.
struct Made {
    placed: Placed<'static>,
}

impl Made {
    fn new(name: impl Into<String>, header: Span) -> Self {
        Self {
            placed: Placed {
                name: Spanned::new(Cow::Owned(name.into()), header),
                pairs: Vec::new(),
                header,
                storage: None,
            },
        }
    }

    /// Adds a key, if there is a value for it and the key is not there yet.
    fn put(&mut self, key: &str, value: Option<Spanned<String>>) {
        if let Some(value) = value
            && self.placed.get(key).is_none()
        {
            let key = Spanned::new(Cow::Owned(key.into()), value.span);
            let value = Spanned::new(Cow::Owned(value.value), value.span);
            self.placed.pairs.push((key, value));
        }
    }
}

/// Elements by the uniqueID that others refer to.
struct Ids<'a, 'i>(BTreeMap<&'a str, Node<'a, 'i>>);

impl<'a, 'i> Ids<'a, 'i> {
    fn new(root: Node<'a, 'i>) -> Self {
        let all = root.descendants().filter(Node::is_element);
        let named = all.filter_map(|node| Some((node.attribute("uniqueID")?, node)));
        let mut ids = BTreeMap::new();
        for (id, node) in named {
            ids.entry(id).or_insert(node);
        }
        Self(ids)
    }

    fn get(&self, id: &str) -> Option<Node<'a, 'i>> {
        self.0.get(id).copied()
    }
}

#[cfg(test)]
mod tests;
