//! Rules about content that an object dictionary of CANopenNode cannot express.

use alloc::vec::Vec;

use super::node_id;
use super::plan::Planned;
use crate::description::{Description, Value};
use crate::finding::{Finding, sort};
use crate::rules::convert::{
    i1106_limits_not_checked, i1107_needed_object_missing, i1108_single_bits_on_request,
    w1101_no_storage, w1102_node_id_not_added, w1103_node_id_added, w1104_gap, w1104_many,
    w1105_object_without_row, w1109_cannot_start,
};
use crate::subject::{start_number, start_value};
use od_model::Address;

/// The findings, in file order.
pub(super) fn findings(
    description: &Description,
    objects: &[Planned],
    node: Option<u8>,
) -> Vec<Finding> {
    let mut found = Vec::new();
    let mut limited = 0;
    for (address, entry) in description.entries() {
        if address.index == 0 || address.sub == 255 && is_full(description, address.index) {
            found.push(w1105_object_without_row(address, entry.span));
        }
        limited += usize::from(entry.low.is_some() || entry.high.is_some());
        let Some(value) = start_value(entry) else {
            continue;
        };
        let is_added = |number: i128| node_id::is_added(address, number);
        found.extend(match value.value {
            Value::NodeId(offset) if node.is_none() && !is_added(offset.into()) => {
                Some(w1102_node_id_not_added(address, value.span))
            }
            // 1200h is always the default SDO server.
            Value::Unsigned(id) if address.index != 0x1200 && is_added(id.into()) => {
                Some(w1103_node_id_added(address, value.span, id as u32 & 0x7FF))
            }
            _ => None,
        });
    }
    for object in objects {
        for member in &object.members {
            let address = Address::new(object.index, member.sub);
            let Some(entry) = description.entry(address) else {
                continue;
            };
            if let (None, Some(data_type)) = (&member.data.first, entry.data_type) {
                found.push(w1101_no_storage(address, entry.span, *data_type));
            }
        }
    }
    pdos(description, objects, &mut found);
    let has = |index| objects.iter().any(|object| object.index == index);
    let always = [0x1001, 0x1017].into_iter().filter(|index| !has(*index));
    found.extend(always.map(w1109_cannot_start));
    let needed = [0x1003, 0x1006, 0x1014, 0x1016].into_iter();
    let mut missing = needed.filter(|index| !has(*index) && (*index != 0x1006 || has(0x1005)));
    if let Some(first) = missing.next() {
        found.push(i1107_needed_object_missing(
            core::iter::once(first).chain(missing),
        ));
    }
    if limited > 0 {
        found.push(i1106_limits_not_checked(limited));
    }
    sort(&mut found);
    found
}

/// Returns whether the object has all 256 sub-indices.
fn is_full(description: &Description, index: u16) -> bool {
    let object = description.objects.get(&index);
    object.is_some_and(|object| object.entries.len() > usize::from(u8::MAX))
}

fn pdos(description: &Description, objects: &[Planned], found: &mut Vec<Finding>) {
    for (communication, mapping) in [(0x1400, 0x1600), (0x1800, 0x1A00)] {
        let has = |index| objects.iter().any(|object| object.index == index);
        let last = (0..0x200).rev();
        let mut last = last.filter(|pdo| has(communication + pdo) || has(mapping + pdo));
        for pdo in 0..last.next().map_or(0, |last| last + 1) {
            let pair = [communication + pdo, mapping + pdo].into_iter();
            found.extend(pair.filter(|index| !has(*index)).map(w1104_gap));
            entries(description, mapping + pdo, found);
        }
    }
}

fn entries(description: &Description, mapping: u16, found: &mut Vec<Finding>) {
    let number = |sub| start_number(description, Address::new(mapping, sub));
    let Some(count) = number(0) else { return };
    if *count > 8 {
        found.push(w1104_many(
            Address::new(mapping, 0),
            count.span,
            (*count).into(),
        ));
    }
    for sub in 1..=u8::try_from((*count).min(64)).unwrap_or(0) {
        if let Some(entry) = number(sub).filter(|entry| entry.value & 7 != 0) {
            let address = Address::new(mapping, sub);
            found.push(i1108_single_bits_on_request(
                address,
                entry.span,
                entry.value as u8,
            ));
        }
    }
}
