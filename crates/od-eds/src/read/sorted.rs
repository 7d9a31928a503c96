//! Sorts sections by their subject, and makes the description.

use alloc::collections::BTreeMap;
use alloc::collections::btree_map::Entry;
use alloc::format;
use alloc::string::String;
use alloc::vec::Vec;

use od_model::Address;

use crate::description::{Description, Section};
use crate::finding::Finding;
use crate::log::Log;
use crate::read::fields::duplicates;
use crate::read::object::{self, Sections};
use crate::read::{compact_pdo, configured, lists, other, own_types};
use crate::rules;
use crate::rules::lists::reader::{i0212_section_name_spelling, w0209_compact_without_key};
use crate::rules::structure::reader::{e0303_duplicate_object_differs, w0304_duplicate_object};
use crate::rules::text::{
    e0118_merge_conflict, e0119_too_large, w0101_no_sign, w0101_unknown_line, w0102_no_key,
    w0103_no_closing_bracket, w0104_text_after_header, w0105_key_before_section,
    w0106_duplicate_section, w0108_colon, w0110_header_without_name,
};
use crate::scan::lines::{self, Fault};
use crate::scan::names::{List, Place, intended, place};
use crate::scan::number::number;
use crate::scan::section::{TextSection, owned};
use crate::span::Span;

/// Reads an EDS or a DCF; `file` is its name on the disk, if it has one, and `see` receives the sections.
pub(crate) fn eds(
    text: &str,
    file: Option<&str>,
    see: &mut dyn FnMut(&[TextSection<'_>]),
    log: &mut Log,
) -> Description {
    let sections = lines::scan(text, &mut |fault| report(fault, log));
    see(&sections);
    configured::check(&sections, file, &configured::EDS, log);
    for section in &sections {
        other::lengths(section, log);
    }
    let mut sorted = Sorted::of(sections, log);
    sorted.has_lists = true;
    sorted.described()
}

/// Reads only the sections of objects, for an XDD and for the modules of a device, where no
/// list names them.
pub(crate) fn objects(sections: Vec<TextSection<'_>>, log: &mut Log) -> Description {
    Sorted::of(sections, log).described()
}

/// The sections of a file by their subject.
struct Sorted<'a, 'l> {
    objects: BTreeMap<u16, Sections<'a>>,
    lists: BTreeMap<List, Vec<TextSection<'a>>>,
    others: Vec<TextSection<'a>>,
    names: BTreeMap<String, Span>,
    /// Keys of duplicate sections, with their positions among the pairs of the first section.
    repeated: BTreeMap<Place, BTreeMap<String, usize>>,
    has_lists: bool,
    log: &'l mut Log,
}

impl<'a, 'l> Sorted<'a, 'l> {
    fn of(sections: Vec<TextSection<'a>>, log: &'l mut Log) -> Self {
        let mut sorted = Self {
            objects: BTreeMap::new(),
            lists: BTreeMap::new(),
            others: Vec::new(),
            names: BTreeMap::new(),
            repeated: BTreeMap::new(),
            has_lists: false,
            log,
        };
        for section in sections {
            sorted.add(section);
        }
        sorted
    }

    fn add(&mut self, section: TextSection<'a>) {
        let place = self.place(&section);
        let (index, sub) = match place {
            Place::Object(index) | Place::Compact(index, _) => (index, 0),
            Place::Member(index, sub) => (index, sub),
            Place::List(list) => return self.lists.entry(list).or_default().push(section),
            Place::Other => return self.other(section),
        };
        let sections = self.objects.entry(index).or_default();
        let first = match place {
            Place::Member(..) => sections.members.get_mut(&sub),
            Place::Compact(_, compact) => sections.compact.get_mut(&compact),
            _ => sections.own.as_mut(),
        };
        if let Some(first) = first {
            let keys = self.repeated.entry(place).or_insert_with(|| keys(first));
            let finding = twice(first, keys, section);
            return self.log.push(finding.about(Address::new(index, sub)));
        }
        match place {
            Place::Member(..) => drop(sections.members.insert(sub, section)),
            Place::Compact(_, compact) => {
                duplicates(&section.pairs, self.log);
                sections.compact.insert(compact, section);
            }
            _ => sections.own = Some(section),
        }
    }

    /// The place of a section, even if its name is misspelled.
    fn place(&mut self, section: &TextSection<'_>) -> Place {
        let name = &section.name;
        let exact = place(name);
        let meant = match exact {
            Place::Other => intended(name, describes(section)),
            Place::Member(_, sub) if name.len() > 7 + format!("{sub:X}").len() => Some(exact),
            _ => None,
        };
        let (Some(meant), Some(right)) = (meant, meant.and_then(Place::name)) else {
            return exact;
        };
        self.log.push(i0212_section_name_spelling(section, &right));
        meant
    }

    fn other(&mut self, section: TextSection<'a>) {
        duplicates(&section.pairs, self.log);
        other::check(&section, self.log);
        let name = &section.name;
        match self.names.entry(name.to_ascii_lowercase()) {
            Entry::Vacant(entry) => {
                entry.insert(section.header);
            }
            Entry::Occupied(first) => self
                .log
                .push(w0106_duplicate_section(&section, *first.get())),
        }
        self.others.push(section);
    }

    fn described(mut self) -> Description {
        let mut described = Description::default();
        own_types::resolve(&mut self.objects, self.log);
        for (index, mut sections) in core::mem::take(&mut self.objects) {
            let is_compact = sections.own.as_ref().is_some_and(counts_members);
            if !is_compact {
                for section in core::mem::take(&mut sections.compact).into_values() {
                    self.log.push(w0209_compact_without_key(&section, index));
                    self.others.push(section);
                }
            }
            if let Some(object) = object::object(index, sections, self.log) {
                described.objects.insert(index, object);
            }
        }
        self.others.sort_by_key(|section| section.header.start);
        described.sections = self.others.into_iter().map(kept).collect();
        let mut made = compact_pdo::objects(&described, self.log);
        if self.has_lists {
            lists::check(&self.lists, &described, &made, self.log);
        }
        described.objects.append(&mut made);
        described
    }
}

/// A section in the form of a description.
fn kept(section: TextSection<'_>) -> Section {
    let pairs = section.pairs.into_iter();
    Section {
        name: owned(section.name),
        pairs: pairs
            .map(|(key, value)| (owned(key), owned(value)))
            .collect(),
    }
}

/// Returns whether a section describes an object, whatever its name.
fn describes(section: &TextSection<'_>) -> bool {
    ["ParameterName", "DataType", "SubNumber"]
        .iter()
        .any(|key| section.get(key).is_some())
}

/// Returns whether the object has a CompactSubObj that is not 0.
fn counts_members(own: &TextSection<'_>) -> bool {
    own.get("CompactSubObj")
        .and_then(|count| number(count))
        .is_some_and(|count| count > 0)
}

/// The first position of each key of a section.
fn keys(section: &TextSection<'_>) -> BTreeMap<String, usize> {
    let mut keys = BTreeMap::new();
    for (at, (key, _)) in section.pairs.iter().enumerate() {
        keys.entry(key.to_ascii_lowercase()).or_insert(at);
    }
    keys
}

/// The finding about a second section; its fix adds the keys that the first section (with these keys) lacks.
fn twice<'a>(
    first: &mut TextSection<'a>,
    keys: &mut BTreeMap<String, usize>,
    second: TextSection<'a>,
) -> Finding {
    let contradict = second.pairs.iter().any(|(key, value)| {
        let same = keys.get(&key.to_ascii_lowercase());
        let same = same.and_then(|at| first.pairs.get(*at));
        same.is_some_and(|(_, first)| first != value)
    });
    let finding = if contradict {
        e0303_duplicate_object_differs(first, &second)
    } else {
        w0304_duplicate_object(first, &second)
    };
    for (key, value) in second.pairs {
        match keys.entry(key.to_ascii_lowercase()) {
            Entry::Vacant(entry) => {
                entry.insert(first.pairs.len());
                first.pairs.push((key, value));
            }
            Entry::Occupied(entry) => first.again.push(entry.key().clone()),
        }
    }
    finding
}

/// Reports a problem.
pub(crate) fn report(fault: &Fault<'_>, log: &mut Log) {
    match *fault {
        Fault::Conflict(line) => log.add(&rules::E0118, || e0118_merge_conflict(line)),
        Fault::NoPair(line) => log.add(&rules::W0101, || w0101_unknown_line(line)),
        Fault::NoSign { at, key, value } => {
            log.add(&rules::W0101, || w0101_no_sign(at, key, value));
        }
        Fault::NoKey(line) => log.add(&rules::W0102, || w0102_no_key(line)),
        Fault::Open { line, name } => {
            log.add(&rules::W0103, || w0103_no_closing_bracket(line, name))
        }
        Fault::Behind { name, text } => {
            log.add(&rules::W0104, || w0104_text_after_header(name, text))
        }
        Fault::NoName(line) => log.add(&rules::W0110, || w0110_header_without_name(line)),
        Fault::NoSection { line, key } => log.push(w0105_key_before_section(line, key)),
        Fault::Long(line) => log.add(&rules::E0119, || {
            e0119_too_large(line, "line", lines::LONGEST, "bytes")
        }),
        Fault::Many { at, most, of } => log.push(e0119_too_large(at, "file", most, of)),
        Fault::Colon { at, key, value } => {
            log.add(&rules::W0108, || w0108_colon(at, key, value));
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::description::Value;
    use crate::load::Parsed;
    use crate::load::parse;
    use od_model::{DataType, Group, ObjectCode};

    fn codes(parsed: &Parsed) -> Vec<&'static str> {
        parsed.findings.iter().map(|d| d.code()).collect()
    }

    #[test]
    fn an_object_with_members() {
        let parsed = parse(
            "[OptionalObjects]\nSupportedObjects=1\n1=0x1018\n\
             [1018]\nParameterName=Identity\nObjectType=9\nSubNumber=2\nObjFlags=1\n\
             [1018sub0]\nParameterName=Count\nDataType=5\nAccessType=const\nDefaultValue=1\n\
             [1018sub1]\nParameterName=Vendor-ID\nDataType=7\nAccessType=ro\nOwn=kept\n",
        );
        assert_eq!(codes(&parsed), ["W0206", "I0319"]);
        let object = &parsed.description.objects[&0x1018];
        assert_eq!(*object.code, ObjectCode::Record);
        assert_eq!((object.span.line, object.flags), (4, 1));
        let vendor = &object.entries[&1];
        assert_eq!(vendor.extra, [("Own".into(), "kept".into())]);
        assert_eq!(vendor.data_type.unwrap().span.line, 16);
        assert_eq!(vendor.span.line, 14);
        assert_eq!(vendor.default, None);
    }

    #[test]
    fn an_unreadable_value_is_kept_as_text() {
        let parsed =
            parse("[2000]\nParameterName=x\nDataType=0x99\nAccessType=any\nDefaultValue=5");
        assert_eq!(codes(&parsed), ["E0402", "E0405", "W0203"]);
        let entry = &parsed.description.objects[&0x2000].entries[&0];
        let kept = [
            ("AccessType".into(), "any".into()),
            ("DataType".into(), "0x99".into()),
            ("DefaultValue".into(), "5".into()),
        ];
        assert_eq!(entry.extra, kept);
        assert_eq!(entry.data_type, None);
    }

    #[test]
    fn a_second_section_only_adds_missing_keys() {
        let parsed = parse(
            "[2000]\nParameterName=First\nDataType=5\nAccessType=rw\n\
             [2000]\nparametername=Second\nAccessType=rw\nDefaultValue=7\n\
             [2001]\nParameterName=a\nObjectType=9\nSubNumber=1\n\
             [2001sub1]\nParameterName=First\nDataType=5\nAccessType=ro\nDefaultValue=1\n\
             [2001sub1]\nDefaultValue=2\nLowLimit=0\n\
             [2002]\nParameterName=a\nObjectType=8\nDataType=5\nAccessType=rw\nCompactSubObj=2\n\
             [2002Value]\nNrOfEntries=2\n1=3\n[2002Value]\n1=4\n2=5\n\
             [2003]\nParameterName=a\nDataType=5\nAccessType=rw\n[2003]\nDefaultValue=7\n",
        );
        let entry = |index, sub| parsed.description.entry(Address::new(index, sub)).unwrap();
        let number = |value: &Option<crate::span::Spanned<Value>>| match value.as_deref() {
            Some(Value::Unsigned(number)) => Some(*number),
            _ => None,
        };
        let whole = entry(0x2000, 0);
        assert_eq!(
            (&*whole.name.value, number(&whole.default)),
            ("First", Some(7))
        );
        let member = entry(0x2001, 1);
        assert_eq!(
            (number(&member.default), number(&member.low)),
            (Some(1), Some(0))
        );
        let compact = [1, 2].map(|sub| number(&entry(0x2002, sub).parameter));
        assert_eq!(compact, [Some(3), Some(5)]);
        assert_eq!(number(&entry(0x2003, 0).default), Some(7));
        // Keys that contradict the first section, and one that does not; no key is duplicated.
        let mut twice = codes(&parsed);
        twice.retain(|code| ["E0303", "W0304", "W0107"].contains(code));
        assert_eq!(twice, ["E0303", "E0303", "E0303", "W0304"]);
    }

    #[test]
    fn members_are_saved_with_their_object() {
        let parsed = parse(
            "[2000]\n;StorageLocation=PERSIST_APP\nObjectType=8\n[2000sub0]\nDataType=5\n\
             [2000sub1]\n;StorageLocation=RAM\nDataType=5\n",
        );
        let entries = &parsed.description.objects[&0x2000].entries;
        assert_eq!(entries[&0].group.map(|g| g.value), Some(Group::Application));
        assert_eq!(entries[&1].group.map(|g| g.value), Some(Group::None));
    }

    #[test]
    fn compact_members_get_names_and_values() {
        let parsed = parse(
            "\u{FEFF}[2000]\nParameterName=Gain\nObjectType=8\nDataType=5\nAccessType=rw\n\
             CompactSubObj=3\n[2000Value]\n2=7\n[2000Name]\n3=Last\n[2000Denotation]\n1=D\n",
        );
        let entries = &parsed.description.objects[&0x2000].entries;
        assert_eq!(entries.len(), 4);
        assert_eq!(*entries[&1].name, "Gain1");
        assert_eq!(*entries[&3].name, "Last");
        let value = entries[&2].parameter.clone().unwrap();
        assert_eq!((value.value, value.span.line), (Value::Unsigned(7), 8));
        assert_eq!(entries[&1].extra, [("Denotation".into(), "D".into())]);
        assert_eq!(*entries[&0].data_type.unwrap(), DataType::Unsigned8);
    }

    #[test]
    fn sections_without_objects_are_kept_unchanged() {
        let parsed = parse("[FileInfo]\nA=1\n[2000Name]\n1=x\n[Mine]\na=2\nA=3\n");
        let names: Vec<_> = parsed
            .description
            .sections
            .iter()
            .map(|s| &s.name.value)
            .collect();
        assert_eq!(names, ["FileInfo", "2000Name", "Mine"]);
        assert_eq!(parsed.description.sections[2].pairs.len(), 2);
        assert_eq!(codes(&parsed), ["I0319", "W0209", "I0211", "E0117"]);
    }
}
