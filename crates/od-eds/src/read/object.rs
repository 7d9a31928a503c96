//! Reads one object: its own section and those of its members.

use alloc::collections::BTreeMap;
use alloc::string::{String, ToString};
use alloc::vec::Vec;

use crate::description::{EntryDescription, ObjectDescription};
use crate::fact::Key;
use crate::log::Log;
use crate::read::compact;
use crate::read::compact::CompactSections;
use crate::read::entry::{Assumed, Reader, Unread, extra};
use crate::read::fields::Fields;
use crate::rules::lists::reader::e0208_sub_index_without_object;
use crate::rules::structure::reader::{
    W0325_KEYS, e0301_object_code_unknown, e0305_var_with_sub_objects, e0353_too_many_sub_objects,
    w0302_object_type_missing, w0316_sub_number_not_a_number, w0317_sub_number_missing,
    w0322_sub_index_not_var, w0324_compact_beside_sections, w0325_value_of_array,
};
use crate::rules::values::w0427_domain_with_number_type::w0427_number_in_domain;
use crate::scan::section::{Text, TextSection};
use crate::span::Spanned;
use crate::standards::cia301;
use od_model::{Address, ObjectCode};

/// The sections of one object.
#[derive(Default)]
pub(crate) struct Sections<'a> {
    pub(crate) own: Option<TextSection<'a>>,
    pub(crate) members: BTreeMap<u8, TextSection<'a>>,
    pub(crate) compact: CompactSections<'a>,
}

/// The object of the sections; `None` if neither its own nor a member's exists.
pub(crate) fn object(
    index: u16,
    sections: Sections<'_>,
    log: &mut Log,
) -> Option<ObjectDescription> {
    let Some(own) = sections.own else {
        return orphan(index, sections.members, log);
    };
    let address = Address::new(index, 0);
    let mut fields = Fields::new(own, address, log);
    let mut reader = Reader { address, log };
    let name = reader.name(&mut fields);
    let mut unread = Vec::new();
    let found = sections.members.len();
    let sub_number = sub_number(&mut reader, &mut fields, &mut unread, found);
    let mut count = compact::count(&mut reader, &mut fields, &mut unread);
    if let Some(given) = count.take_if(|_| !sections.members.is_empty()) {
        reader.report(w0324_compact_beside_sections(given.span));
        if fields.has("DataType") {
            count = Some(given);
        } else {
            unread.push(("CompactSubObj".into(), given.value.to_string()));
        }
    }
    let has_members = !sections.members.is_empty() || count.is_some();
    let code = object_code(&mut reader, &mut fields, &mut unread, has_members);
    let members = sections.members;
    let mistaken = !code.has_members() && has_members;
    let code = if mistaken {
        contradiction(&mut reader, &fields, code, &members, count.as_ref())
    } else {
        code
    };
    if !code.has_members() {
        let number = sub_number.and_then(|found| Some(Spanned::new(found.value?, found.span)));
        return Some(var(reader, fields, name, code, number, unread));
    }
    let mut entries = BTreeMap::new();
    let mut flags = 0;
    let count = count.map(|count| room(&mut reader, count));
    if let Some(count) = &count {
        let members = Assumed::Standard {
            sub: 1,
            is_whole: false,
        };
        let template = reader.entry(&mut fields, name.clone(), members);
        flags = template.0.flags;
        entries = compact::expand(
            reader.address,
            template,
            count,
            sections.compact,
            reader.log,
        );
    } else if mistaken && fields.has("DataType") && !members.contains_key(&0) {
        // The keys of the VAR belong to sub-index 0, where a VAR has its value.
        let whole = Assumed::Standard {
            sub: 0,
            is_whole: true,
        };
        let (mut entry, more) = reader.entry(&mut fields, name.clone(), whole);
        entry.extra = extra(Vec::new(), more);
        entries.insert(0, entry);
    } else {
        flags = reader.flags(&mut fields, &mut unread).max(flags);
        // The keys of an object that is mistaken for a VAR are those of a VAR.
        if !mistaken {
            keys_of_var(&mut reader, &fields, *code);
        }
    }
    let group = fields.group;
    for (sub, section) in members {
        let mut entry = member(Address::new(index, sub), section, reader.log);
        entry.group = entry.group.or(group);
        entries.insert(sub, entry);
    }
    let counted = entries.len() as u32;
    let span = fields.header;
    if count.is_none() && sub_number.is_none() && counted > 0 && !mistaken {
        reader.report(w0317_sub_number_missing(span, counted));
    }
    let sub_number = match (count, sub_number) {
        // CompactSubObj replaces it.
        (Some(count), _) => Spanned::new(counted, count.span),
        (None, given) => given
            .and_then(|given| Some(Spanned::new(given.value?, given.span)))
            .unwrap_or(Spanned::from(counted)),
    };
    Some(ObjectDescription {
        code,
        name,
        sub_number: Some(sub_number),
        entries,
        flags,
        extra: extra(fields.rest(address, true, reader.log), unread),
        span,
    })
}

/// Reports the keys of a VAR in the section of an ARRAY or a RECORD.
fn keys_of_var(reader: &mut Reader<'_>, fields: &Fields<'_>, code: ObjectCode) {
    if !matches!(code, ObjectCode::Array | ObjectCode::Record) {
        return;
    }
    for key in W0325_KEYS.into_iter().filter(|key| fields.has(key.name())) {
        if let Some(place) = fields.place(key.name()) {
            reader.report(w0325_value_of_array(place, key, code));
        }
    }
}

/// The members of a CompactSubObj: all if there is room for them, otherwise none.
fn room(reader: &mut Reader<'_>, count: Spanned<u8>) -> Spanned<u8> {
    if reader.log.expand(usize::from(count.value)) {
        return count;
    }
    reader.report(e0353_too_many_sub_objects(count.span));
    Spanned::new(0, count.span)
}

/// Members whose object has no section.
fn orphan(
    index: u16,
    members: BTreeMap<u8, TextSection<'_>>,
    log: &mut Log,
) -> Option<ObjectDescription> {
    let span = members.values().next()?.header;
    log.push(e0208_sub_index_without_object(span, index));
    let entries: BTreeMap<_, _> = members
        .into_iter()
        .map(|(sub, section)| (sub, member(Address::new(index, sub), section, log)))
        .collect();
    Some(ObjectDescription {
        code: Spanned::from(ObjectCode::Record),
        name: Spanned::from(String::new()),
        sub_number: Some(Spanned::from(entries.len() as u32)),
        entries,
        flags: 0,
        extra: Vec::new(),
        span,
    })
}

fn member(address: Address, section: TextSection<'_>, log: &mut Log) -> EntryDescription {
    let mut fields = Fields::new(section, address, log);
    let mut reader = Reader { address, log };
    let name = reader.name(&mut fields);
    let mut unread = Vec::new();
    let mut domain = None;
    let mut assumed = Assumed::Standard {
        sub: address.sub,
        is_whole: false,
    };
    if let Some(given) = fields.take("ObjectType") {
        let code = reader.object_code(&given);
        if !matches!(code, Some(ObjectCode::Var | ObjectCode::Domain)) {
            reader.report(w0322_sub_index_not_var(&given));
        }
        // A member is a VAR; other keys are kept.
        if code != Some(ObjectCode::Var) {
            unread.push(("ObjectType".into(), given.value.into_owned()));
        }
        if code == Some(ObjectCode::Domain) {
            assumed = Assumed::Domain;
            domain = Some(given.span);
        }
    }
    let (mut entry, mut more) = reader.entry(&mut fields, name, assumed);
    if let Some((code, given)) = domain.zip(entry.data_type)
        && let Some(finding) = w0427_number_in_domain(code, given)
    {
        reader.report(finding);
    }
    unread.append(&mut more);
    entry.extra = extra(fields.rest(address, false, reader.log), unread);
    entry
}

fn var(
    mut reader: Reader<'_>,
    mut fields: Fields<'_>,
    name: Spanned<String>,
    code: Spanned<ObjectCode>,
    sub_number: Option<Spanned<u32>>,
    mut unread: Unread,
) -> ObjectDescription {
    let assumed = match *code {
        ObjectCode::Domain => Assumed::Domain,
        _ => Assumed::Standard {
            sub: 0,
            is_whole: true,
        },
    };
    let (mut entry, mut more) = reader.entry(&mut fields, name, assumed);
    unread.append(&mut more);
    entry.extra = extra(fields.rest(reader.address, false, reader.log), unread);
    ObjectDescription {
        code,
        sub_number,
        ..ObjectDescription::var(entry)
    }
}

fn object_code(
    reader: &mut Reader<'_>,
    fields: &mut Fields<'_>,
    unread: &mut Unread,
    has_members: bool,
) -> Spanned<ObjectCode> {
    let guess = if has_members {
        ObjectCode::Record
    } else {
        ObjectCode::Var
    };
    let read = |reader: &mut Reader<'_>, given: &Text<'_>| reader.object_code(given);
    // The code of the standard, if it has such sub-objects.
    let standard = cia301::of(reader.address.index).map(|standard| standard.code());
    let right = standard.filter(|code| code.has_members() == has_members);
    let wrong = |given: &Text<'_>| e0301_object_code_unknown(given, right.unwrap_or(guess));
    match reader.keyed(fields, unread, Key::ObjectType, read, wrong) {
        Some(found) => Spanned::new(found.value.unwrap_or(guess), found.span),
        None => {
            if has_members {
                reader.report(w0302_object_type_missing(fields.header));
            }
            Spanned::from(guess)
        }
    }
}

/// An object that has members but should not: a RECORD; an ARRAY if
/// CompactSubObj counts them.
fn contradiction(
    reader: &mut Reader<'_>,
    fields: &Fields<'_>,
    code: Spanned<ObjectCode>,
    members: &BTreeMap<u8, TextSection<'_>>,
    count: Option<&Spanned<u8>>,
) -> Spanned<ObjectCode> {
    let span = match (members.values().next(), count) {
        (Some(member), _) => member.header,
        (None, Some(count)) => count.span,
        (None, None) => fields.header,
    };
    let standard = cia301::of(reader.address.index);
    let same = standard.filter(|standard| standard.code() == *code);
    let same = same.map(|standard| standard.source());
    reader.report(e0305_var_with_sub_objects(
        span,
        code,
        count.is_some(),
        same,
    ));
    let meant = match count {
        Some(_) => ObjectCode::Array,
        None => ObjectCode::Record,
    };
    Spanned::new(meant, code.span)
}

/// SubNumber of an object with this many sections of sub-indices; the inner `None` if it is unreadable.
fn sub_number(
    reader: &mut Reader<'_>,
    fields: &mut Fields<'_>,
    unread: &mut Unread,
    members: usize,
) -> Option<Spanned<Option<u32>>> {
    let key = Key::SubNumber;
    let read =
        |reader: &mut Reader<'_>, given: &Text<'_>| u32::try_from(reader.number(key, given)?).ok();
    let wrong = |given: &Text<'_>| w0316_sub_number_not_a_number(given, members);
    reader.keyed(fields, unread, key, read, wrong)
}
