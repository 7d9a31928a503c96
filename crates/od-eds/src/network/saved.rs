//! The writes that configure a device by its DCF.

use alloc::collections::BTreeSet;
use alloc::vec::Vec;

use super::concise::Write;
use super::node::Node;
use super::write::Unfit;
use crate::subject::start_value;
use od_model::Address;

/// Returns the writes of all values that the DCF of a node sets (ParameterValue), in an order that
/// every node accepts: a PDO is not valid while its mapping changes.
///
/// # Errors
/// A value is invalid.
pub fn saved(node: &Node) -> Result<Vec<Write>, Unfit> {
    let mut writes = Vec::new();
    let mut pdos = BTreeSet::new();
    for (address, entry) in node.description.entries() {
        let Address { index, sub } = address;
        // Commands are not part of a configuration.
        let is_command = matches!(index, 0x1003 | 0x1010 | 0x1011 | 0x1F50..=0x1F5F);
        if entry.parameter.is_none() || !entry.access.writable() || is_command {
            continue;
        }
        match index {
            0x1400..=0x15FF | 0x1800..=0x19FF => drop(pdos.insert(index)),
            0x1600..=0x17FF | 0x1A00..=0x1BFF => drop(pdos.insert(index - 0x200)),
            _ => {
                let number = start_value(entry).and_then(|value| value.integer(node.id));
                if let Some(number) = number {
                    writes.push(node.write(index, sub, number)?);
                }
            }
        }
    }
    for index in pdos {
        pdo(node, index, &mut writes)?;
    }
    Ok(writes)
}

fn pdo(node: &Node, index: u16, writes: &mut Vec<Write>) -> Result<(), Unfit> {
    let mapping = index + 0x200;
    let is_writable = |index, sub| {
        let entry = node.description.entry(Address::new(index, sub));
        entry.is_some_and(|entry| entry.access.writable())
    };
    let cob_id = node.number(index, 1);
    if is_writable(index, 1) {
        writes.push(node.write(index, 1, (cob_id | 1 << 31).into())?);
    }
    for sub in node.members(index).into_iter().filter(|sub| *sub > 1) {
        if is_writable(index, sub) {
            writes.push(node.write(index, sub, node.number(index, sub).into())?);
        }
    }
    if is_writable(mapping, 0) {
        let count = node.number(mapping, 0);
        writes.push(node.write(mapping, 0, 0)?);
        for sub in node
            .members(mapping)
            .into_iter()
            .filter(|sub| u32::from(*sub) <= count)
        {
            if is_writable(mapping, sub) {
                writes.push(node.write(mapping, sub, node.number(mapping, sub).into())?);
            }
        }
        writes.push(node.write(mapping, 0, count.into())?);
    }
    if is_writable(index, 1) && cob_id >> 31 == 0 {
        writes.push(node.write(index, 1, cob_id.into())?);
    }
    Ok(())
}
