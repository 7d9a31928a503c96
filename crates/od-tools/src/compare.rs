//! Compares a dictionary with a device on a bus: its objects and their values.

use od_eds::diff::{Difference, Field, Impact};
use od_model::values;
use od_model::{Access, Address, Dictionary, Entry, Object};
use od_wire::{AbortCode, AbortReason, NodeId};

use crate::error::Error;
use crate::link::Link;
use crate::master::Master;

/// Reads every object of the dictionary that can be read. A transfer in which the device violates the protocol is a
/// difference, too. Other objects of the device are not reported as
/// added, since finding them takes a request for each of 65,536 indices.
///
/// With `values` current values that differ from the defaults are differences, too.
///
/// # Errors
/// The link is lost, or the node does not respond to any request.
pub fn compare(
    dictionary: Dictionary<'_>,
    client: &mut Master<impl Link>,
    values: bool,
) -> Result<Vec<Difference>, Error> {
    let node = client.node();
    client.know(dictionary);
    let mut found = Vec::new();
    for object in dictionary.objects() {
        for entry in dictionary.members(&object) {
            if !entry.access.readable() {
                continue;
            }
            let read = match client.upload(entry.address) {
                Err(Error::Node(why)) if !client.is_alive()? => return Err(Error::Node(why)),
                Err(Error::Node(why) | Error::Protocol(why)) => {
                    let access = entry.access.name().into();
                    let what = (Field::Transfer, access, why, Impact::Breaking);
                    found.push(at(dictionary, &object, entry.address, what));
                    continue;
                }
                read => Error::or_abort(read)?,
            };
            let (field, before, after, impact) = match read {
                Ok(bytes) => match value(dictionary, &entry, &bytes, (node, values)) {
                    Some(difference) => difference,
                    None => continue,
                },
                Err(code) if code == AbortCode::NoObject.code() => {
                    let has = format!("{} {}", object.code.name(), entry.data_type.name());
                    found.push(at(
                        dictionary,
                        &object,
                        entry.address,
                        (Field::ObjectRemoved, has, String::new(), Impact::Breaking),
                    ));
                    break;
                }
                Err(code) if code == AbortCode::NoSubIndex.code() => (
                    Field::EntryRemoved,
                    format!("{} {}", entry.data_type.name(), entry.access.name()),
                    String::new(),
                    Impact::Breaking,
                ),
                Err(code) if code == AbortCode::WriteOnly.code() => (
                    Field::Access,
                    entry.access.name().into(),
                    Access::Wo.name().into(),
                    Impact::Breaking,
                ),
                // An empty error history, or a value that is not available now, says nothing
                // about the object.
                Err(code) if code == AbortCode::NoData.code() => continue,
                Err(code) => (
                    Field::Access,
                    entry.access.name().into(),
                    format!("abort {}", AbortReason(code)),
                    Impact::Breaking,
                ),
            };
            found.push(at(
                dictionary,
                &object,
                entry.address,
                (field, before, after, impact),
            ));
        }
    }
    Ok(found)
}

type What = (Field, String, String, Impact);

fn at(dictionary: Dictionary<'_>, object: &Object, address: Address, what: What) -> Difference {
    let (field, before, after, impact) = what;
    let whole = field == Field::ObjectRemoved || !object.code.has_members();
    let name = match dictionary.find(address) {
        Ok(entry) if field != Field::ObjectRemoved => entry.name,
        _ => object.name,
    };
    Difference {
        index: address.index,
        sub: (!whole).then_some(address.sub),
        name: dictionary.text(name).into(),
        field,
        before,
        after,
        impact,
    }
}

/// Compares the length of a value, and the value itself if it should not change.
fn value(
    dictionary: Dictionary<'_>,
    entry: &Entry,
    bytes: &[u8],
    (node, all): (NodeId, bool),
) -> Option<What> {
    let data_type = entry.data_type;
    if data_type.size().is_some_and(|size| size != bytes.len()) {
        return Some((
            Field::DataType,
            data_type.name().into(),
            format!("{} bytes: {}", bytes.len(), values::hex(bytes)),
            Impact::Breaking,
        ));
    }
    let default = default_bytes(dictionary, entry, node)?;
    // Serial numbers differ between devices; a value that a master can write, or that the device
    // measures, may differ, too.
    let is_fixed = match (entry.address.index, entry.address.sub) {
        (0x1000, 0) | (0x1018, 0..=3) | (0x1008..=0x100A, 0) => true,
        _ => entry.access == Access::Const,
    };
    if default == bytes || !(is_fixed || all) {
        return None;
    }
    let breaks = matches!(
        (entry.address.index, entry.address.sub),
        (0x1000, 0) | (0x1018, 1 | 2)
    );
    Some((
        Field::Default,
        values::show(data_type, &default),
        values::show(data_type, bytes),
        if breaks {
            Impact::Breaking
        } else {
            Impact::Compatible
        },
    ))
}

/// The default value as bytes on the bus; `None` if the dictionary has none.
fn default_bytes(dictionary: Dictionary<'_>, entry: &Entry, node: NodeId) -> Option<Vec<u8>> {
    if let Some(number) = entry.default.integer(node.raw()) {
        let size = entry.data_type.size()?;
        return Some(number.to_le_bytes().get(..size)?.to_vec());
    }
    let bytes = dictionary.literal_bytes(entry.default);
    (!bytes.is_empty()).then(|| bytes.to_vec())
}
