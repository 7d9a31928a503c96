//! Reads the keys of one section one by one, and keeps the others.

use alloc::borrow::Cow;
use alloc::collections::BTreeMap;
use alloc::string::String;
use alloc::vec::Vec;

use crate::fact::Key;
use crate::log::Log;
use crate::read::other::unknown_object_keys;
use crate::rules;
use crate::rules::structure::reader::i0320_empty_value;
use crate::rules::text::{e0117_duplicate_key_differs, w0107_duplicate_key};
use crate::scan::number::before_comment;
use crate::scan::section::{Text, TextSection};
use crate::span::{Span, Spanned};
use od_model::{Address, Group};

/// The keys of a section that describes an object or a member.
pub(crate) struct Fields<'a> {
    pairs: Vec<(Text<'a>, Text<'a>)>,
    /// The section header.
    pub(crate) header: Span,
    /// The group of the `;StorageLocation=` comment, if it is a known one.
    pub(crate) group: Option<Spanned<Group>>,
    /// The text of that comment.
    storage: Option<String>,
}

impl<'a> Fields<'a> {
    /// The fields of a section; of duplicate keys, the first.
    pub(crate) fn new(placed: TextSection<'a>, address: Address, log: &mut Log) -> Self {
        let mut pairs = placed.pairs;
        let twice = duplicates(&pairs, log);
        let repeated = twice.iter().map(|at| pairs[*at].0.value.clone());
        let repeated: Vec<_> = repeated
            .chain(placed.again.into_iter().map(Cow::Owned))
            .collect();
        let mut twice = twice.into_iter().peekable();
        let mut at = 0;
        pairs.retain(|_| {
            let keep = twice.next_if_eq(&at).is_none();
            at += 1;
            keep
        });
        for (key, value) in &mut pairs {
            // An empty value or limit counts as missing.
            let numeric = |key: &str| {
                let mut coded = Key::ALL.into_iter().filter(|key| key.is_coded());
                coded.any(|known| known.is(key))
            };
            if before_comment(value).is_empty() && numeric(key) {
                let is_single = !repeated.iter().any(|other| other.eq_ignore_ascii_case(key));
                log.push(i0320_empty_value(key, is_single).about(address));
                value.value = Cow::Borrowed("");
            }
        }
        let storage = placed.storage;
        let group = storage
            .as_ref()
            .and_then(|storage| group(storage).map(|group| Spanned::new(group, storage.span)));
        Self {
            pairs,
            header: placed.header,
            group,
            storage: storage.map(|storage| storage.value.into_owned()),
        }
    }

    /// Takes the value of a key; an empty one counts as missing.
    pub(crate) fn take(&mut self, key: &str) -> Option<Text<'a>> {
        let at = self
            .pairs
            .iter()
            .position(|(k, _)| k.eq_ignore_ascii_case(key))?;
        let (_, value) = self.pairs.remove(at);
        (!value.is_empty()).then_some(value)
    }

    /// Place of a key, with a value or without one.
    pub(crate) fn place(&self, key: &str) -> Option<Span> {
        let mut pairs = self.pairs.iter();
        let found = pairs.find(|(k, _)| k.eq_ignore_ascii_case(key))?;
        Some(found.0.span)
    }

    /// Returns whether the section has a value for this key.
    pub(crate) fn has(&self, key: &str) -> bool {
        self.pairs
            .iter()
            .any(|(k, v)| k.eq_ignore_ascii_case(key) && !v.is_empty())
    }

    /// The keys that were not read, in file order; unknown ones are reported. The comment about the
    /// storage is one of them if its group does not express it completely: a word of another tool,
    /// or a group for the sub-objects of an object.
    pub(crate) fn rest(
        self,
        address: Address,
        has_members: bool,
        log: &mut Log,
    ) -> Vec<(String, String)> {
        unknown_object_keys(&self.pairs, address, log);
        let group = self.group;
        let is_said = |word: &String| {
            group.is_some_and(|group| location(*group) == word.as_str()) && !has_members
        };
        let storage = self
            .storage
            .filter(|word| !word.is_empty() && !is_said(word));
        self.pairs
            .into_iter()
            .map(|(key, value)| (key.value.into_owned(), value.value.into_owned()))
            .chain(storage.map(|word| (STORAGE.into(), word)))
            .collect()
    }
}

/// The comment of CANopenEditor about the storage of a value, as a key that odkit keeps.
pub(crate) const STORAGE: &str = ";StorageLocation";

/// The word of a kept comment, and its group.
pub(crate) fn kept(extra: &[(String, String)]) -> Option<(&str, Option<Group>)> {
    let (_, word) = extra.iter().find(|(key, _)| key == STORAGE)?;
    Some((word, group(word)))
}

/// The words of CANopenEditor for the storage of a value; other words belong to other tools.
fn group(location: &str) -> Option<Group> {
    [
        ("RAM", Group::None),
        ("ROM", Group::None),
        ("PERSIST_COMM", Group::Communication),
        ("PERSIST_APP", Group::Application),
        ("PERSIST_MFR", Group::Manufacturer),
    ]
    .into_iter()
    .find(|(word, _)| location.eq_ignore_ascii_case(word))
    .map(|(_, group)| group)
}

/// The word for a group, the reverse of reading in [`Fields`].
pub(crate) const fn location(group: Group) -> &'static str {
    match group {
        Group::None => "RAM",
        Group::Communication => "PERSIST_COMM",
        Group::Application => "PERSIST_APP",
        Group::Manufacturer => "PERSIST_MFR",
    }
}

/// Reports duplicate keys, and returns the positions of the later ones.
pub(crate) fn duplicates(pairs: &[(Text<'_>, Text<'_>)], log: &mut Log) -> Vec<usize> {
    let mut found = Vec::new();
    let mut report = |(first, same): (&Text<'_>, &Text<'_>), at: usize| {
        let (key, value) = &pairs[at];
        if value == same {
            log.add(&rules::W0107, || w0107_duplicate_key(first, key, value))
        } else {
            log.add(&rules::E0117, || {
                e0117_duplicate_key_differs(first.span, key, value)
            })
        }
        found.push(at);
    };
    // Sections are short; the tree is for texts that were made to be slow.
    if pairs.len() <= 24 {
        for at in 1..pairs.len() {
            let same = |(k, _): &&(Text<'_>, _)| k.eq_ignore_ascii_case(&pairs[at].0);
            if let Some((first, value)) = pairs[..at].iter().find(same) {
                report((first, value), at);
            }
        }
    } else {
        let mut seen = BTreeMap::new();
        for (at, (key, value)) in pairs.iter().enumerate() {
            match seen.entry(key.to_ascii_lowercase()) {
                alloc::collections::btree_map::Entry::Vacant(entry) => {
                    entry.insert((key, value));
                }
                alloc::collections::btree_map::Entry::Occupied(entry) => report(*entry.get(), at),
            }
        }
    }
    found
}
