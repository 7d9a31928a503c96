//! Objects and sub-objects: attributes of the object list, completed by their parameters.

use alloc::format;
use alloc::string::{String, ToString};
use alloc::vec::Vec;

use roxmltree::Node;

use crate::fix::Fix;
use crate::rules::lists::reader::w0204_in_xdd;
use crate::rules::text::{
    e0114_xdd_index_not_valid, e0115_xdd_parameter_missing, e0121_capitals,
    w0120_object_type_missing, w0123_attribute_not_valid,
};
use crate::rules::values::reader::{
    e0429_access_of_parameter, w0406_in_xdd, w0430_other_direction,
};
use crate::scan::section::TextSection;
use crate::span::{Span, Spanned};
use crate::xdd::parameters::Parameter;
use crate::xdd::source::Made;
use crate::xdd::source::{Ids, Reader, below, children};
use crate::xdd::types::{self, Found};
use od_model::{DataType, ObjectCode};

/// The sections of all objects.
pub(super) fn sections(root: Node<'_, '_>, reader: &mut Reader<'_>) -> Vec<TextSection<'static>> {
    let ids = Ids::new(root);
    let mut made = Vec::new();
    for list in below(root, "CANopenObjectList") {
        counts(list, reader);
    }
    for object in below(root, "CANopenObject") {
        let header = reader.tag(object);
        let Some(index) = hex(object, "index", 4, reader, header) else {
            continue;
        };
        let parameter = parameter(object, &ids, reader);
        let members: Vec<_> = children(object, "CANopenSubObject").collect();
        let mut own = Made::new(format!("{index:04X}"), header);
        own.put("ParameterName", name(object, parameter, reader));
        own.put("ObjectType", reader.attribute(object, "objectType"));
        let code = object.attribute("objectType").and_then(object_code);
        let has_members = !members.is_empty() || code.is_some_and(ObjectCode::has_members);
        if has_members {
            let count = Spanned::new(members.len().to_string(), header);
            own.put(
                "SubNumber",
                reader.attribute(object, "subNumber").or(Some(count)),
            );
            own.put("ObjFlags", flags(object, reader));
            own.put("Denotation", denotation(object, parameter, reader));
            storage(&mut own, parameter, reader);
            made.push(own.placed);
        } else {
            let found = parameter.and_then(|parameter| parameter.data_type(&ids));
            value(&mut own, object, parameter, found, reader);
            made.push(own.placed);
        }
        for element in members {
            let header = reader.tag(element);
            let Some(sub) = hex(element, "subIndex", 2, reader, header) else {
                continue;
            };
            let own = self::parameter(element, &ids, reader);
            let found = own.and_then(|own| own.data_type(&ids)).or_else(|| {
                let whole = parameter?.element();
                types::member(whole, u8::try_from(sub).ok()?, &ids)
            });
            let mut member = Made::new(format!("{index:04X}sub{sub:X}"), header);
            member.put("ParameterName", name(element, own, reader));
            member.put("ObjectType", reader.attribute(element, "objectType"));
            value(&mut member, element, own, found, reader);
            made.push(member.placed);
        }
    }
    made
}

/// Compares the counts of an object list with its objects.
fn counts(list: Node<'_, '_>, reader: &mut Reader<'_>) {
    let mut found = [0; 3];
    for object in children(list, "CANopenObject") {
        let index = object.attribute("index").map(|text| text.trim());
        let index = index.and_then(|text| u16::from_str_radix(text, 16).ok());
        match index {
            Some(0x1000 | 0x1001 | 0x1018) => found[0] += 1,
            Some(0x2000..=0x5FFF) => found[2] += 1,
            Some(_) => found[1] += 1,
            None => {}
        }
    }
    let names = ["mandatoryObjects", "optionalObjects", "manufacturerObjects"];
    for (name, found) in names.into_iter().zip(found) {
        if let Some(given) = reader.attribute(list, name)
            && given.parse() != Ok(found)
        {
            let finding = w0204_in_xdd(&given, name, found);
            reader.log.push(finding);
        }
    }
}

/// An attribute of hexadecimal digits: an index or a sub-index.
fn hex(
    node: Node<'_, '_>,
    key: &str,
    digits: usize,
    reader: &mut Reader<'_>,
    header: Span,
) -> Option<u16> {
    let given = reader.attribute(node, key);
    let text = given.as_ref().map_or("", |given| given.as_str());
    let text = text.strip_prefix("0x").unwrap_or(text);
    let fits = (1..=digits).contains(&text.len()) && text.bytes().all(|b| b.is_ascii_hexdigit());
    if let Some(number) = fits.then(|| u16::from_str_radix(text, 16).ok()).flatten() {
        return Some(number);
    }
    let finding = e0114_xdd_index_not_valid(header, key, given.as_ref(), digits);
    reader.log.push(finding);
    None
}

fn object_code(text: &str) -> Option<ObjectCode> {
    ObjectCode::from_code(text.trim().parse().ok()?)
}

/// The parameter that an object refers to.
fn parameter<'a, 'i>(
    node: Node<'a, 'i>,
    ids: &Ids<'a, 'i>,
    reader: &mut Reader<'_>,
) -> Option<Parameter<'a, 'i>> {
    let id = node.attribute("uniqueIDRef")?;
    match ids.get(id) {
        Some(own) => Some(Parameter::new(own, ids)),
        None => {
            let span = reader.attribute(node, "uniqueIDRef")?.span;
            reader.log.push(e0115_xdd_parameter_missing(span, id));
            None
        }
    }
}

fn name(
    node: Node<'_, '_>,
    parameter: Option<Parameter<'_, '_>>,
    reader: &Reader<'_>,
) -> Option<Spanned<String>> {
    reader
        .attribute(node, "name")
        .or_else(|| parameter?.label(None, reader))
}

fn denotation(
    node: Node<'_, '_>,
    parameter: Option<Parameter<'_, '_>>,
    reader: &Reader<'_>,
) -> Option<Spanned<String>> {
    reader
        .attribute(node, "denotation")
        .or_else(|| parameter?.label(Some("denotation"), reader))
}

/// objFlags are hexadecimal digits without `0x`.
fn flags(node: Node<'_, '_>, reader: &Reader<'_>) -> Option<Spanned<String>> {
    let given = reader.attribute(node, "objFlags")?;
    let is_hex = !given.is_empty() && given.bytes().all(|b| b.is_ascii_hexdigit());
    Some(if is_hex {
        Spanned::new(format!("0x{}", given.value), given.span)
    } else {
        given
    })
}

fn storage(made: &mut Made, parameter: Option<Parameter<'_, '_>>, reader: &Reader<'_>) {
    let group = parameter.and_then(|own| own.property("CO_storageGroup", reader));
    made.placed.storage = group.map(|group| Spanned::new(group.value.into(), group.span));
}

/// The fields of a value: those of the object, else those of its parameter.
fn value(
    made: &mut Made,
    node: Node<'_, '_>,
    parameter: Option<Parameter<'_, '_>>,
    found: Option<Found>,
    reader: &mut Reader<'_>,
) {
    let default = reader
        .attribute(node, "defaultValue")
        .or_else(|| parameter?.value("defaultValue", reader));
    let header = made.placed.header;
    let data_type = data_type(node, found, default.as_deref(), reader, header);
    let code = node.attribute("objectType").and_then(object_code);
    if node.attribute("objectType").is_none() {
        reader.log.push(w0120_object_type_missing(header));
    }
    let is_domain = code == Some(ObjectCode::Domain);
    made.put(
        "DataType",
        data_type.filter(|_| !is_domain || found.is_some()),
    );
    let (access, mappable) = access(node, parameter, reader, header);
    made.put("AccessType", access);
    made.put("DefaultValue", default);
    for (key, attribute, limit) in [
        ("LowLimit", "lowLimit", "minValue"),
        ("HighLimit", "highLimit", "maxValue"),
    ] {
        let given = reader.attribute(node, attribute);
        made.put(key, given.or_else(|| parameter?.limit(limit, reader)));
    }
    made.put("PDOMapping", mappable);
    let actual = reader.attribute(node, "actualValue");
    let actual = actual.or_else(|| parameter?.value("actualValue", reader));
    made.put("ParameterValue", actual);
    made.put("ObjFlags", flags(node, reader));
    made.put("Denotation", denotation(node, parameter, reader));
    storage(made, parameter, reader);
}

/// The attribute dataType, which is hexadecimal, else the parameter's type.
fn data_type(
    node: Node<'_, '_>,
    found: Option<Found>,
    default: Option<&String>,
    reader: &Reader<'_>,
    header: Span,
) -> Option<Spanned<String>> {
    if let Some(given) = reader.attribute(node, "dataType") {
        let digits = !given.is_empty() && given.bytes().all(|b| b.is_ascii_hexdigit());
        return Some(if digits {
            Spanned::new(format!("0x{}", given.value), given.span)
        } else {
            given
        });
    }
    let data_type = match found? {
        Found::Type(data_type) => data_type,
        Found::Bits if default.is_none_or(|text| text.is_empty()) => DataType::Domain,
        Found::Bits => DataType::OctetString,
    };
    Some(Spanned::new(format!("0x{:04X}", data_type.code()), header))
}

/// The words of the schema for accessType of an object, access of a parameter, and PDOmapping.
pub(super) const ACCESS_TYPES: &[&str] = &["const", "ro", "wo", "rw", "rwr", "rww"];
pub(super) const ACCESSES: &[&str] = &[
    "const",
    "read",
    "write",
    "readWrite",
    "readWriteInput",
    "readWriteOutput",
    "noAccess",
];
pub(super) const MAPPINGS: &[&str] = &["no", "default", "optional", "TPDO", "RPDO"];

/// Reports a word of the schema in other capitals, and returns it as the schema has it.
fn word(given: Spanned<String>, words: &[&str], reader: &mut Reader<'_>) -> Spanned<String> {
    let mut words = words.iter();
    match words.find(|word| word.eq_ignore_ascii_case(&given)) {
        Some(word) if **word != *given.value => {
            reader.log.push(e0121_capitals(&given, word));
            Spanned::new((*word).into(), given.span)
        }
        _ => given,
    }
}

/// AccessType and PDOMapping; `None` if neither the object nor a parameter gives them. An object that is mapped in one direction only, and that a master can
/// write, is `rwr` or `rww`.
fn access(
    node: Node<'_, '_>,
    parameter: Option<Parameter<'_, '_>>,
    reader: &mut Reader<'_>,
    header: Span,
) -> (Option<Spanned<String>>, Option<Spanned<String>>) {
    let mapping = reader.attribute(node, "PDOmapping");
    let mapping = mapping.map(|given| word(given, MAPPINGS, reader));
    let direction = mapping.as_ref().map_or("", |mapping| mapping.as_str());
    // CiA 311 has different words for accessType of an object and for access of a parameter.
    let own = reader.attribute(node, "accessType");
    let own = own.map(|given| word(given, ACCESS_TYPES, reader));
    if let Some(own) = &own {
        let right = match own.as_str() {
            "read" | "noAccess" => "ro",
            "write" => "wo",
            "readWrite" | "readWriteInput" | "readWriteOutput" => "rw",
            _ => "",
        };
        if matches!(own.as_str(), "rwr" | "rww") {
            let right = "`const`, `ro`, `wo` or `rw`, and the direction in PDOmapping";
            let finding = w0123_attribute_not_valid(own, "accessType", right.into());
            let fix = Fix::unsafe_fix().replace(own.span, "rw");
            reader.log.push(finding.fix(fix));
        }
        if !right.is_empty() {
            let finding = e0429_access_of_parameter(own, right);
            reader.log.push(finding);
        }
    }
    // A parameter without access is readable.
    let given = own.or_else(|| {
        Some(match parameter?.access(reader) {
            Some(access) => word(access, ACCESSES, reader),
            None => Spanned::new("read".into(), header),
        })
    });
    // A parameter without access may be used by a tool that means another one.
    if let (Some(given), Some(mapping)) = (&given, &mapping)
        && given.span != header
        && matches!(
            (given.as_str(), direction),
            ("wo" | "write", "TPDO") | ("ro" | "read" | "const", "RPDO")
        )
    {
        reader.log.push(w0430_other_direction(mapping, given));
    }
    let of_eds = |given: &Spanned<String>| {
        match given.as_str() {
            "read" | "noAccess" => "ro",
            "write" => "wo",
            "readWrite" | "rw" if direction == "TPDO" => "rwr",
            "readWrite" | "rw" if direction == "RPDO" => "rww",
            "readWrite" => "rw",
            "readWriteInput" => "rwr",
            "readWriteOutput" => "rww",
            other => other,
        }
        .to_string()
    };
    let access = given.map(|given| Spanned::new(of_eds(&given), given.span));
    let mappable = mapping.map(|mapping| {
        let flag = match mapping.as_str() {
            "no" => "0".into(),
            "default" | "optional" | "TPDO" | "RPDO" => "1".into(),
            _ => {
                reader.log.push(w0406_in_xdd(&mapping));
                "0".into()
            }
        };
        Spanned::new(flag, mapping.span)
    });
    (access, mappable)
}
