//! Python's `configparser`: reads the lines of a text as it does.

use alloc::borrow::Cow;
use alloc::collections::{BTreeMap, BTreeSet};
use alloc::format;
use alloc::string::String;
use alloc::vec::Vec;

use crate::scan::lines::{Line, lines};
use crate::span::Span;
use crate::tools::python::{is_space, strip};

/// Options of the parser in a tool.
pub(crate) struct Dialect {
    /// Characters that begin a comment after a blank.
    pub(crate) inline: &'static [char],
    /// Whether the names of sections and keys are case-insensitive.
    pub(crate) folds: bool,
}

/// An error at which the parser stops.
#[derive(Clone, Copy, PartialEq, Debug)]
pub(crate) enum Fault<'a> {
    /// Text before the first section.
    NoSection(Span),
    /// A line that is not a section, `key=value` or a comment.
    NoPair(Span),
    /// A duplicate section.
    Section {
        name: &'a str,
        at: Span,
        first: Span,
    },
    /// A duplicate key in a section.
    Key {
        key: &'a str,
        line: Span,
        first: Span,
    },
}

/// One `key=value`.
#[derive(Debug)]
pub(crate) struct Pair<'a> {
    pub(crate) key: Cow<'a, str>,
    /// The value, with `\n` between lines that continue it.
    pub(crate) value: Cow<'a, str>,
    /// Place of the value.
    pub(crate) span: Span,
    /// Place of the key.
    pub(crate) at: Span,
}

/// One section, with the keys of all sections of this name.
#[derive(Debug, Default)]
pub(crate) struct Section<'a> {
    pub(crate) name: Cow<'a, str>,
    pub(crate) header: Span,
    pub(crate) pairs: Vec<Pair<'a>>,
    keys: BTreeMap<Cow<'a, str>, usize>,
}

/// The parsed text.
#[derive(Debug, Default)]
pub(crate) struct Ini<'a> {
    pub(crate) sections: Vec<Section<'a>>,
    pub(crate) faults: Vec<Fault<'a>>,
    names: BTreeMap<Cow<'a, str>, usize>,
    /// `[DEFAULT]`, whose keys belong to every section.
    default: Option<usize>,
    folds: bool,
}

fn folded(name: Cow<'_, str>, folds: bool) -> Cow<'_, str> {
    if folds {
        Cow::Owned(name.to_lowercase())
    } else {
        name
    }
}

impl<'a> Ini<'a> {
    pub(crate) fn read(text: &'a str, dialect: &Dialect) -> Self {
        let mut reader = Reader {
            ini: Self {
                folds: dialect.folds,
                ..Self::default()
            },
            inline: dialect.inline,
            section: None,
            option: None,
            blank: 0,
            indent: 0,
            headers: BTreeMap::new(),
            keys: BTreeSet::new(),
            orphaned: false,
            current: "",
        };
        for line in lines(text) {
            reader.line(&line);
        }
        reader.ini
    }

    pub(crate) fn section(&self, name: &str) -> Option<&Section<'a>> {
        let name = folded(Cow::Borrowed(name), self.folds);
        let at = self.names.get(name.as_ref()).copied();
        at.filter(|at| Some(*at) != self.default)
            .map(|at| &self.sections[at])
    }

    /// The sections that are not `[DEFAULT]`, in file order.
    pub(crate) fn all(&self) -> impl Iterator<Item = &Section<'a>> {
        let sections = self.sections.iter().enumerate();
        let own = sections.filter(|(at, _)| Some(*at) != self.default);
        own.map(|(_, section)| section)
    }

    /// A key of a section, or of `[DEFAULT]`.
    pub(crate) fn get<'s>(&'s self, section: &'s Section<'a>, key: &str) -> Option<&'s Pair<'a>> {
        let key = folded(Cow::Borrowed(key), self.folds);
        let find = |section: &'s Section<'a>| {
            let at = section.keys.get(key.as_ref())?;
            section.pairs.get(*at)
        };
        find(section).or_else(|| find(&self.sections[self.default?]))
    }

    /// Adds a section that the file lacks.
    pub(crate) fn add(&mut self, name: String, header: Span, pairs: &[(&str, String)]) {
        let mut section = Section {
            name: Cow::Owned(name.clone()),
            header,
            ..Section::default()
        };
        for (key, value) in pairs {
            let key = Cow::Owned(String::from(*key));
            section.set(key, Cow::Owned(value.clone()), header, header, self.folds);
        }
        let key = folded(Cow::Owned(name), self.folds);
        self.names.insert(key, self.sections.len());
        self.sections.push(section);
    }

    pub(crate) fn set(&mut self, section: &str, key: String, value: String) {
        let name = folded(Cow::Borrowed(section), self.folds);
        if let Some(at) = self.names.get(name.as_ref()) {
            let section = &mut self.sections[*at];
            let span = section.header;
            section.set(Cow::Owned(key), Cow::Owned(value), span, span, self.folds);
        }
    }
}

impl<'a> Section<'a> {
    fn set(&mut self, key: Cow<'a, str>, value: Cow<'a, str>, span: Span, at: Span, folds: bool) {
        let pair = Pair {
            key: key.clone(),
            value,
            span,
            at,
        };
        match self.keys.entry(folded(key, folds)) {
            alloc::collections::btree_map::Entry::Occupied(known) => {
                self.pairs[*known.get()] = pair;
            }
            alloc::collections::btree_map::Entry::Vacant(free) => {
                free.insert(self.pairs.len());
                self.pairs.push(pair);
            }
        }
    }
}

struct Reader<'a> {
    ini: Ini<'a>,
    inline: &'static [char],
    section: Option<usize>,
    /// The pair that an indented line continues.
    option: Option<usize>,
    /// Number of empty lines after it.
    blank: usize,
    indent: usize,
    /// Headers as written, which must be unique.
    headers: BTreeMap<&'a str, Span>,
    /// Keys as written, by the header as written.
    keys: BTreeSet<(&'a str, &'a str)>,
    orphaned: bool,
    /// The header as written.
    current: &'a str,
}

impl<'a> Reader<'a> {
    fn line(&mut self, line: &Line<'a>) {
        let comment = self.comment(line.text);
        let value = strip(&line.text[..comment.unwrap_or(line.text.len())]);
        if value.is_empty() {
            self.blank += usize::from(comment.is_none());
            return;
        }
        let indent = line.text.chars().take_while(|c| is_space(*c)).count();
        if let (Some(section), Some(option)) = (self.section, self.option)
            && indent > self.indent
        {
            let pair = &mut self.ini.sections[section].pairs[option];
            let breaks = "\n".repeat(self.blank + 1);
            pair.value = Cow::Owned(format!("{}{breaks}{value}", pair.value));
            self.blank = 0;
            return;
        }
        self.indent = indent;
        let end = value.rfind(']').filter(|end| *end > 1);
        match end.filter(|_| value.starts_with('[')) {
            Some(end) => self.header(&value[1..end], line.span(&value[..=end])),
            None if self.section.is_none() => {
                if !self.orphaned {
                    self.ini.faults.push(Fault::NoSection(line.span(value)));
                }
                self.orphaned = true;
            }
            None => self.pair(value, line),
        }
    }

    /// Returns the position at which a comment begins.
    fn comment(&self, text: &str) -> Option<usize> {
        if strip(text).starts_with(['#', ';']) {
            return Some(0);
        }
        let mut from: Vec<(char, usize)> = self.inline.iter().map(|sign| (*sign, 0)).collect();
        while !from.is_empty() {
            let mut found: Option<usize> = None;
            from.retain_mut(|(sign, next)| {
                let Some(at) = text[*next..].find(*sign).map(|at| at + *next) else {
                    return false;
                };
                *next = at + 1;
                let before = text[..at].chars().next_back();
                if before.is_none_or(is_space) {
                    found = Some(found.map_or(at, |found| found.min(at)));
                }
                true
            });
            if found.is_some() {
                return found;
            }
        }
        None
    }

    fn header(&mut self, name: &'a str, span: Span) {
        self.option = None;
        self.blank = 0;
        let key = folded(Cow::Borrowed(name), self.ini.folds);
        if name == "DEFAULT" && self.ini.default.is_none() {
            self.ini.default = Some(self.ini.sections.len());
        } else if let Some(first) = self.headers.get(name).filter(|_| name != "DEFAULT") {
            let (at, first) = (span, *first);
            self.ini.faults.push(Fault::Section { name, at, first });
        }
        self.headers.entry(name).or_insert(span);
        let next = self.ini.sections.len();
        let at = *self.ini.names.entry(key).or_insert(next);
        if at == next {
            self.ini.sections.push(Section {
                name: Cow::Borrowed(name),
                header: span,
                ..Section::default()
            });
        }
        self.section = Some(at);
        self.current = name;
    }

    fn pair(&mut self, value: &'a str, line: &Line<'a>) {
        let Some(section) = self.section else { return };
        let at = value.find(['=', ':']);
        let Some((key, rest)) = at.map(|at| (&value[..at], &value[at + 1..])) else {
            self.ini.faults.push(Fault::NoPair(line.span(value)));
            return;
        };
        let (key, rest) = (strip(key), strip(rest));
        self.blank = 0;
        if key.is_empty() {
            self.ini.faults.push(Fault::NoPair(line.span(value)));
            self.option = None;
            return;
        }
        if !self.keys.insert((self.current, key)) {
            let own = &self.ini.sections[section];
            let first = own.pairs.iter().find(|pair| pair.key == key);
            let first = first.map_or(line.span(key), |pair| pair.at);
            let line = line.span(strip(line.text));
            self.ini.faults.push(Fault::Key { key, line, first });
            // odkit uses the first one.
            return;
        }
        let (span, at) = (line.span(rest), line.span(key));
        let folds = self.ini.folds;
        let own = &mut self.ini.sections[section];
        own.set(Cow::Borrowed(key), Cow::Borrowed(rest), span, at, folds);
        let place = own.keys.get(folded(Cow::Borrowed(key), folds).as_ref());
        self.option = place.copied();
    }
}
