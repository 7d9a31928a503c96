//! The sections of a text with their places, as the rest of the reader takes them.
//!
//! The scanner finds the places, and takes the dialects of EDS files apart line by line. What
//! is plain INI, the sections that describe no object, rust-ini reads: keys and values are its.
//! For the objects, which are nearly all of a file, the scanner's reading stands alone; to
//! read them twice took more than half of the time. A test holds the two against each other
//! for sections of every kind.

use alloc::borrow::Cow;
use alloc::string::String;
use alloc::vec::Vec;

use ::ini::{Ini, ParseOption};

use crate::description::Section;
use crate::finding::Finding;
use crate::scan::lines;
use crate::scan::names::object_of;
use crate::span::{Span, Spanned};

/// A piece of the text; owned where it had to be made, as for an XDD.
pub(crate) type Text<'a> = Spanned<Cow<'a, str>>;

/// A section with its places and its `;StorageLocation=` comment.
#[derive(Clone, PartialEq, Debug)]
pub(crate) struct Placed<'a> {
    pub(crate) name: Text<'a>,
    pub(crate) pairs: Vec<(Text<'a>, Text<'a>)>,
    pub(crate) header: Span,
    pub(crate) storage: Option<Text<'a>>,
}

impl Placed<'_> {
    /// The first value under `key`, in any case.
    pub(crate) fn get(&self, key: &str) -> Option<&Text<'_>> {
        self.pairs
            .iter()
            .find(|(k, _)| k.eq_ignore_ascii_case(key))
            .map(|(_, v)| v)
    }

    /// The section as a description keeps it.
    pub(crate) fn into_section(self) -> Section {
        let pairs = self.pairs.into_iter();
        Section {
            name: owned(self.name),
            pairs: pairs
                .map(|(key, value)| (owned(key), owned(value)))
                .collect(),
        }
    }
}

/// A text that outlives the file.
pub(crate) fn owned(text: Text<'_>) -> Spanned<alloc::string::String> {
    Spanned::new(text.value.into_owned(), text.span)
}

/// The sections of a text in file order, duplicates and all.
pub(crate) fn read<'a>(text: &'a str, diagnostics: &mut Vec<Finding>) -> Vec<Placed<'a>> {
    let scan = lines::scan(text);
    diagnostics.extend(scan.diagnostics);
    let borrowed = |piece: Spanned<&'a str>| Spanned::new(Cow::Borrowed(piece.value), piece.span);
    let sections = scan.sections.into_iter().map(|raw| Placed {
        name: borrowed(raw.name),
        pairs: raw
            .pairs
            .into_iter()
            .map(|pair| (borrowed(pair.key), borrowed(pair.value)))
            .collect(),
        header: raw.header,
        storage: raw.storage.map(borrowed),
    });
    let mut sections: Vec<Placed<'a>> = sections.collect();
    let mut plain: Vec<&mut Placed<'a>> = sections
        .iter_mut()
        .filter(|section| object_of(&section.name).is_none())
        .collect();
    if let Some(read) = by_rust_ini(&clean(&plain)).filter(|read| read.len() == plain.len()) {
        for (section, (_, pairs)) in plain.iter_mut().zip(read) {
            // Not known to differ (a test looks for it); the scanner's reading stands then.
            if section.pairs.len() == pairs.len() {
                for (place, (key, value)) in section.pairs.iter_mut().zip(pairs) {
                    place.0.value = Cow::Owned(key);
                    place.1.value = Cow::Owned(value);
                }
            }
        }
    }
    sections
}

/// A section's name, and its keys with their values.
type Plain = (String, Vec<(String, String)>);

/// What rust-ini reads of a text without the lines that it stops at. A value is what stands
/// there: quotes and backslashes mean nothing in an EDS.
fn by_rust_ini(text: &str) -> Option<Vec<Plain>> {
    let option = ParseOption {
        enabled_quote: false,
        enabled_escape: false,
        ..ParseOption::default()
    };
    let ini = Ini::load_from_str_opt(text, option).ok()?;
    let sections = ini.into_iter().filter_map(|(name, pairs)| {
        let pairs: Vec<_> = pairs.into_iter().collect();
        match name {
            Some(name) => Some((name, pairs)),
            None if pairs.is_empty() => None,
            None => Some((String::new(), pairs)),
        }
    });
    Some(sections.collect())
}

/// The sections as a plain text that rust-ini reads: it takes a backslash together
/// with what follows, so the last one is followed by a blank.
fn clean<'s, 'a: 's>(sections: &[impl core::borrow::Borrow<Placed<'a>> + 's]) -> String {
    let mut clean = String::new();
    let mut push = |text: &str, end: &str| {
        clean.push_str(text);
        if text.ends_with('\\') {
            clean.push(' ');
        }
        clean.push_str(end);
    };
    for section in sections {
        let section = section.borrow();
        if !(section.name.is_empty() && section.header.start == section.header.end) {
            push("[", "");
            push(&section.name, "]\n");
        }
        for (key, value) in &section.pairs {
            push(key, "=");
            push(value, "\n");
        }
    }
    clean
}

#[cfg(test)]
mod tests {
    use alloc::string::ToString;

    use super::*;

    #[test]
    fn rust_ini_reads_the_same() {
        let pieces = [
            "[a]",
            "[a",
            "[]",
            "[b\\]",
            "k=v",
            "k = v ",
            "k=",
            "=v",
            "k",
            "k:v",
            "k\\=v",
            "k=v\\",
            "k=\\\\",
            "k=\"v",
            "k='v' x",
            ";c",
            " ;c",
            " k=v",
            "\tk=v",
            "\t[c]",
            "[d] ;x",
            "k=;v",
            "k=[v]",
            "k=v=w",
            "",
            " ",
            "#c",
            "é=µ",
            "\u{85}k=v",
            "\\",
            "[a]]",
            "k==",
            "k\u{B}=\u{B}v",
            "\u{2028}",
            "k=\0",
            "\\\\=\\",
        ];
        for a in pieces {
            for b in pieces {
                for end in ["\n", "\r\n", "\r"] {
                    for text in [[a, b, "k=v"].join(end), ["[s]", a, b].join(end)] {
                        let sections = read(&text, &mut Vec::new());
                        let own: Vec<Plain> = sections
                            .iter()
                            .map(|section| {
                                let pairs = section.pairs.iter();
                                let pairs = pairs.map(|(k, v)| (k.to_string(), v.to_string()));
                                (section.name.to_string(), pairs.collect())
                            })
                            .collect();
                        assert_eq!(by_rust_ini(&clean(&sections)), Some(own), "{text:?}");
                    }
                }
            }
        }
    }
}
