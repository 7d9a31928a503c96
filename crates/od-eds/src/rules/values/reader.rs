//! Rules about types, access and flags that the reader reports: it has the text, a description has
//! only the value.

use alloc::format;
use alloc::string::String;
use od_model::{Access, DataType};

use crate::fact::Key;
use crate::finding::{Finding, Fixability, Form, Rule, Severity::Error};
use crate::fix::Fix;
use crate::scan::forms::nearest;
use crate::scan::section::Text;
use crate::span::{Span, Spanned};

pub(crate) static E0402: Rule = Rule {
    title: "DataType is not a data type",
    why: "DataType is the index of a data type of CiA 301. odkit leaves the value out of the dictionary.",
    source: "CiA 301, data types",
    says: "{DataType} `{given}` is not a data type",
    fixability: Fixability::Unsafe,
    help: "write `{DataType={right}}` ({right}){fix}, or another type",
    ..Rule::of("E0402")
};

/// The finding about such a DataType, with the type of the standard.
pub(crate) fn e0402_data_type_unknown(given: &Text<'_>, standard: Option<DataType>) -> Finding {
    let finding = E0402.given(given).key(Key::DataType);
    let finding = finding.fact("right", standard.unwrap_or(DataType::Unsigned32));
    match standard {
        Some(right) => {
            let fix = Fix::unsafe_fix().replace(given.span, format!("0x{:04X}", right.code()));
            finding.fix(fix)
        }
        None => finding,
    }
}

pub(crate) static W0404: Rule = Rule {
    severity: Error,
    buildable: true,
    title: "AccessType is missing",
    why: "Every value has an AccessType. odkit assumes `ro`.",
    source: "CiA 306-1, object sections",
    fixability: Fixability::Unsafe,
    says: "{AccessType} is missing",
    help: "add `{AccessType=ro}`{fix}, or another access type",
    ..Rule::of("W0404")
};

pub(crate) fn w0404_access_type_missing(header: Span) -> Finding {
    W0404
        .at(header)
        .fix(Fix::unsafe_fix().below(header, "AccessType=ro"))
}

pub(crate) static E0405: Rule = Rule {
    title: "AccessType is not valid",
    why: "AccessType gives what a master can read and write. odkit assumes `ro`.",
    source: "CiA 306-1, object sections",
    says: "`{given}` is not a valid {AccessType}",
    fixability: Fixability::Unsafe,
    help: "write {right}{fix} (odkit assumes `ro`)",
    ..Rule::of("E0405")
};

/// The finding about such an AccessType, with the one that has a letter instead of a digit 0, the only one that differs in
/// one letter, or the access of the standard.
pub(crate) fn e0405_access_type_not_valid(given: &Text<'_>, standard: Option<Access>) -> Finding {
    let finding = E0405.given(given).key(Key::AccessType);
    let is_near = |access: &Access| nearest(given, [access.name()].into_iter(), 1).is_some();
    let mut near = Access::ALL.into_iter().filter(is_near);
    let only = near.next().filter(|_| near.next().is_none());
    let letters = given.replace('0', "o");
    let mut typed = Access::ALL.into_iter();
    let typed = typed.find(|access| access.name().eq_ignore_ascii_case(&letters));
    match typed.or(only).or(standard) {
        Some(meant) => {
            let fix = Fix::unsafe_fix().replace(given.span, meant.name());
            finding
                .fact("right", format!("`{}`", meant.name()))
                .fix(fix)
        }
        None => finding.fact("right", "`ro`, `wo`, `rw`, `rwr`, `rww` or `const`"),
    }
}

pub(crate) static W0406: Rule = Rule {
    severity: Error,
    buildable: true,
    also: &[W0406_XDD],
    title: "PDOMapping is neither 0 nor 1",
    why: "PDOMapping gives if a PDO can map the object. odkit assumes 0 (not mappable).",
    source: "CiA 306-1, object sections",
    says: "{PDOMapping} `{given}` is neither 0 nor 1",
    help: "write `{PDOMapping=1}` if a PDO can map the object, and `{PDOMapping=0}` if not",
    ..Rule::of("W0406")
};

/// Sentence for an XDD.
const W0406_XDD: Form = Form {
    says: "PDOmapping `{given}` is not valid",
    help: "write `no`, `default`, `optional`, `TPDO` or `RPDO`",
};

/// The same finding in an XDD, whose schema has other words.
#[cfg(feature = "xdd")]
pub(crate) fn w0406_in_xdd(given: &Spanned<String>) -> Finding {
    W0406.given(given).key(Key::PdoMapping).form(&W0406_XDD)
}

pub(crate) fn w0406_pdo_mapping_not_valid(given: &Text<'_>) -> Finding {
    W0406.given(given).key(Key::PdoMapping)
}

pub(crate) static W0407: Rule = Rule {
    title: "ObjFlags is not a number",
    why: "ObjFlags tells a tool how to handle the object. odkit assumes 0.",
    source: "CiA 306-1, ObjFlags",
    fixability: Fixability::Unsafe,
    says: "`{given}` is not a valid {ObjFlags}",
    help: "write `{ObjFlags=0}`{fix}, or remove the line",
    ..Rule::of("W0407")
};

pub(crate) fn w0407_obj_flags_not_a_number(given: &Text<'_>) -> Finding {
    W0407
        .given(given)
        .key(Key::ObjFlags)
        .fix(Fix::unsafe_fix().replace(given.span, "0"))
}

pub(crate) static I0425: Rule = Rule {
    title: "data type defined in the file",
    why: "Sub-index 1 of the object with that index gives the basic type. odkit uses this type and its limits; most EDS parsers do not know such types.",
    source: "CanFestival, object dictionary editor",
    says: "`{given}` is a data type that the file defines",
    fixability: Fixability::Unsafe,
    help: "write `{DataType={right}}`{fix}",
    ..Rule::of("I0425")
};

/// The finding about a type of the file, with the place of its basic type.
pub(crate) fn i0425_own_data_type(given: &Text<'_>, stands_for: &Text<'_>) -> Finding {
    let finding = I0425
        .given(given)
        .key(Key::DataType)
        .fact("right", &*stands_for.value);
    let fix = Fix::unsafe_fix().replace(given.span, &*stands_for.value);
    let finding = finding.related(stands_for.span, "basic type defined here");
    finding.fix(fix)
}

pub(crate) static W0426: Rule = Rule {
    title: "DataType of a standard object is missing",
    why: "Many tools leave out a value without a DataType, or stop. odkit assumes the type that the standard specifies for the object.",
    source: "CiA 306-1, object sections; CiA 301, object dictionary",
    fixability: Fixability::Safe,
    says: "{DataType} is missing; the standard specifies {type} here",
    help: "add `{DataType={type}}`{fix}",
    ..Rule::of("W0426")
};

pub(crate) fn w0426_standard_type_missing(header: Span, data_type: DataType) -> Finding {
    let right = format!("DataType=0x{:04X}", data_type.code());
    let fix = Fix::safe().below(header, right);
    W0426.at(header).fact("type", data_type).fix(fix)
}

pub(crate) static E0428: Rule = Rule {
    title: "$NODEID is misspelled",
    why: "No tool knows the name, and the value has no number. odkit leaves the value out of the dictionary.",
    source: "CiA 306-1, $NODEID",
    fixability: Fixability::Unsafe,
    says: "{key} `{given}` has another name than `$NODEID`",
    help: "write `$NODEID+0x{offset:X}`{fix}",
    ..Rule::of("E0428")
};

pub(crate) fn e0428_node_id_misspelled(key: Key, given: &Text<'_>, offset: u32) -> Finding {
    let right = format!("$NODEID+0x{offset:X}");
    let finding = E0428.given(given).key(key).fact("offset", offset);
    finding.fix(Fix::unsafe_fix().replace(given.span, right))
}

pub(crate) static E0429: Rule = Rule {
    buildable: true,
    title: "accessType has a word of the attribute access",
    why: "CiA 311 has one set of words for accessType of an object, and another for access of a parameter. A tool that validates the file by the schema rejects it. odkit reads the word.",
    source: "CiA 311, CANopenObject",
    fixability: Fixability::Unsafe,
    says: "`{given}` is a word for the attribute access of a parameter, not for accessType",
    help: "write `accessType=\"{right}\"`{fix}",
    ..Rule::of("E0429")
};

/// The finding about accessType in an XDD, with the word that an object has for it.
#[cfg_attr(not(feature = "xdd"), allow(dead_code))]
pub(crate) fn e0429_access_of_parameter(given: &Spanned<String>, right: &'static str) -> Finding {
    let fix = Fix::unsafe_fix().replace(given.span, right);
    let finding = E0429.given(given).key(Key::AccessType);
    finding.fact("right", right).fix(fix)
}

pub(crate) static W0430: Rule = Rule {
    title: "PDOmapping contradicts accessType",
    why: "A TPDO can only map a value that the device lets a master read, and an RPDO one that a master writes: no PDO can map the object.",
    source: "CiA 311, PDOmapping and accessType",
    says: "PDOmapping is `{given}`, but accessType is `{access}`",
    help: "correct PDOmapping or accessType: a TPDO maps what can be read, an RPDO what can be written",
    ..Rule::of("W0430")
};

/// The finding about an object of an XDD that can be mapped in a direction in which a master cannot use it.
#[cfg_attr(not(feature = "xdd"), allow(dead_code))]
pub(crate) fn w0430_other_direction(
    mapping: &Spanned<String>,
    access: &Spanned<String>,
) -> Finding {
    let finding = W0430.given(mapping).key(Key::PdoMapping);
    let finding = finding.fact("access", access.as_str());
    finding.related(access.span, "accessType")
}

pub(crate) static W0456: Rule = Rule {
    title: "file of a value that is not a DOMAIN",
    why: "A configuration tool reads or writes files for objects of the type DOMAIN only: the value stays as it is.",
    source: "CiA 306-1, DCF",
    says: "`{file}` is for a DOMAIN, but this value is {data_type}",
    help: "write the value with `ParameterValue=`, or remove the line",
    ..Rule::of("W0456")
};

pub(crate) fn w0456_file_of_number(
    place: Span,
    file: &'static str,
    data_type: DataType,
) -> Finding {
    W0456
        .at(place)
        .fact("file", file)
        .fact("data_type", data_type)
}
