//! The objects of a description in the types of CANopenNode: variables, arrays, records.

use alloc::collections::BTreeSet;
use alloc::format;
use alloc::string::{String, ToString};
use alloc::vec::Vec;

use super::data::{Data, data};
use super::{names, node_id};
use crate::description::{Description, EntryDescription, ObjectDescription};
use crate::read::fields;
use od_model::{Address, Group, ObjectCode};

/// One of the three types of an object (`OD_objectTypes_t`).
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) enum Shape {
    Var,
    Array,
    Record,
}

/// A value of an object.
#[derive(Debug)]
pub(super) struct Member {
    pub(super) sub: u8,
    /// Its name in the struct of a record.
    pub(super) name: String,
    /// `ODA_SDO_RW | ODA_TPDO | ODA_MB`.
    pub(super) attribute: String,
    pub(super) data: Data,
}

/// An object.
#[derive(Debug)]
pub(super) struct Planned {
    pub(super) index: u16,
    /// `2000_name`.
    pub(super) name: String,
    /// The storage group: `RAM`, `PERSIST_COMM`.
    pub(super) group: &'static str,
    pub(super) shape: Shape,
    pub(super) members: Vec<Member>,
}

impl Planned {
    /// The elements of an array, without sub-index 0.
    pub(super) fn elements(&self) -> &[Member] {
        self.members.get(1..).unwrap_or_default()
    }

    /// The variable of a member, with the name of the dictionary: `RAM.x2000_name`.
    pub(super) fn pointer(&self, dictionary: &str, member: &Member) -> String {
        let Planned { name, group, .. } = self;
        let to_first = member.data.to_first();
        match (self.shape, member.sub) {
            _ if member.data.first.is_none() => "NULL".into(),
            (Shape::Var, _) => format!("&{dictionary}_{group}.x{name}{to_first}"),
            (Shape::Array, 0) => format!("&{dictionary}_{group}.x{name}_sub0"),
            (Shape::Array, _) => format!("&{dictionary}_{group}.x{name}[0]{to_first}"),
            (Shape::Record, _) => {
                format!("&{dictionary}_{group}.x{name}.{}{to_first}", member.name)
            }
        }
    }
}

/// The objects for a dictionary of CANopenNode, in order; `node` is the node ID of the device if
/// the dictionary is for one device only.
pub(super) fn plan(description: &Description, node: Option<u8>) -> Vec<Planned> {
    let objects = description.objects.iter();
    // A row with index 0 marks the end of the list.
    let objects = objects.filter(|(index, _)| **index != 0);
    let planned = objects.map(|(index, object)| planned(*index, object, node));
    planned
        .filter(|object| !object.members.is_empty())
        .collect()
}

fn planned(index: u16, object: &ObjectDescription, node: Option<u8>) -> Planned {
    let mut taken = BTreeSet::new();
    let entries = object.entries.iter();
    // Sub-entries are counted in 8 bits.
    let entries = entries.take(usize::from(u8::MAX));
    let members = entries.filter_map(|(&sub, entry)| {
        let data = data(
            entry,
            node_id::number(Address::new(index, sub), entry, node),
        )?;
        Some(Member {
            sub,
            name: names::member(&mut taken, &entry.name, sub),
            attribute: attribute(entry, &data),
            data,
        })
    });
    let members: Vec<Member> = members.collect();
    let shape = match *object.code {
        code if !code.has_members() => Shape::Var,
        _ if is_array(index, *object.code) && is_uniform(&members) => Shape::Array,
        _ => Shape::Record,
    };
    Planned {
        index,
        name: format!("{index:04X}_{}", names::c_name(&object.name)),
        group: fields::location(group(index, object)),
        shape,
        members,
    }
}

/// The storage group of an object: that of its first saved value.
fn group(index: u16, object: &ObjectDescription) -> Group {
    let groups = object.entries.iter().map(|(&sub, entry)| {
        let mut entry = entry.clone();
        // CANopenEditor writes the group of a record at the record, and RAM at all its members.
        if (0x1000..0x2000).contains(&index) && object.code.has_members() {
            entry.group = entry.group.filter(|group| **group != Group::None);
        }
        entry.group_at(Address::new(index, sub))
    });
    groups
        .into_iter()
        .find(|group| *group != Group::None)
        .unwrap_or(Group::None)
}

/// Returns whether it is an array, or an object that CANopenNode expects to be one.
pub(super) fn is_array(index: u16, code: ObjectCode) -> bool {
    code == ObjectCode::Array || matches!(index, 0x1003 | 0x1010 | 0x1011 | 0x1016)
}

/// Returns whether the members can be a C array. Otherwise they are a record, which looks the same to a master.
fn is_uniform(members: &[Member]) -> bool {
    let [first, elements @ ..] = members else {
        return false;
    };
    let Some(one) = elements.first() else {
        return false;
    };
    let in_turn = (0..=u8::MAX)
        .zip(members)
        .all(|(sub, member)| member.sub == sub);
    let alike = |other: &Member| {
        other.attribute == one.attribute
            && (other.data.c_type, other.data.elements, other.data.length)
                == (one.data.c_type, one.data.elements, one.data.length)
    };
    in_turn
        && first.data.c_type == "uint8_t"
        && first.data.length == 1
        && elements.iter().all(alike)
}

fn attribute(entry: &EntryDescription, data: &Data) -> String {
    let access = *entry.access;
    let sdo = match (access.readable(), access.writable()) {
        (true, true) => "ODA_SDO_RW",
        (false, _) => "ODA_SDO_W",
        (true, false) => "ODA_SDO_R",
    };
    let mappable = *entry.mappable;
    let pdo = match (
        mappable && access.maps_to_tpdo(),
        mappable && access.maps_to_rpdo(),
    ) {
        (true, true) => " | ODA_TRPDO",
        (true, false) => " | ODA_TPDO",
        (false, true) => " | ODA_RPDO",
        (false, false) => "",
    };
    sdo.to_string() + pdo + data.attributes
}
