//! The PDOs of a master: it receives each TPDO of the nodes, and sends each of their RPDOs.

use alloc::format;
use alloc::string::String;
use alloc::vec;
use alloc::vec::Vec;

use super::node::Node;
use super::objects::{array, members, unsigned, value, var};
use crate::description::Description;
use crate::identifiers::{MappedValue, mapping};
use crate::span::Spanned;
use od_model::{Access, Address, DataType, ObjectCode};

/// A PDO of a node that the master takes part in.
pub(super) struct Pdo {
    /// Position of the node.
    node: usize,
    /// Its number in the node, from 1.
    number: u16,
    cob_id: u32,
    /// Transmission type, inhibit time, event timer, SYNC start value.
    parameters: [u32; 4],
    mapped: Vec<(MappedValue, DataType, String)>,
}

pub(super) fn pdos(nodes: &[Node], first: u16) -> Vec<Pdo> {
    let mut found = Vec::new();
    for (at, node) in nodes.iter().enumerate() {
        for (&index, _) in node.description.objects.range(first..first + 0x200) {
            let mapped = mapping(&node.description, index + 0x200).unwrap_or_default();
            let mapped: Vec<_> = mapped
                .into_iter()
                .filter_map(|value| {
                    let entry = node.description.entry(value.address);
                    let dummy = DataType::from_code(value.address.index);
                    let data_type = value.data_type(&node.description).or(dummy)?;
                    let name =
                        entry.map_or(data_type.name().into(), |entry| entry.name.value.clone());
                    Some((value, data_type, name))
                })
                .collect();
            let own = if node.has_entry(index, 1) {
                node.number(index, 1)
            } else {
                1 << 31
            };
            let partner = node.partners.get(&index).copied();
            let [inhibit_time, event_timer, sync_start, cob_id] = partner.unwrap_or([0, 0, 0, own]);
            if cob_id >> 31 == 0 && !mapped.is_empty() {
                let transmission = node.number(index, 2);
                let parameters = [transmission, inhibit_time, event_timer, sync_start];
                found.push(Pdo {
                    node: at,
                    number: index - first + 1,
                    cob_id,
                    parameters,
                    mapped,
                });
            }
        }
    }
    found
}

/// Adds the PDOs of the nodes as the master of Lely core reads them: for each one a VAR with its
/// number and node ID, and an ARRAY with its mapping in the node. `first` is the index of the first
/// VAR.
pub(super) fn remote(made: &mut Description, nodes: &[Node], pdos: &[Pdo], first: u16, what: &str) {
    use DataType::Unsigned32;
    for (at, pdo) in (0_u16..512).zip(pdos) {
        let id = u32::from(pdo.number) << 8 | u32::from(nodes[pdo.node].id);
        let name = format!("Remote {what} number and node-ID");
        let entry = value(name, Unsigned32, Access::Rw, unsigned(id));
        var(made, first + at, entry);
        let mapped = (1..).zip(&pdo.mapped).map(|(sub, (mapped, data_type, _))| {
            let Address { index, sub: of } = mapped.address;
            let bits = u32::from(data_type.bits().unwrap_or(0));
            (sub, u32::from(index) << 16 | u32::from(of) << 8 | bits)
        });
        let mapped: Vec<(u8, u32)> = mapped.collect();
        let name = format!("Remote {what} mapping parameter");
        array(
            made,
            first + 0x200 + at,
            (&name, Unsigned32, Access::Rw),
            (mapped.len() as u8, 0),
            &mapped,
        );
    }
}

/// Adds the PDOs, and for each PDO an object with a sub-object for each value of the node.
pub(super) fn applications(
    made: &mut Description,
    nodes: &[Node],
    pdos: &[Pdo],
    (first, application): (u16, u16),
    what: &str,
    access: Access,
) {
    use DataType::{Unsigned8, Unsigned16, Unsigned32};
    // A value in two PDOs of a node is one object.
    let mut known: Vec<((usize, Address), u32)> = Vec::new();
    for (number, pdo) in (0_u16..512).zip(pdos) {
        let [transmission, inhibit_time, event_timer, sync_start] = pdo.parameters;
        let is_tpdo = what == "TPDO";
        let mut parameters = vec![
            ("COB-ID", Unsigned32, unsigned(pdo.cob_id)),
            ("Transmission type", Unsigned8, unsigned(transmission)),
            (
                "Inhibit time",
                Unsigned16,
                unsigned(inhibit_time).filter(|_| is_tpdo),
            ),
            ("Reserved", Unsigned8, None),
            ("Event timer", Unsigned16, unsigned(event_timer)),
        ];
        if is_tpdo {
            parameters.push(("SYNC start value", Unsigned8, unsigned(sync_start)));
        }
        let count = parameters.len() as u32;
        let parameters = parameters
            .into_iter()
            .map(|(name, data_type, default)| value(name, data_type, Access::Rw, default));
        let name = format!("{what} communication parameter");
        members(
            made,
            first + number,
            (&name, ObjectCode::Record),
            count,
            (1..).zip(parameters),
        );
        let mut own = Vec::new();
        let mut entries = Vec::new();
        for (mapped, data_type, name) in &pdo.mapped {
            let key = (pdo.node, mapped.address);
            let bits = u32::from(data_type.bits().unwrap_or(0));
            let entry = match known.iter().find(|(known, _)| *known == key) {
                Some((_, entry)) => *entry,
                None => {
                    let title = format!("{}: {name}", nodes[pdo.node].name);
                    let mut member = value(title, *data_type, access, None);
                    member.mappable = Spanned::from(true);
                    own.push(member);
                    let index = u32::from(application + number);
                    let entry = index << 16 | (own.len() as u32) << 8 | bits;
                    known.push((key, entry));
                    entry
                }
            };
            let mut line = value("Mapped object", Unsigned32, Access::Rw, None);
            line.parameter = unsigned(entry).map(Spanned::from);
            entries.push(line);
        }
        let name = format!("{what} mapping parameter");
        let count = entries.len() as u32;
        members(
            made,
            first + 0x200 + number,
            (&name, ObjectCode::Record),
            count,
            (1..).zip(entries),
        );
        if !own.is_empty() {
            let name = format!("Mapped application objects for {what} {}", number + 1);
            let count = own.len() as u32;
            members(
                made,
                application + number,
                (&name, ObjectCode::Record),
                count,
                (1..).zip(own),
            );
        }
    }
}
