//! The types of ARRAYs and RECORDs (dataTypeList), and the parameters that have them.

use alloc::format;
use alloc::string::{String, ToString};

use super::xml::{Xml, escape, vec_of};
use crate::description::{Description, ObjectDescription};
use od_model::{DataType, ObjectCode};

/// The uniqueID of the parameter of an object with sub-objects that has a type in the list.
pub(super) fn parameter(index: u16, object: &ObjectDescription) -> Option<String> {
    kind(object).map(|_| format!("UID_OBJ_{index:04X}"))
}

/// A type that the list can contain.
enum Kind {
    Array(DataType),
    Struct,
}

/// A struct lists its members by their order, so every sub-index must exist. An array has one type
/// for all sub-indices from 1 on. A member of an unknown type has no type in XML.
fn kind(object: &ObjectDescription) -> Option<Kind> {
    let typed = |data_type: DataType| data_type.kind() != od_model::Kind::Record;
    let subs = object.entries.keys().copied().map(u16::from);
    let in_order = (0u16..).zip(subs).all(|(n, sub)| sub == n);
    let all = object.entries.values();
    let mut types = all.map(|entry| Some(entry.data_type?.value).filter(|one| typed(*one)));
    if !in_order || object.entries.len() < 2 || types.clone().any(|one| one.is_none()) {
        return None;
    }
    match *object.code {
        ObjectCode::Record => Some(Kind::Struct),
        ObjectCode::Array => {
            let own = types.nth(1)??;
            let same = types.all(|other| other == Some(own));
            same.then_some(Kind::Array(own))
        }
        _ => None,
    }
}

/// Writes the list, if it has at least one type.
pub(super) fn list(out: &mut Xml, description: &Description) {
    let objects = description.objects.iter();
    let mut types = objects
        .filter_map(|(index, object)| Some((*index, object, kind(object)?)))
        .peekable();
    if types.peek().is_none() {
        return;
    }
    out.element("dataTypeList", &[], |out| {
        for (index, object, kind) in types {
            let name = ("name", object.name.value.clone());
            let id = ("uniqueID", type_id(index));
            match kind {
                Kind::Array(data_type) => out.element("array", &vec_of([name, id]), |out| {
                    let upper = (object.entries.len() - 1).to_string();
                    let range = [("lowerLimit", "0".into()), ("upperLimit", upper)];
                    out.empty("subrange", &vec_of(range));
                    out.empty(elementary(Some(data_type)), &[]);
                }),
                Kind::Struct => out.element("struct", &vec_of([name, id]), |out| {
                    for (sub, entry) in &object.entries {
                        let name = ("name", entry.name.value.clone());
                        let id = ("uniqueID", format!("UID_SUB_{index:04X}{sub:02X}"));
                        out.element("varDeclaration", &vec_of([name, id]), |out| {
                            let data_type = entry.data_type.map(|one| one.value);
                            out.empty(elementary(data_type), &[]);
                        });
                    }
                }),
            }
        }
    });
}

/// Writes the parameters of the objects whose types are in the list.
pub(super) fn parameters(out: &mut Xml, description: &Description) {
    for (index, object) in &description.objects {
        let Some(id) = parameter(*index, object) else {
            continue;
        };
        let attributes = vec_of([("uniqueID", id), ("access", "readWrite".into())]);
        out.element("parameter", &attributes, |out| {
            out.0.push_str(&format!(
                "{}<label lang=\"en\">{}</label>\n",
                out.indent(),
                escape(&object.name)
            ));
            let reference = [("uniqueIDRef", type_id(*index))];
            out.empty("dataTypeIDRef", &vec_of(reference));
        });
    }
}

fn type_id(index: u16) -> String {
    format!("UID_TYPE_{index:04X}")
}

/// The IEC 61131-3 name of a type; the attribute of the object gives the exact type.
pub(super) fn elementary(data_type: Option<DataType>) -> &'static str {
    use DataType::*;
    match data_type {
        Some(Boolean) => "BOOL",
        Some(Integer8) => "SINT",
        Some(Integer16) => "INT",
        Some(Integer32) => "DINT",
        Some(Integer64) => "LINT",
        Some(Unsigned8) => "USINT",
        Some(Unsigned16) => "UINT",
        Some(Unsigned32) => "UDINT",
        Some(Unsigned64) => "ULINT",
        Some(Real32) => "REAL",
        Some(Real64) => "LREAL",
        Some(VisibleString) => "STRING",
        Some(UnicodeString) => "WSTRING",
        _ => "BITSTRING",
    }
}
