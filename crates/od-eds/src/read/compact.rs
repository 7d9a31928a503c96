//! CompactSubObj: many members from one section.

use alloc::collections::{BTreeMap, BTreeSet};
use alloc::format;
use alloc::string::ToString;
use alloc::vec::Vec;

use crate::description::{EntryDescription, Value};
use crate::fact::Key;
use crate::log::Log;
use crate::read::entry::{Reader, Unread, extra};
use crate::read::fields::Fields;
use crate::rules::structure::reader::{
    w0313_compact_not_valid, w0314_compact_sub_index_missing, w0321_nr_of_entries,
};
use crate::scan::names::Compact;
use crate::scan::number;
use crate::scan::section;
use crate::scan::section::{Text, TextSection};
use crate::span::Spanned;
use od_model::{Access, Address, DataType};

/// The `[xxxxName]`, `[xxxxValue]` and `[xxxxDenotation]` of an object.
pub(crate) type CompactSections<'a> = BTreeMap<Compact, TextSection<'a>>;

/// The highest sub-index of a member.
const HIGHEST: u8 = 254;

/// CompactSubObj, if the object has one that is not 0.
pub(crate) fn count(
    reader: &mut Reader<'_>,
    fields: &mut Fields<'_>,
    unread: &mut Unread,
) -> Option<Spanned<u8>> {
    let given = fields.take("CompactSubObj")?;
    let number = reader.number(Key::CompactSubObj, &given);
    let count = match number {
        Some(0) => return None,
        Some(number) if (1..=i128::from(HIGHEST)).contains(&number) => {
            return Some(Spanned::new(number as u8, given.span));
        }
        Some(number) if number > 0 => Some(Spanned::new(HIGHEST, given.span)),
        _ => None,
    };
    let most = count.as_ref().map(|count| count.value);
    reader.report(w0313_compact_not_valid(&given, most));
    if count.is_none() {
        unread.push(("CompactSubObj".into(), given.value.into_owned()));
    }
    count
}

/// The members that CompactSubObj replaces, with the names and values of some of them.
pub(crate) fn expand(
    address: Address,
    template: (EntryDescription, Unread),
    count: &Spanned<u8>,
    sections: CompactSections<'_>,
    log: &mut Log,
) -> BTreeMap<u8, EntryDescription> {
    let (template, unread) = template;
    let mut entries = BTreeMap::from([(0, highest(address.index, count))]);
    for sub in 1..=count.value {
        let name = format!("{}{sub}", template.name.value);
        entries.insert(
            sub,
            EntryDescription {
                name: Spanned::new(name, template.name.span),
                extra: extra(Vec::new(), unread.clone()),
                ..template.clone()
            },
        );
    }
    let mut given = BTreeSet::new();
    for (compact, section) in sections {
        entry_count(&section, address, log);
        for (key, value) in &section.pairs {
            if key.eq_ignore_ascii_case("NrOfEntries") || value.is_empty() {
                continue;
            }
            let sub =
                number::integer(key, &mut Vec::new()).and_then(|n| u8::try_from(n.value).ok());
            let entry = sub.and_then(|sub| Some((sub, entries.get_mut(&sub)?)));
            match entry {
                // The first of duplicate keys is used; the others were reported.
                Some((sub, _)) if !given.insert((compact, sub)) => {}
                Some((sub, entry)) => {
                    let address = Address::new(address.index, sub);
                    give(Reader { address, log }, entry, compact, value);
                }
                None => log.push(w0314_compact_sub_index_missing(key, count).about(address)),
            }
        }
    }
    entries
}

/// Reports an NrOfEntries that differs from the number of entries of its section.
fn entry_count(section: &TextSection<'_>, address: Address, log: &mut Log) {
    let entries = section
        .pairs
        .iter()
        .filter(|(key, value)| !key.eq_ignore_ascii_case("NrOfEntries") && !value.is_empty())
        .count();
    let has_empty = section.pairs.iter().any(|(_, value)| value.is_empty());
    let given = section.get("NrOfEntries");
    if given.and_then(|given| crate::scan::number::number(given)) == i128::try_from(entries).ok() {
        return;
    }
    log.push(w0321_nr_of_entries(section.header, given, entries, has_empty).about(address));
}

fn give(mut reader: Reader<'_>, entry: &mut EntryDescription, compact: Compact, value: &Text<'_>) {
    match compact {
        Compact::Name => entry.name = section::owned(value.clone()),
        Compact::Denotation => {
            let unread = core::mem::take(&mut entry.extra);
            entry.extra = extra(
                alloc::vec![("Denotation".into(), value.to_string())],
                unread,
            );
        }
        Compact::Value => {
            let mut unread = core::mem::take(&mut entry.extra);
            unread.retain(|(key, _)| key != "ParameterValue");
            entry.parameter = reader.typed(Key::ParameterValue, value, entry.data_type, None);
            if entry.parameter.is_none() {
                unread.push(("ParameterValue".into(), value.to_string()));
            }
            entry.extra = extra(Vec::new(), unread);
        }
    }
}

/// Sub-index 0, which CompactSubObj implies. For 1003h it is the present number of errors, not the
/// capacity, and a master writes 0 to it.
fn highest(index: u16, count: &Spanned<u8>) -> EntryDescription {
    let (number, access) = match index {
        0x1003 => (0, Access::Rw),
        _ => (count.value, Access::Ro),
    };
    EntryDescription {
        default: Some(Spanned::new(Value::Unsigned(u64::from(number)), count.span)),
        access: Spanned::new(access, count.span),
        span: count.span,
        ..EntryDescription::new("NrOfObjects", DataType::Unsigned8)
    }
}
