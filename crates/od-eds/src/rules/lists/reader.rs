//! Rules about lists, sections and keys that the reader reports, because a description no longer
//! contains the lines.

use alloc::collections::BTreeSet;
use alloc::format;
use alloc::string::{String, ToString};
use alloc::vec::Vec;

use crate::fact::Fact;
use crate::finding::{
    Finding, Fixability, Form, Rule,
    Severity::{Error, Info, Warning},
};
use crate::fix::Fix;
use crate::scan::names::{List, place};
use crate::scan::number::number;
use crate::scan::section::{Text, TextSection};
use crate::span::Span;
#[cfg(feature = "xdd")]
use crate::span::Spanned;

pub(crate) static W0201: Rule = Rule {
    severity: Error,
    buildable: true,
    title: "listed object has no section",
    why: "A master that trusts the lists fails at the missing section. odkit ignores the entry.",
    source: "CiA 306-1, object lists",
    fixability: Fixability::Unsafe,
    says: "{object} is listed, but section [{object:04X}] is missing",
    help: "remove the entry{fix}, or add the section",
    ..Rule::of("W0201")
};

/// The finding about an entry of a list whose object has no section.
pub(crate) fn w0201_section_missing(entry: Span, index: u16) -> Finding {
    W0201
        .at(entry)
        .index(index)
        .fix(Fix::unsafe_fix().remove_line(entry))
}

pub(crate) static W0202: Rule = Rule {
    title: "object is missing from the lists",
    why: "A tool that follows the lists does not find the object. odkit keeps it.",
    source: "CiA 306-1, object lists",
    fixability: Fixability::Unsafe,
    says: "{object} is missing from the object lists",
    help: "add `0x{object:04X}` to [{list}]{fix}",
    ..Rule::of("W0202")
};

/// The finding about an object that no list has. The fix is that of [`w0202_listed`].
pub(crate) fn w0202_object_not_listed(object: Span, index: u16, fix: Fix) -> Finding {
    W0202
        .at(object)
        .index(index)
        .fact("list", List::of(index).name())
        .fix(fix)
}

/// The fix that adds all objects that a list lacks. It has no edits if the numbers of the list are not those from 1 to
/// SupportedObjects, which other findings are about, unless the objects are as many as the numbers that are missing.
pub(crate) fn w0202_listed(placed: &TextSection<'_>, missing: &[u16]) -> Fix {
    let keys = placed.pairs.iter().filter_map(|(key, _)| number(key));
    let found = keys.clone().count() as i128;
    let numbers: BTreeSet<i128> = keys.collect();
    let new = found + missing.len() as i128;
    let Some(count) = placed.get("SupportedObjects") else {
        return Fix::unsafe_fix();
    };
    let given = number(count);
    let free = (1..=new).filter(|number| !numbers.contains(number));
    let free: Vec<i128> = free.collect();
    let is_whole = given == Some(found) && free.first().is_none_or(|first| *first == found + 1);
    let is_unique = numbers.len() as i128 == found;
    let is_counted = is_whole || given == Some(new);
    if !is_counted || !is_unique || free.len() != missing.len() {
        return Fix::unsafe_fix();
    }
    let entries = free.iter().zip(missing);
    let entries = entries.map(|(entry, index)| (*entry, format!("{entry}=0x{index:04X}")));
    let mut fix = Fix::unsafe_fix();
    if is_whole {
        fix = fix.replace(count.span, new.to_string());
    }
    let mut at = count.span;
    let mut lines = entries.peekable();
    for (key, value) in &placed.pairs {
        // The entries with lower numbers go above this one.
        let own = number(key);
        let mut above = Vec::new();
        while let Some((_, line)) = lines.next_if(|(entry, _)| own.is_some_and(|own| *entry < own))
        {
            above.push(line);
        }
        if !above.is_empty() {
            fix = fix.above(key.span, above.join("\n"));
        }
        at = value.span;
    }
    let below: Vec<String> = lines.map(|(_, line)| line).collect();
    if below.is_empty() {
        fix
    } else {
        fix.below(at, below.join("\n"))
    }
}

pub(crate) static W0203: Rule = Rule {
    severity: Error,
    buildable: true,
    title: "object lists are missing or empty",
    why: "A tool that follows the lists finds no objects. odkit reads the section of every object.",
    source: "CiA 306-1, object lists",
    says: "the object lists are missing or empty",
    help: "list the objects in [MandatoryObjects], [OptionalObjects] and [ManufacturerObjects]",
    ..Rule::of("W0203")
};

/// The finding about a file whose lists are missing or empty.
pub(crate) fn w0203_lists_missing() -> Finding {
    W0203.finding()
}

pub(crate) static W0204: Rule = Rule {
    buildable: true,
    title: "SupportedObjects does not match its list",
    why: "Many tools read only as many entries as SupportedObjects says. odkit reads all entries.",
    source: "CiA 306-1, object lists",
    fixability: Fixability::Safe,
    says: "SupportedObjects is {given}, but the list has {found:entry|entries}",
    help: "write `SupportedObjects={found}`{fix}",
    also: &[W0204_MISSING, W0204_XDD],
    ..Rule::of("W0204")
};

/// Sentence for a list without SupportedObjects.
const W0204_MISSING: Form = Form {
    says: "SupportedObjects is missing",
    ..Form::OWN
};

/// Sentence for the object list of an XDD.
const W0204_XDD: Form = Form {
    says: "{name} is {given}, but the list has {found:object|objects} of this kind",
    help: "write `{name}=\"{found}\"`{fix}",
};

/// The finding about a count in the object list of an XDD.
#[cfg(feature = "xdd")]
pub(crate) fn w0204_in_xdd(given: &Spanned<String>, name: &'static str, found: usize) -> Finding {
    let fix = Fix::safe().replace(given.span, found.to_string());
    let finding = W0204.given(given).form(&W0204_XDD).fact("name", name);
    finding.fact("found", found).fix(fix)
}

/// The finding about a SupportedObjects that is missing, or is not the number of entries. If a tool
/// that counts would lose an entry with a higher number, or if the number counts `unlisted` objects of the file, the
/// finding has no fix.
pub(crate) fn w0204_supported_objects_count(
    header: Span,
    given: Option<&Text<'_>>,
    found: i128,
    highest: i128,
    unlisted: usize,
) -> Finding {
    let counts_all =
        |given: &Text<'_>| unlisted > 0 && number(given) == Some(found + unlisted as i128);
    let finding = match given {
        Some(given) if highest > found || counts_all(given) => W0204.given(given),
        Some(given) => W0204
            .given(given)
            .fix(Fix::safe().replace(given.span, found.to_string())),
        None => W0204
            .at(header)
            .form(&W0204_MISSING)
            .fix(Fix::safe().below(header, format!("SupportedObjects={found}"))),
    };
    // No tool can use a text that is not a number.
    let is_text = given.is_some_and(|given| number(given).is_none());
    let finding = if is_text {
        finding.severity_of(Error)
    } else {
        finding
    };
    finding.fact("found", found)
}

pub(crate) static W0205: Rule = Rule {
    severity: Error,
    buildable: true,
    title: "list entry is not valid",
    why: "A tool does not find the object, or stops. odkit ignores the entry. An entry is a number and an index, as in `1=0x1000`.",
    source: "CiA 306-1, object lists",
    says: "`{entry}` is not a valid list entry",
    help: "write a number and an index, such as `1=0x1000`",
    ..Rule::of("W0205")
};

pub(crate) fn w0205_list_entry_not_valid(key: &Text<'_>, value: &Text<'_>) -> Finding {
    W0205
        .at(key.span)
        .fact("entry", format!("{}={}", key.value, value.value))
}

pub(crate) static W0206: Rule = Rule {
    title: "object is in the wrong list",
    why: "A tool that reads only one list misses the object. 2000h to 5FFFh belong to [ManufacturerObjects], 1000h, 1001h and 1018h to [MandatoryObjects], all others to [OptionalObjects].",
    source: "CiA 306-1, object lists",
    says: "{object} belongs to [{right}], not to [{wrong}]",
    fixability: Fixability::Unsafe,
    help: "move the entry to [{right}]{fix}",
    ..Rule::of("W0206")
};

/// The finding about an entry of this list. The fix removes the entry, and `listed` adds it to the right list, if that
/// does not have it.
pub(crate) fn w0206_wrong_list(
    entry: Span,
    index: u16,
    list: List,
    listed: Option<Fix>,
) -> Finding {
    W0206
        .at(entry)
        .index(index)
        .fact("right", List::of(index).name())
        .fact("wrong", list.name())
        .fix(match listed {
            Some(fix) => fix.remove_line(entry),
            None => Fix::unsafe_fix(),
        })
}

pub(crate) static W0207: Rule = Rule {
    title: "object is listed twice",
    why: "Some tools create two objects. odkit ignores the second entry.",
    source: "CiA 306-1, object lists",
    fixability: Fixability::Safe,
    says: "duplicate entry for {object}",
    help: "remove one of the entries{fix}",
    ..Rule::of("W0207")
};

pub(crate) fn w0207_listed_twice(entry: Span, index: u16, first: Span) -> Finding {
    W0207
        .at(entry)
        .index(index)
        .related(first, "first listed here")
        .fix(Fix::safe().remove_line(entry))
}

pub(crate) static E0208: Rule = Rule {
    title: "sub-index without its object",
    why: "A tool that reads the object finds neither its name nor its object code. odkit keeps the sub-objects in an object without a name.",
    source: "CiA 306-1, object sections",
    says: "section [{object:04X}] of this sub-object is missing",
    help: "add a section [{object:04X}] with `{ObjectType=0x9}` (RECORD) or `{ObjectType=0x8}` (ARRAY)",
    ..Rule::of("E0208")
};

/// The finding about the first section of a sub-object without its object.
pub(crate) fn e0208_sub_index_without_object(member: Span, index: u16) -> Finding {
    E0208.at(member).index(index)
}

pub(crate) static W0209: Rule = Rule {
    title: "compact section without CompactSubObj",
    why: "A tool ignores the names and values in the section. [xxxxName], [xxxxValue] and [xxxxDenotation] belong to an object with CompactSubObj. odkit keeps the section and ignores it.",
    source: "CiA 306-1, CompactSubObj",
    says: "[{name}] needs an object with {CompactSubObj}",
    help: "write `{CompactSubObj=}` and the number of sub-objects in [{object:04X}], or remove the section",
    ..Rule::of("W0209")
};

pub(crate) fn w0209_compact_without_key(section: &TextSection<'_>, index: u16) -> Finding {
    W0209
        .at(section.header)
        .index(index)
        .fact("name", &*section.name.value)
}

pub(crate) static I0211: Rule = Rule {
    title: "section is not defined in CiA 306",
    why: "A typo in the name of an object hides the object. odkit keeps the section and ignores it; some tools store notes in sections of their own.",
    source: "CiA 306-1, file format",
    buildable: true,
    says: "[{name}] is not a section of CiA 306",
    help: "write `[2000]` or `[2000sub1]` if an object is meant",
    ..Rule::of("I0211")
};

pub(crate) fn i0211_unknown_section(section: &TextSection<'_>) -> Finding {
    let finding = I0211.at(section.header).fact("name", &*section.name.value);
    if is_object(section) {
        finding.severity_of(Error)
    } else {
        finding
    }
}

/// Returns whether a section has the keys of an object, which no tool then finds.
fn is_object(section: &TextSection<'_>) -> bool {
    let has = |key| section.get(key).is_some();
    has("ParameterName") && (has("DataType") || has("ObjectType"))
}

pub(crate) static I0212: Rule = Rule {
    severity: Warning,
    buildable: true,
    title: "section name is not written as `1018` or `1018sub2`",
    why: "Many tools do not find the object. odkit reads it. An index has four hexadecimal digits, a sub-index no leading 0.",
    source: "CiA 306-1, object sections",
    fixability: Fixability::Either,
    says: "odkit reads [{name}] as [{right}]",
    help: "write `[{right}]`{fix}",
    ..Rule::of("I0212")
};

pub(crate) fn i0212_section_name_spelling(section: &TextSection<'_>, right: &str) -> Finding {
    // With a leading 0 the sub-index has the same value; every other spelling loses the object or the sub-object.
    let severity = if place(&section.name.value) == place(right) {
        Warning
    } else {
        Error
    };
    // Fewer digits may mean another index than the one with leading zeros.
    let plain = section.name.value.to_ascii_lowercase();
    let index = plain.split("sub").next().unwrap_or_default();
    let index = index.strip_prefix("0x").unwrap_or(index);
    let digits = index.bytes().filter(u8::is_ascii_hexdigit).count();
    // A tool that now ignores the section would stop at an object without a type or an access.
    let has = |key: &str| section.get(key).is_some_and(|value| !value.is_empty());
    let is_whole = has("DataType") && has("AccessType") || has("SubNumber") || has("CompactSubObj");
    let fix = if digits < 4 || !is_whole {
        Fix::unsafe_fix()
    } else {
        Fix::safe()
    };
    I0212
        .at(section.header)
        .severity_of(severity)
        .fact("name", &*section.name.value)
        .fact("right", right)
        .fix(fix.replace(section.header, format!("[{right}]")))
}

pub(crate) static W0213: Rule = Rule {
    buildable: true,
    title: "section name is probably misspelled",
    why: "A tool ignores the section. odkit keeps it and ignores it.",
    source: "CiA 306-1, file format",
    fixability: Fixability::Unsafe,
    says: "[{name}] is not a section of CiA 306",
    help: "write `[{meant}]` if this section is meant{fix}",
    ..Rule::of("W0213")
};

/// The finding about a section whose name is probably misspelled.
pub(crate) fn w0213_section_misspelled(section: &TextSection<'_>, meant: &str) -> Finding {
    W0213
        .at(section.header)
        .fact("name", &*section.name.value)
        .fact("meant", meant)
        .severity_of(if is_object(section) { Error } else { Warning })
        .fix(Fix::unsafe_fix().replace(section.header, format!("[{meant}]")))
}

pub(crate) static W0214: Rule = Rule {
    title: "duplicate number in a list",
    why: "A tool that asks for each number misses one of the two entries. odkit reads both.",
    source: "CiA 306-1, object lists",
    fixability: Fixability::Safe,
    says: "duplicate entry number {number}",
    help: "number the entries 1, 2, 3 and so on{fix}",
    ..Rule::of("W0214")
};

pub(crate) fn w0214_number_twice(renumbered: Fix, key: &Text<'_>, first: Span) -> Finding {
    W0214
        .at(key.span)
        .fact("number", &*key.value)
        .related(first, "first used here")
        .fix(renumbered)
}

pub(crate) static W0215: Rule = Rule {
    title: "list of a module does not match its sections",
    why: "A configuration tool creates only the objects that the list names. odkit reads every section.",
    source: "CiA 306-1, modular devices",
    says: "{object} is listed, but its section in module {module} is missing",
    help: "add the section, or remove the entry",
    also: &[W0215_UNLISTED],
    ..Rule::of("W0215")
};

/// Sentence for a section that the list lacks.
const W0215_UNLISTED: Form = Form {
    says: "{object} is missing from [{list}]",
    help: "add `0x{object:04X}` to [{list}]",
};

pub(crate) fn w0215_no_section(entry: Span, index: u16, module: u16) -> Finding {
    let finding = W0215.at(entry).fact("object", Fact::Index(index));
    finding.fact("module", module)
}

pub(crate) fn w0215_unlisted(header: Span, index: u16, list: &str) -> Finding {
    let finding = W0215.at(header).form(&W0215_UNLISTED);
    finding
        .fact("object", Fact::Index(index))
        .fact("list", list)
}

pub(crate) static W0217: Rule = Rule {
    title: "key or section of a configured device in an EDS",
    why: "An EDS describes a type of device, a DCF one configured device. A tool ignores the value in an EDS, or configures every device of the type with it. odkit uses the value.",
    source: "CiA 306-1, DCF; CiA 311, XDC",
    says: "`{name}` belongs to a DCF, and this file is an EDS",
    help: "remove the key, or save the file as a DCF (`FileName` and file name ending in `.dcf`)",
    also: &[W0217_SECTION, W0217_XDD],
    ..Rule::of("W0217")
};

/// Sentence for a section.
const W0217_SECTION: Form = Form {
    says: "[{name}] belongs to a DCF, and this file is an EDS",
    help: "remove the section, or save the file as a DCF (`FileName` and file name ending in `.dcf`)",
};

/// Sentence for an attribute or an element of an XDD.
const W0217_XDD: Form = Form {
    says: "`{name}` belongs to an XDC, and this file is an XDD",
    help: "remove it, or save the file as an XDC (`fileName` and file name ending in `.xdc`)",
};

/// The finding about a key, or an attribute if the file `is_xml`.
pub(crate) fn w0217_dcf_key(at: Span, name: &str, is_xml: bool) -> Finding {
    let form = if is_xml { &W0217_XDD } else { &Form::OWN };
    W0217.at(at).form(form).fact("name", name)
}

pub(crate) fn w0217_dcf_section(header: Span, name: &str) -> Finding {
    W0217.at(header).form(&W0217_SECTION).fact("name", name)
}

pub(crate) static W0218: Rule = Rule {
    title: "list entry is not written as `1=0x1000`",
    why: "Many tools read another index, or none, or never ask for the entry. odkit reads the entry as it is meant.",
    source: "CiA 306-1, object lists",
    fixability: Fixability::Safe,
    says: "odkit reads list entry `{given}` as {object}",
    help: "write `0x{object:04X}`{fix}",
    also: &[W0218_NUMBER],
    ..Rule::of("W0218")
};

/// Sentence for the number of an entry.
const W0218_NUMBER: Form = Form {
    says: "odkit reads entry number `{given}` as {number}",
    help: "write `{number}`{fix}",
};

pub(crate) fn w0218_index(value: &Text<'_>, index: u16) -> Finding {
    let fix = Fix::safe().replace(value.span, format!("0x{index:04X}"));
    W0218.given(value).index(index).fix(fix)
}

pub(crate) fn w0218_number(key: &Text<'_>, number: i128) -> Finding {
    let fix = Fix::safe().replace(key.span, format!("{number}"));
    W0218
        .given(key)
        .form(&W0218_NUMBER)
        .fact("number", number)
        .fix(fix)
}

pub(crate) static W0242: Rule = Rule {
    severity: Error,
    buildable: true,
    title: "list entries are not numbered 1, 2, 3",
    why: "Many tools ask for entries 1, 2, 3 up to SupportedObjects and miss an entry with another number. odkit reads all entries.",
    source: "CiA 306-1, object lists",
    fixability: Fixability::Safe,
    says: "entry {place} of the list has number {number}",
    help: "number the entries 1, 2, 3 and so on{fix}",
    ..Rule::of("W0242")
};

/// The finding about the first entry of a list whose number is not its position.
pub(crate) fn w0242_list_numbering(renumbered: Fix, key: &Text<'_>, place: i128) -> Finding {
    W0242
        .at(key.span)
        .fact("place", place)
        .fact("number", &*key.value)
        .fix(renumbered)
}

/// Gives every entry the number of its position.
pub(crate) fn w0242_renumbered(list: &TextSection<'_>) -> Fix {
    let entries = list.pairs.iter();
    let entries = entries.filter(|(key, _)| number(key).is_some());
    (1i128..)
        .zip(entries)
        .fold(Fix::safe(), |fix, (place, (key, _))| {
            if number(key) == Some(place) {
                fix
            } else {
                fix.replace(key.span, place.to_string())
            }
        })
}

pub(crate) static W0249: Rule = Rule {
    title: "module extends an object that does not exist",
    why: "A configuration tool has no object to add the sub-objects of the module to.",
    source: "CiA 306-1, modular devices",
    says: "module {module} extends {object}, which is missing in the device and in the module",
    help: "add {missing}, or remove the section",
    ..Rule::of("W0249")
};

/// The finding about the section of an extension.
pub(crate) fn w0249_extended_object_missing(header: Span, index: u16, module: u16) -> Finding {
    let finding = W0249.at(header).fact("object", Fact::Index(index));
    let missing = Fact::Section(index, None);
    finding.fact("module", module).fact("missing", missing)
}

pub(crate) static W0252: Rule = Rule {
    title: "bit rate is not one of CiA 306",
    why: "A tool ignores the key and does not offer the bit rate. odkit keeps the key and ignores it.",
    source: "CiA 306-1, DeviceInfo; CiA 311, baudRate; CiA 301, bit rates",
    fixability: Fixability::Unsafe,
    says: "`{name}` is not a key of [DeviceInfo]",
    help: "write BaudRate_10, 20, 50, 125, 250, 500, 800 or 1000, or remove the line",
    also: &[W0252_XDD],
    ..Rule::of("W0252")
};

/// Sentence for a bit rate of an XDD.
const W0252_XDD: Form = Form {
    says: "`{name}` is not a bit rate of CiA 311",
    help: "write `10 Kbps`, 20, 50, 125, 250, 500, 800 or `1000 Kbps`{fix}, or remove the value",
};

/// The finding about a bit rate of an XDD that is not a word of the schema; `meant` is the bit rate in kbit/s that it
/// probably means.
#[cfg(feature = "xdd")]
pub(crate) fn w0252_in_xdd(given: &Spanned<String>, meant: Option<u32>) -> Finding {
    let finding = W0252.at(given.span).form(&W0252_XDD).severity_of(Error);
    let finding = finding.fact("name", given.as_str());
    match meant {
        Some(meant) => finding.fix(Fix::unsafe_fix().replace(given.span, format!("{meant} Kbps"))),
        None => finding,
    }
}

/// Returns whether this is a key for a bit rate, whatever the rate.
pub(crate) fn is_rate(key: &str) -> bool {
    let start = key.get(.."BaudRate_".len());
    start.is_some_and(|start| start.eq_ignore_ascii_case("BaudRate_"))
}

pub(crate) fn w0252_bit_rate_unknown(key: &Text<'_>) -> Finding {
    // Other tools work without it, too.
    W0252
        .at(key.span)
        .severity_of(Info)
        .fact("name", &*key.value)
}
