//! Data types: those of IEC 61131-3, which CiA 311 uses, and those that a file defines.

use roxmltree::Node;

use crate::xdd::source::{Ids, children};
use od_model::DataType;

/// The type of an element.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) enum Found {
    Type(DataType),
    /// Bytes: an OCTET_STRING if the element has a value, otherwise a DOMAIN.
    Bits,
}

/// Types may refer to types; this limit ends a circle of references.
const DEEPEST: u8 = 8;

/// The type in a child of the element; references to types of the file are followed.
pub(super) fn of(node: Node<'_, '_>, ids: &Ids<'_, '_>) -> Option<Found> {
    within(node, ids, DEEPEST)
}

fn within(node: Node<'_, '_>, ids: &Ids<'_, '_>, depth: u8) -> Option<Found> {
    let depth = depth.checked_sub(1)?;
    for child in node.children().filter(Node::is_element) {
        let name = child.tag_name().name();
        if let Some(found) = elementary(name) {
            return Some(found);
        }
        match name {
            "dataTypeIDRef" => {
                let target = ids.get(child.attribute("uniqueIDRef")?)?;
                return within(target, ids, depth);
            }
            "baseType" => return within(child, ids, depth),
            _ => {}
        }
    }
    None
}

/// The members of a struct, in order; for an array its type.
pub(super) fn member(parameter: Node<'_, '_>, sub: u8, ids: &Ids<'_, '_>) -> Option<Found> {
    let reference = children(parameter, "dataTypeIDRef").next()?;
    let target = ids.get(reference.attribute("uniqueIDRef")?)?;
    match target.tag_name().name() {
        // An array has values of its type from sub-index 1.
        "array" if sub > 0 => of(target, ids),
        "array" => Some(Found::Type(DataType::Unsigned8)),
        "struct" => {
            let declared = children(target, "varDeclaration").nth(usize::from(sub))?;
            of(declared, ids)
        }
        _ => None,
    }
}

fn elementary(name: &str) -> Option<Found> {
    use DataType::*;
    Some(Found::Type(match name {
        "BOOL" => Boolean,
        "SINT" | "CHAR" => Integer8,
        "INT" => Integer16,
        "DINT" => Integer32,
        "LINT" => Integer64,
        "USINT" | "BYTE" => Unsigned8,
        "UINT" | "WORD" => Unsigned16,
        "UDINT" | "DWORD" => Unsigned32,
        "ULINT" | "LWORD" => Unsigned64,
        "REAL" => Real32,
        "LREAL" => Real64,
        "STRING" => VisibleString,
        "WSTRING" => UnicodeString,
        "BITSTRING" => return Some(Found::Bits),
        _ => return None,
    }))
}
