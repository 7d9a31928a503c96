//! Rules about objects that the reader reports, because a description no longer contains the keys
//! of a section.

use alloc::format;
use alloc::string::{String, ToString};
use od_model::ObjectCode;

use crate::fact::Key;
use crate::finding::{Finding, Fixability, Form, Rule, Severity::Error};
use crate::fix::Fix;
use crate::log::EXPANDED;
use crate::scan::section::{Text, TextSection};
use crate::span::{Span, Spanned};

pub(crate) static E0301: Rule = Rule {
    title: "ObjectType is not an object code",
    why: "A tool cannot tell a VAR from an ARRAY or a RECORD. odkit assumes a RECORD if sub-objects exist, otherwise a VAR.",
    source: "CiA 301, object codes",
    says: "{ObjectType} `{given}` is not an object code",
    fixability: Fixability::Unsafe,
    help: "write `{ObjectType={right}}`{fix}, or another one of `0x7` (VAR), `0x8` (ARRAY) and `0x9` (RECORD)",
    ..Rule::of("E0301")
};

/// The finding about such an ObjectType, with the code of the standard, or the one that fits the sub-objects.
pub(crate) fn e0301_object_code_unknown(given: &Text<'_>, right: ObjectCode) -> Finding {
    let fix = Fix::unsafe_fix().replace(given.span, format!("0x{:X}", right.code()));
    let finding = E0301.given(given).key(Key::ObjectType);
    finding.fact("right", right).fix(fix)
}

pub(crate) static W0302: Rule = Rule {
    title: "object with sub-objects has no ObjectType",
    why: "A tool assumes a VAR and misses the sub-objects. odkit assumes a RECORD.",
    source: "CiA 306-1, object sections",
    fixability: Fixability::Unsafe,
    says: "{ObjectType} is missing, but sub-objects exist",
    help: "write `{ObjectType=0x9}` for a RECORD{fix}, or `{ObjectType=0x8}` for an ARRAY",
    ..Rule::of("W0302")
};

pub(crate) fn w0302_object_type_missing(header: Span) -> Finding {
    W0302
        .at(header)
        .fix(Fix::unsafe_fix().below(header, "ObjectType=0x9"))
}

pub(crate) static E0303: Rule = Rule {
    title: "duplicate object section with different values",
    why: "Tools differ in which of the two sections they use. odkit uses the first, and adds what only the second says.",
    source: "CiA 306-1, object sections",
    says: "duplicate section [{name}] with different values",
    help: "remove one of the sections",
    ..Rule::of("E0303")
};

/// The finding about a second section that contradicts the first.
pub(crate) fn e0303_duplicate_object_differs(
    first: &TextSection<'_>,
    second: &TextSection<'_>,
) -> Finding {
    twice(&E0303, first, second)
}

pub(crate) static W0304: Rule = Rule {
    title: "duplicate object section",
    why: "Some tools stop at the second section. odkit uses both; they do not contradict each other.",
    source: "CiA 306-1, object sections",
    says: "duplicate section [{name}]",
    help: "remove one of the sections",
    ..Rule::of("W0304")
};

/// The finding about a second section that does not contradict the first.
pub(crate) fn w0304_duplicate_object(first: &TextSection<'_>, second: &TextSection<'_>) -> Finding {
    twice(&W0304, first, second)
}

/// A finding about the second of two sections.
pub(super) fn twice(
    rule: &'static Rule,
    first: &TextSection<'_>,
    second: &TextSection<'_>,
) -> Finding {
    let finding = rule.at(second.header).fact("name", &*second.name.value);
    finding.related(first.header, "first defined here")
}

pub(crate) static E0305: Rule = Rule {
    title: "VAR or DOMAIN has sub-objects",
    why: "A tool that trusts ObjectType misses the sub-objects. odkit assumes a RECORD, and uses the value of the VAR as sub-index 0 if that is missing.",
    source: "CiA 301, object codes",
    fixability: Fixability::Unsafe,
    says: "{code} cannot have sub-objects",
    help: "write `{ObjectType=0x9}` for a RECORD{fix}, or `{ObjectType=0x8}` for an ARRAY",
    also: &[E0305_COMPACT, E0305_STANDARD],
    ..Rule::of("E0305")
};

/// Sentence for an object with CompactSubObj.
const E0305_COMPACT: Form = Form {
    help: "write `{ObjectType=0x8}` for an ARRAY{fix}",
    ..Form::OWN
};

/// Sentence for an object that has no sub-objects in the standard, either.
const E0305_STANDARD: Form = Form {
    says: "{code} cannot have sub-objects, and {standard} specifies {code}",
    help: "remove the section of the sub-object",
};

/// The finding about sub-objects of an object whose code does not allow them: at the first of them if the standard
/// specifies the same code, otherwise at the code if the file has it.
pub(crate) fn e0305_var_with_sub_objects(
    member: Span,
    code: Spanned<ObjectCode>,
    compact: bool,
    standard: Option<&str>,
) -> Finding {
    if let Some(standard) = standard {
        let finding = E0305.at(member).form(&E0305_STANDARD);
        let finding = finding.fact("code", *code).fact("standard", standard);
        return finding.related(code.span, "declared as {code} here");
    }
    let finding = E0305.at(code.span.or(member)).fact("code", *code);
    let finding = match code.span.line {
        0 => finding,
        _ => finding.related(member, "this is a sub-object of it"),
    };
    let fix = |right| Fix::unsafe_fix().replace(code.span, right);
    if compact {
        finding.form(&E0305_COMPACT).fix(fix("0x8"))
    } else {
        finding.fix(fix("0x9"))
    }
}

pub(crate) static W0313: Rule = Rule {
    title: "CompactSubObj is not valid",
    why: "A tool creates the wrong number of sub-objects. CompactSubObj counts them without sub-index 0; odkit assumes 254 for a larger number.",
    source: "CiA 306-1, CompactSubObj",
    says: "{CompactSubObj} `{given}` is not a number from 1 to 254",
    fixability: Fixability::Unsafe,
    help: "write {right}{fix}",
    ..Rule::of("W0313")
};

/// The finding about a CompactSubObj that is not valid, with the number that odkit assumes.
pub(crate) fn w0313_compact_not_valid(given: &Text<'_>, most: Option<u8>) -> Finding {
    let finding = W0313.given(given).key(Key::CompactSubObj);
    match most {
        Some(most) => {
            let fix = Fix::unsafe_fix().replace(given.span, most.to_string());
            finding.fact("right", format!("`{most}`")).fix(fix)
        }
        None => finding.fact("right", "the number of sub-objects without sub-index 0"),
    }
}

pub(crate) static W0314: Rule = Rule {
    title: "compact section names a missing sub-index",
    why: "A tool cannot apply the entry. odkit ignores it.",
    source: "CiA 306-1, CompactSubObj",
    says: "sub-index `{given}` does not exist",
    help: "write a sub-index from 1 to {count}",
    ..Rule::of("W0314")
};

pub(crate) fn w0314_compact_sub_index_missing(given: &Text<'_>, count: &Spanned<u8>) -> Finding {
    W0314
        .given(given)
        .fact("count", count.value)
        .related(count.span, "sub-objects counted here")
}

pub(crate) static W0315: Rule = Rule {
    title: "ParameterName is missing",
    why: "A tool shows the object without a name. Every object and every sub-object has one.",
    source: "CiA 306-1, object sections",
    says: "{ParameterName} is missing",
    help: "write `{ParameterName=}` and a name",
    ..Rule::of("W0315")
};

pub(crate) fn w0315_name_missing(header: Span) -> Finding {
    W0315.at(header)
}

pub(crate) static W0316: Rule = Rule {
    severity: Error,
    buildable: true,
    title: "SubNumber is not a number",
    why: "A tool cannot tell how many sub-objects to read. odkit counts the sections.",
    source: "CiA 306-1, object sections",
    fixability: Fixability::Unsafe,
    says: "{SubNumber} `{given}` is not a number",
    help: "write the number of sub-index sections, {count}{fix}",
    ..Rule::of("W0316")
};

/// The finding about the SubNumber of an object with this many sections of sub-indices.
pub(crate) fn w0316_sub_number_not_a_number(given: &Text<'_>, count: usize) -> Finding {
    let finding = W0316.given(given).key(Key::SubNumber).fact("count", count);
    finding.fix(Fix::unsafe_fix().replace(given.span, count.to_string()))
}

pub(crate) static W0317: Rule = Rule {
    title: "SubNumber is missing",
    why: "A tool cannot tell how many sub-objects to read. odkit counts the sections.",
    source: "CiA 306-1, object sections",
    fixability: Fixability::Safe,
    says: "{SubNumber} is missing",
    help: "write `{SubNumber={count}}`{fix}",
    ..Rule::of("W0317")
};

pub(crate) fn w0317_sub_number_missing(header: Span, count: u32) -> Finding {
    let fix = Fix::safe().below(header, format!("SubNumber={count}"));
    W0317.at(header).fact("count", count).fix(fix)
}

pub(crate) static W0318: Rule = Rule {
    title: "key is probably misspelled",
    why: "A tool ignores the key. odkit keeps the key and ignores it.",
    source: "CiA 306-1, object sections",
    fixability: Fixability::Unsafe,
    says: "`{name}` is not a key of CiA 306 for this section",
    help: "write `{meant}={given}` if this key is meant{fix}",
    also: &[W0318_XDD, W0318_ELEMENT],
    ..Rule::of("W0318")
};

/// Sentence for an attribute of an XDD.
const W0318_XDD: Form = Form {
    says: "`{name}` is not an attribute of CiA 311 for this element",
    help: "write `{meant}` if this attribute is meant{fix}",
};

/// Sentence for an element of an XDD.
const W0318_ELEMENT: Form = Form {
    says: "`{name}` is not an element of CiA 311",
    help: "write `{meant}` if this element is meant, also at its end",
};

/// The same finding about an element of an XDD.
#[cfg(feature = "xdd")]
pub(crate) fn w0318_element_misspelled(at: Span, given: &str, meant: &str) -> Finding {
    let finding = W0318.at(at).form(&W0318_ELEMENT).fact("name", given);
    finding.fact("meant", meant)
}

/// The same finding about an attribute of an XDD.
#[cfg(feature = "xdd")]
pub(crate) fn w0318_attribute_misspelled(at: Span, given: &str, meant: &str) -> Finding {
    let finding = W0318.at(at).form(&W0318_XDD).fact("name", given);
    let finding = finding.fact("meant", meant);
    finding.fix(Fix::unsafe_fix().replace(at, meant))
}

pub(crate) fn w0318_key_misspelled(key: &Text<'_>, value: &str, meant: &str) -> Finding {
    W0318
        .at(key.span)
        .fact("name", &*key.value)
        .fact("given", value)
        .fact("meant", meant)
        .fix(Fix::unsafe_fix().replace(key.span, meant))
}

pub(crate) static I0319: Rule = Rule {
    title: "key is not defined in CiA 306",
    why: "A tool ignores the key. odkit keeps the key and ignores it.",
    source: "CiA 306-1, file format",
    says: "`{name}` is not a key of CiA 306 for this section",
    help: "correct the key, or remove the line if no tool needs it",
    ..Rule::of("I0319")
};

pub(crate) fn i0319_unknown_key(key: &Text<'_>) -> Finding {
    I0319.at(key.span).fact("name", &*key.value)
}

pub(crate) static I0320: Rule = Rule {
    title: "value is empty",
    why: "Many tools stop at a number, a type or an access without a value. odkit treats the line as missing.",
    source: "CiA 306-1, object sections",
    fixability: Fixability::Safe,
    says: "`{name}` is empty",
    help: "remove the line{fix}, or write a value for `{name}`",
    ..Rule::of("I0320")
};

/// The finding about a key without the value that it needs. It has no fix if the same key follows,
/// which odkit would read then, or if tools stop at an object without the key: AccessType and
/// DataType need a value.
pub(crate) fn i0320_empty_value(key: &Text<'_>, is_single: bool) -> Finding {
    let finding = I0320.at(key.span).fact("name", &*key.value);
    let is_needed = ["AccessType", "DataType"]
        .iter()
        .any(|needed| key.eq_ignore_ascii_case(needed));
    if is_single && !is_needed {
        finding.fix(Fix::safe().remove_line(key.span))
    } else {
        finding
    }
}

pub(crate) static W0321: Rule = Rule {
    title: "NrOfEntries does not match its section",
    why: "Many tools read only as many entries as NrOfEntries says. odkit reads all entries.",
    source: "CiA 306-1, CompactSubObj",
    fixability: Fixability::Safe,
    says: "NrOfEntries is {given}, but the section has {found:entry|entries}",
    help: "write `NrOfEntries={found}`{fix}",
    also: &[W0321_MISSING],
    ..Rule::of("W0321")
};

/// Sentence for a section without NrOfEntries.
const W0321_MISSING: Form = Form {
    says: "NrOfEntries is missing",
    ..Form::OWN
};

/// The finding about an NrOfEntries that is missing, or is not the number of entries. The fix does
/// not lower it if an entry without a value remains, because a tool may reserve space for it.
pub(crate) fn w0321_nr_of_entries(
    header: Span,
    given: Option<&Text<'_>>,
    found: usize,
    has_empty: bool,
) -> Finding {
    let finding = match given {
        Some(given) if has_empty => W0321.given(given),
        Some(given) => W0321
            .given(given)
            .fix(Fix::safe().replace(given.span, found.to_string())),
        None => W0321
            .at(header)
            .form(&W0321_MISSING)
            .fix(Fix::safe().below(header, format!("NrOfEntries={found}"))),
    };
    finding.fact("found", found)
}

pub(crate) static W0322: Rule = Rule {
    severity: Error,
    buildable: true,
    title: "sub-index is not a VAR",
    why: "A tool may look for sub-objects of a sub-object. odkit assumes a VAR.",
    source: "CiA 306-1, object sections",
    fixability: Fixability::Unsafe,
    says: "{ObjectType} `{given}` is not valid for a sub-index",
    help: "write `{ObjectType=0x7}`{fix}",
    ..Rule::of("W0322")
};

pub(crate) fn w0322_sub_index_not_var(given: &Text<'_>) -> Finding {
    W0322
        .given(given)
        .key(Key::ObjectType)
        .fix(Fix::unsafe_fix().replace(given.span, "0x7"))
}

pub(crate) static W0323: Rule = Rule {
    title: "Count of a module is not valid",
    why: "A configuration tool adds the wrong number of sub-objects. odkit assumes 1. Count is a number, or `0;` and the number of bits in one shared sub-object.",
    source: "CiA 306-1, modular devices",
    says: "Count `{given}` is not valid",
    help: "write the number of sub-objects that a module adds, or `0;` and its bits",
    also: &[W0323_MISSING],
    ..Rule::of("W0323")
};

/// Sentence for an extension without Count.
const W0323_MISSING: Form = Form {
    says: "Count is missing",
    ..Form::OWN
};

/// The finding about the Count of an extension that is not valid, or missing.
pub(crate) fn w0323_module_count(header: Span, given: Option<&Spanned<String>>) -> Finding {
    match given {
        Some(given) => W0323.given(given),
        None => W0323.at(header).form(&W0323_MISSING),
    }
}

pub(crate) static W0324: Rule = Rule {
    title: "CompactSubObj beside sub-index sections",
    why: "Some tools read CompactSubObj, others the sections. odkit reads both; without a DataType it ignores CompactSubObj.",
    source: "CiA 306-1, CompactSubObj",
    says: "{CompactSubObj} replaces the sections of the sub-objects, but this object has such sections",
    help: "remove {CompactSubObj}, or remove {SubNumber} and the sections",
    ..Rule::of("W0324")
};

pub(crate) fn w0324_compact_beside_sections(count: Span) -> Finding {
    W0324.at(count).key(Key::CompactSubObj)
}

pub(crate) static W0325: Rule = Rule {
    title: "ARRAY or RECORD has a key of a value",
    why: "Only sub-objects have a value. A tool may read the object as a VAR. odkit keeps the key and ignores it.",
    source: "CiA 306-1, object sections",
    fixability: Fixability::Unsafe,
    says: "{key} is not a key of an object that is {code}",
    help: "move the line to the sections of the sub-objects, or remove it{fix}",
    ..Rule::of("W0325")
};

/// Keys that belong to the sub-objects.
pub(crate) const W0325_KEYS: [Key; 7] = [
    Key::DataType,
    Key::AccessType,
    Key::PdoMapping,
    Key::DefaultValue,
    Key::ParameterValue,
    Key::LowLimit,
    Key::HighLimit,
];

/// The finding about such a key.
pub(crate) fn w0325_value_of_array(place: Span, key: Key, code: ObjectCode) -> Finding {
    let finding = W0325.at(place).key(key).fact("code", code);
    finding.fix(Fix::unsafe_fix().remove_line(place))
}

pub(crate) static W0342: Rule = Rule {
    title: "ObjFlags has reserved bits",
    why: "A tool may give reserved bits a meaning. Bit 0 excludes the object from downloads by a configuration tool, bit 1 from uploads.",
    source: "CiA 306-1, ObjFlags",
    fixability: Fixability::Unsafe,
    says: "{ObjFlags} is 0x{flags:X}, but only bits 0 and 1 are defined",
    help: "write a number from 0 to 3{fix}",
    ..Rule::of("W0342")
};

pub(crate) fn w0342_obj_flags_reserved(given: &Text<'_>, flags: u32) -> Option<Finding> {
    let finding = W0342.at(given.span).key(Key::ObjFlags);
    let fix = Fix::unsafe_fix().replace(given.span, format!("{}", flags & 3));
    (flags & !3 != 0).then(|| finding.fact("flags", flags).fix(fix))
}

pub(crate) static E0353: Rule = Rule {
    title: "too many sub-objects without a section",
    why: "No CANopen device has 50,000 sub-objects, and a tool that creates them runs out of memory. odkit keeps sub-index 0 of the objects that are too many.",
    source: "odkit, limits of a description; CiA 306-1, CompactSubObj",
    example: "400 arrays with `CompactSubObj=254`",
    says: "{CompactSubObj} brings the file to more than {limit} sub-objects without a section",
    help: "remove objects, or write a smaller {CompactSubObj}",
    ..Rule::of("E0353")
};

pub(crate) fn e0353_too_many_sub_objects(count: Span) -> Finding {
    E0353
        .at(count)
        .key(Key::CompactSubObj)
        .fact("limit", EXPANDED)
}
