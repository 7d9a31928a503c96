//! An overlay: an EDS with only the differences of a variant.
//!
//! ```text
//! [6001]                     ; existing: these keys replace those of the base
//! DefaultValue=0x1000
//! [2300]                     ; removed
//! Remove=1
//! [5000]                     ; new: a whole section, as in any EDS
//! ParameterName=Mine
//! DataType=0x0007
//! AccessType=rw
//! ```
//! Both become one text, so every rule of the reader and of the checks applies to it, and
//! every finding has its place in the original file.

use alloc::collections::{BTreeMap, BTreeSet};
use alloc::format;
use alloc::string::{String, ToString};
use alloc::vec;
use alloc::vec::Vec;

use crate::document::is_xml;
use crate::finding::{Finding, Place};
use crate::scan::lines::{is_conflict, lines, with_ends};
use crate::scan::names::{List, object_of};
use crate::scan::number::number;
use crate::span::{Span, Spanned};

/// Maximum number of characters of a value in a sentence.
const MAX_SHOWN: usize = 20;

/// The file that a line comes from.
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug)]
pub enum Origin {
    /// The EDS.
    Base,
    /// The overlay.
    Overlay,
}

/// Base and overlay as one text.
#[derive(Clone, PartialEq, Eq, Debug, Default)]
pub struct Overlaid {
    /// The text, for [`parse`](crate::parse()) or [`load`](crate::load).
    pub text: String,
    /// For each of its lines: the file, the line number there from 1, and the byte where the line begins.
    lines: Vec<(Origin, u32, u32)>,
    /// Byte where each line of `text` begins.
    starts: Vec<u32>,
    /// The objects that the overlay removes, with the headers in the overlay.
    removed: BTreeMap<u16, Span>,
}

impl Overlaid {
    /// Converts a place in the text into a file and the place there.
    pub fn locate(&self, span: Span) -> (Origin, Span) {
        let at = (span.line as usize).saturating_sub(1);
        let (Some((origin, line, byte)), Some(start)) = (self.lines.get(at), self.starts.get(at))
        else {
            return (Origin::Base, span);
        };
        let moved = |position: u32| byte + position.saturating_sub(*start);
        let span = Span {
            start: moved(span.start),
            end: moved(span.end),
            line: *line,
            column: span.column,
        };
        (*origin, span)
    }

    /// Converts a finding of the text into one of its file. Second places in the other
    /// file are left out, and so is a fix that would have to change both files. A finding about an object that is
    /// missing since the overlay removes it is at the header there.
    pub fn place(&self, mut finding: Finding) -> (Origin, Finding) {
        let Place::Text(span) = finding.place else {
            let removed = finding
                .object
                .and_then(|object| self.removed.get(&object.index));
            let Some(header) = removed else {
                return (Origin::Base, finding);
            };
            finding.place = Place::Text(*header);
            finding.fix = None;
            return (Origin::Overlay, finding);
        };
        let (origin, span) = self.locate(span);
        finding.place = Place::Text(span);
        finding.fix = finding.fix.and_then(|mut fix| {
            let is_own = fix.edits.iter_mut().all(|edit| {
                let (other, span) = self.locate(edit.span);
                edit.span = span;
                other == origin
            });
            is_own.then_some(fix)
        });
        finding.related.retain_mut(|related| {
            let (other, span) = self.locate(related.span);
            related.span = span;
            other == origin
        });
        (origin, finding)
    }
}

/// The path of the base in the comment `;odkit-base=my.eds` of an overlay, relative to the overlay.
pub fn base_of(overlay: &str) -> Option<Spanned<&str>> {
    lines(overlay).find_map(|line| {
        let body = line.text.trim_start().strip_prefix([';', '#'])?;
        let (key, path) = body.split_once('=')?;
        let path = path.trim();
        let is_base = key.trim().eq_ignore_ascii_case("odkit-base");
        is_base.then(|| Spanned::new(path, line.span(path)))
    })
}

/// Lays an overlay over a base.
///
/// A section has one place in an overlay, except that a removed one can be defined again below.
///
/// # Errors
/// Objects and sections that the overlay removes but the base lacks, another `Remove=` than 1, a section that is
/// in the overlay twice, a merge conflict, or a base that is XML: a sentence each, with the line of the overlay.
pub fn overlay(base: &str, overlay: &str) -> Result<Overlaid, Vec<(u32, String)>> {
    if is_xml(base) {
        let why = "the base is XML; write an EDS of it with `odkit convert`";
        return Err(vec![(1, why.to_string())]);
    }
    let is_mark = |(_, line): &(u32, &str)| is_conflict(line.trim());
    if let Some((number, mark)) = (1..).zip(with_ends(overlay)).find(is_mark) {
        let given: String = mark.trim().chars().take(MAX_SHOWN).collect();
        let why =
            "is a mark of a merge conflict that is not resolved; keep one of the two versions";
        return Err(vec![(number, format!("`{given}` {why}"))]);
    }
    let parts = read(base, Origin::Base);
    let before = objects(&parts);
    let mut sections = Sections::default();
    parts.into_iter().for_each(|part| sections.push(part));
    let mut faults = Vec::new();
    let mut removed = BTreeMap::new();
    let mut seen = Seen::default();
    let mut added = read(overlay, Origin::Overlay).into_iter();
    // The reader reports what is before the first section, as it does in any file.
    let outside = added.next().into_iter().flat_map(|part| part.lines);
    if let Some(Some(first)) = sections.parts.first_mut() {
        let is_text = |line: &Line<'_>| !line.text.trim().is_empty();
        first.lines.extend(outside.filter(is_text));
    }
    for section in added {
        let removes = match section.removes() {
            Ok(removes) => removes,
            Err(fault) => {
                faults.push(fault);
                continue;
            }
        };
        if let Some(first) = seen.before(&section, removes) {
            let fault = format!(
                "section [{}] is already in line {first}; move its lines there",
                section.name
            );
            faults.push((section.line(), fault));
            continue;
        }
        if removes {
            if let Some(index) = object_of(&section.name) {
                removed.insert(index, section.header());
            }
            if !sections.remove(&section.name) {
                let fault = format!("section [{}] to remove is missing", section.name);
                faults.push((section.line(), fault));
            }
            continue;
        }
        match sections.named(&section.name) {
            Some(other) => other.take_over(section),
            None => sections.push(section),
        }
    }
    if !faults.is_empty() {
        return Err(faults);
    }
    let mut sections: Vec<Part<'_>> = sections.parts.into_iter().flatten().collect();
    let after = objects(&sections);
    if before != after {
        list(&mut sections, &after);
    }
    Ok(Overlaid {
        removed,
        ..join(&sections)
    })
}

/// A line and its origin.
#[derive(Clone, Debug)]
struct Line<'t> {
    text: alloc::borrow::Cow<'t, str>,
    origin: Origin,
    number: u32,
    byte: u32,
}

impl Line<'_> {
    /// The key of `key=value`; comments have none.
    fn key(&self) -> Option<&str> {
        let (key, _) = self.text.split_once('=')?;
        let key = key.trim();
        (!key.starts_with([';', '#', '[']) && !key.is_empty()).then_some(key)
    }

    fn is_key(&self, key: &str) -> bool {
        self.key().is_some_and(|own| own.eq_ignore_ascii_case(key))
    }
}

/// A header and the lines below it; the first part of a text has no header.
#[derive(Clone, Debug, Default)]
struct Part<'t> {
    name: String,
    lines: Vec<Line<'t>>,
    /// The empty lines at the end; empty until an overlay changes the part.
    blanks: Vec<Line<'t>>,
    /// The first line of each key, by the key in lower case; empty until an overlay changes the part.
    keys: Option<BTreeMap<String, usize>>,
}

/// The sections of an overlay so far: line of the header, and whether it is removed there.
#[derive(Debug, Default)]
struct Seen(BTreeMap<String, (u32, bool)>);

impl Seen {
    /// The line of the same section above, unless it is removed there and defined again here.
    fn before(&mut self, section: &Part<'_>, removes: bool) -> Option<u32> {
        let name = section.name.to_ascii_lowercase();
        let above = self.0.insert(name, (section.line(), removes));
        let (line, removed) = above?;
        (!removed || removes).then_some(line)
    }
}

/// The parts of the base. An overlay may be as long as the base, so they are found by name and by object.
#[derive(Debug, Default)]
struct Sections<'t> {
    /// In the order of the text; `None`: removed.
    parts: Vec<Option<Part<'t>>>,
    /// By name, in lower case.
    names: BTreeMap<String, Vec<usize>>,
    /// An object with its members and lists.
    objects: BTreeMap<u16, Vec<usize>>,
}

impl<'t> Sections<'t> {
    fn push(&mut self, part: Part<'t>) {
        let at = self.parts.len();
        let name = part.name.to_ascii_lowercase();
        self.names.entry(name).or_default().push(at);
        if let Some(index) = object_of(&part.name) {
            self.objects.entry(index).or_default().push(at);
        }
        self.parts.push(Some(part));
    }

    /// The first part with a name; that without a header has none.
    fn named(&mut self, name: &str) -> Option<&mut Part<'t>> {
        let positions = self.names.get(&name.to_ascii_lowercase())?;
        let there = |at: &&usize| self.parts.get(**at).is_some_and(Option::is_some);
        let at = *positions.iter().find(there).filter(|_| !name.is_empty())?;
        self.parts.get_mut(at)?.as_mut()
    }

    /// Removes the parts with a name; an object with its members and lists. Returns whether there was one.
    fn remove(&mut self, name: &str) -> bool {
        if name.is_empty() {
            return false;
        }
        let whole = object_of(name).filter(|_| name.len() == 4);
        let members = whole.and_then(|index| self.objects.remove(&index));
        let same = self.names.remove(&name.to_ascii_lowercase());
        let mut was_there = false;
        for at in [members, same].into_iter().flatten().flatten() {
            was_there |= self.parts.get_mut(at).and_then(Option::take).is_some();
        }
        was_there
    }
}

impl<'t> Part<'t> {
    fn is(&self, name: &str) -> bool {
        !self.name.is_empty() && self.name.eq_ignore_ascii_case(name)
    }

    /// The place of the header.
    fn header(&self) -> Span {
        let first = self.lines.first();
        first.map_or(Span::default(), |line| Span {
            start: line.byte,
            end: line.byte + line.text.trim_end().len() as u32,
            line: line.number,
            column: 1,
        })
    }

    /// Line number of the header.
    fn line(&self) -> u32 {
        self.lines.first().map_or(0, |line| line.number)
    }

    /// Returns whether the overlay removes the section.
    ///
    /// # Errors
    /// `Remove=` with another value than 1: the line and a sentence.
    fn removes(&self) -> Result<bool, (u32, String)> {
        let mut removes = false;
        for line in self.lines.iter().filter(|line| line.is_key("Remove")) {
            let given = line.text.split_once('=').map_or("", |(_, given)| given);
            let given = given.split(';').next().unwrap_or("").trim();
            if number(given) != Some(1) {
                let given: String = given.chars().take(MAX_SHOWN).collect();
                let fault =
                    format!("`Remove={given}` is not valid; write `Remove=1`, or remove the line");
                return Err((line.number, fault));
            }
            removes = true;
        }
        Ok(removes)
    }

    /// Keys of the overlay replace the same keys of the base; others are added at the end, also a second line of a key,
    /// which the reader reports.
    fn take_over(&mut self, overlay: Part<'t>) {
        let is_blank = |line: &Line<'_>| line.text.trim().is_empty();
        let keys = self.keys.get_or_insert_with(|| {
            let end = self.lines.iter().rposition(|own| !is_blank(own));
            self.blanks = self.lines.split_off(end.map_or(0, |end| end + 1));
            let mut keys = BTreeMap::new();
            for (at, line) in self.lines.iter().enumerate() {
                if let Some(key) = line.key() {
                    keys.entry(key.to_ascii_lowercase()).or_insert(at);
                }
            }
            keys
        });
        for line in overlay.lines.into_iter().skip(1) {
            let key = line.key().map(str::to_ascii_lowercase);
            let same = key.as_ref().and_then(|key| keys.get(key));
            let own = same.and_then(|at| self.lines.get_mut(*at));
            if let Some(own) = own.filter(|own| own.origin == Origin::Base) {
                *own = line;
            } else if !is_blank(&line) {
                if let Some(key) = key {
                    keys.insert(key, self.lines.len());
                }
                self.lines.push(line);
            }
        }
    }
}

fn read(text: &str, origin: Origin) -> Vec<Part<'_>> {
    let mut parts = vec![Part::default()];
    let mut byte = 0;
    for (number, piece) in (1..).zip(with_ends(text)) {
        let line = Line {
            // The next line could begin with a character that completes `\r\n`.
            text: match piece.strip_suffix('\r') {
                Some(line) => format!("{line}\n").into(),
                None => piece.into(),
            },
            origin,
            number,
            byte,
        };
        byte += piece.len() as u32;
        let trimmed = piece.trim().trim_start_matches('\u{FEFF}');
        let name = trimmed
            .strip_prefix('[')
            .and_then(|rest| rest.split_once(']'));
        if let Some((name, _)) = name {
            parts.push(Part {
                name: name.trim().into(),
                ..Part::default()
            });
        }
        if let Some(part) = parts.last_mut() {
            part.lines.push(line);
        }
    }
    parts
}

/// The indices with a section of their own.
fn objects(parts: &[Part<'_>]) -> BTreeSet<u16> {
    let whole = parts.iter().filter(|part| part.name.len() == 4);
    whole.filter_map(|part| object_of(&part.name)).collect()
}

/// The three lists with added and removed objects; each line has the place of the list's header.
fn list(parts: &mut Vec<Part<'_>>, objects: &BTreeSet<u16>) {
    for list in List::ALL {
        let own: Vec<u16> = objects
            .iter()
            .copied()
            .filter(|index| List::of(*index) == list)
            .collect();
        let at = parts.iter().position(|part| part.is(list.name()));
        let header = match at.and_then(|at| parts.get(at)?.lines.first().cloned()) {
            Some(header) => header,
            None => Line {
                text: format!("[{}]\n", list.name()).into(),
                origin: Origin::Overlay,
                number: 1,
                byte: 0,
            },
        };
        let count = format!("SupportedObjects={}\n", own.len());
        let entries = (1..)
            .zip(&own)
            .map(|(number, index)| format!("{number}=0x{index:04X}\n"));
        let lines = core::iter::once(header.text.to_string())
            .chain(core::iter::once(count))
            .chain(entries);
        let lines: Vec<Line<'_>> = lines
            .map(|text| Line {
                text: text.into(),
                ..header
            })
            .collect();
        match at.and_then(|at| parts.get_mut(at)) {
            Some(part) => {
                part.lines = lines;
                part.blanks.clear();
            }
            None => parts.push(Part {
                name: list.name().into(),
                lines,
                ..Part::default()
            }),
        }
    }
}

fn join(parts: &[Part<'_>]) -> Overlaid {
    let mut made = Overlaid::default();
    let lines = parts.iter().flat_map(|part| [&part.lines, &part.blanks]);
    for line in lines.flatten() {
        // The last line of a file may have no end, but another line follows now.
        if !made.text.is_empty() && !made.text.ends_with('\n') {
            made.text.push('\n');
        }
        made.starts.push(made.text.len() as u32);
        made.lines.push((line.origin, line.number, line.byte));
        made.text.push_str(&line.text);
    }
    made
}

#[cfg(test)]
mod tests;
