//! rust-ini's reading of a text, with the scanner's places.

use alloc::string::{String, ToString};
use alloc::vec::Vec;

use ::ini::{Ini, ParseOption};

use super::lines::{self, RawSection};
use crate::{Diagnostic, Section, Span, Spanned};

/// A section with its places and its `;StorageLocation=` comment.
#[derive(Clone, PartialEq, Debug)]
pub(crate) struct Placed {
    pub(crate) section: Section,
    pub(crate) header: Span,
    pub(crate) storage: Option<Spanned<String>>,
}

/// The sections of a text in file order, duplicates and all.
pub(super) fn read(text: &str, diagnostics: &mut Vec<Diagnostic>) -> Vec<Placed> {
    let scan = lines::scan(text);
    diagnostics.extend(scan.diagnostics);
    match read_clean(&scan.clean) {
        Some(read) if agrees(&read, &scan.sections) => scan
            .sections
            .iter()
            .zip(read)
            .map(|(raw, (name, pairs))| {
                let pairs = raw.pairs.iter().zip(pairs).map(|(raw, (key, value))| {
                    (
                        Spanned::new(key, raw.key.span),
                        Spanned::new(value, raw.value.span),
                    )
                });
                placed(raw, name, pairs.collect())
            })
            .collect(),
        // Not known to happen (a test looks for it); the scanner's reading stands alone then.
        _ => scan.sections.iter().map(own).collect(),
    }
}

type ReadSection = (String, Vec<(String, String)>);

/// What rust-ini reads; the keys before the first section are a section without name.
fn read_clean(clean: &str) -> Option<Vec<ReadSection>> {
    let option = ParseOption {
        enabled_quote: false,
        enabled_escape: false,
        ..ParseOption::default()
    };
    let ini = Ini::load_from_str_opt(clean, option).ok()?;
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

fn agrees(read: &[ReadSection], scanned: &[RawSection<'_>]) -> bool {
    read.len() == scanned.len()
        && read.iter().zip(scanned).all(|((name, pairs), raw)| {
            *name == *raw.name
                && pairs.len() == raw.pairs.len()
                && pairs
                    .iter()
                    .zip(&raw.pairs)
                    .all(|((key, value), raw)| *key == *raw.key && *value == *raw.value)
        })
}

fn own(raw: &RawSection<'_>) -> Placed {
    let pairs = raw.pairs.iter().map(|pair| {
        (
            Spanned::new(pair.key.to_string(), pair.key.span),
            Spanned::new(pair.value.to_string(), pair.value.span),
        )
    });
    placed(raw, raw.name.to_string(), pairs.collect())
}

fn placed(
    raw: &RawSection<'_>,
    name: String,
    pairs: Vec<(Spanned<String>, Spanned<String>)>,
) -> Placed {
    Placed {
        section: Section {
            name: Spanned::new(name, raw.name.span),
            pairs,
        },
        header: raw.header,
        storage: raw
            .storage
            .map(|storage| Spanned::new(storage.to_string(), storage.span)),
    }
}

/// Do rust-ini and the scanner read the same? For tests over whole corpora.
#[cfg(test)]
pub(crate) fn both_agree(text: &str) -> bool {
    let scan = lines::scan(text);
    read_clean(&scan.clean).is_some_and(|read| agrees(&read, &scan.sections))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rust_ini_and_the_scanner_agree() {
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
                        assert!(both_agree(&text), "{text:?}");
                    }
                }
            }
        }
    }
}
