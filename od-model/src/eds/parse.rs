//! From text to a description.

use alloc::collections::BTreeMap;
use alloc::collections::btree_map::Entry;
use alloc::format;
use alloc::string::String;
use alloc::vec::Vec;

use super::fields::{duplicates, same_content};
use super::ini::{self, Placed};
use super::object::{self, Sections};
use super::sections::{List, Place, place};
use super::{Parsed, compact, lists, number};
use crate::check::rules;
use crate::{Address, Diagnostic, Span};

/// Reads an EDS or a DCF.
///
/// Never fails, never panics: what it cannot read is a diagnostic, and stands as
/// text in the `extra` of where it was. It does not check: see
/// [`check`](crate::check::check) and [`load`](super::load).
pub fn parse(text: &str) -> Parsed {
    let mut diagnostics = Vec::new();
    let sections = ini::read(text, &mut diagnostics);
    let mut sorted = Sorted {
        log: diagnostics,
        ..Sorted::default()
    };
    for section in sections {
        sorted.add(section);
    }
    sorted.parsed()
}

/// The sections of a file by what they are about.
#[derive(Default)]
struct Sorted {
    objects: BTreeMap<u16, Sections>,
    lists: BTreeMap<List, Vec<Placed>>,
    others: Vec<Placed>,
    names: BTreeMap<String, Span>,
    log: Vec<Diagnostic>,
}

impl Sorted {
    fn add(&mut self, section: Placed) {
        match place(&section.section.name) {
            Place::Object(index) => {
                let sections = self.objects.entry(index).or_default();
                let address = Address::new(index, 0);
                match &sections.own {
                    None => sections.own = Some(section),
                    Some(first) => self.log.push(twice(first, &section, address)),
                }
            }
            Place::Member(index, sub) => {
                match self.objects.entry(index).or_default().members.entry(sub) {
                    Entry::Vacant(entry) => {
                        entry.insert(section);
                    }
                    Entry::Occupied(first) => {
                        let finding = twice(first.get(), &section, Address::new(index, sub));
                        self.log.push(finding);
                    }
                }
            }
            Place::Compact(index, compact) => {
                match self
                    .objects
                    .entry(index)
                    .or_default()
                    .compact
                    .entry(compact)
                {
                    Entry::Vacant(entry) => {
                        duplicates(&section.section.pairs, &mut self.log);
                        entry.insert(section);
                    }
                    Entry::Occupied(first) => {
                        let finding = twice(first.get(), &section, Address::new(index, 0));
                        self.log.push(finding);
                    }
                }
            }
            Place::List(list) => self.lists.entry(list).or_default().push(section),
            Place::Other => self.other(section),
        }
    }

    fn other(&mut self, section: Placed) {
        duplicates(&section.section.pairs, &mut self.log);
        let name = &section.section.name;
        match self.names.entry(name.to_ascii_lowercase()) {
            Entry::Vacant(entry) => {
                entry.insert(section.header);
            }
            Entry::Occupied(first) => self.log.push(
                rules::W0106
                    .at(section.header, format!("[{}] stands twice", name.value))
                    .with_label(*first.get(), "this one counts")
                    .with_help("put the keys of both into one section"),
            ),
        }
        self.others.push(section);
    }

    fn parsed(mut self) -> Parsed {
        let mut parsed = Parsed::default();
        for (index, mut sections) in core::mem::take(&mut self.objects) {
            let is_compact = sections.own.as_ref().is_some_and(counts_members);
            if !is_compact {
                for section in core::mem::take(&mut sections.compact).into_values() {
                    let name = &section.section.name;
                    self.log
                        .push(compact::unclaimed(name, section.header, index));
                    self.others.push(section);
                }
            }
            if let Some(object) = object::object(index, sections, &mut self.log) {
                parsed.description.objects.insert(index, object);
            }
        }
        self.others.sort_by_key(|section| section.header.start);
        parsed.description.sections = self.others.into_iter().map(|s| s.section).collect();
        lists::check(&self.lists, &parsed.description, &mut self.log);
        parsed.diagnostics = self.log;
        crate::check::sort(&mut parsed.diagnostics);
        parsed
    }
}

/// Has the object a CompactSubObj that counts something?
fn counts_members(own: &Placed) -> bool {
    own.section
        .get("CompactSubObj")
        .and_then(|count| number(count))
        .is_some_and(|count| count > 0)
}

fn twice(first: &Placed, second: &Placed, address: Address) -> Diagnostic {
    let name = &second.section.name.value;
    let same = same_content(&first.section, &second.section);
    let (rule, message) = match same {
        true => (rules::W0304, format!("[{name}] stands twice")),
        false => (
            rules::E0303,
            format!("[{name}] stands twice, and the two differ"),
        ),
    };
    rule.at(second.header, message)
        .with_address(address)
        .with_label(first.header, "this one counts")
        .with_help("remove one of the sections")
}
