//! The configuration of one PDO.

use alloc::format;
use alloc::string::String;
use alloc::vec::Vec;

use od_model::Address;

use super::concise::Write;
use super::node::Node;
use super::write::Unfit;

/// A PDO that is not valid (bit 31 of its COB-ID).
const INVALID: u32 = 1 << 31;

/// Appends the writes of a PDO; `next` is the next CAN-ID for PDOs without a pre-defined one.
///
/// # Errors
/// An object is missing or a value is invalid.
pub(super) fn configure(
    node: &mut Node,
    index: u16,
    wanted: &PdoConfiguration,
    next: &mut u32,
) -> Result<(), Unfit> {
    let is_tpdo = index >= 0x1800;
    let count = node.number(index, 0);
    let given = |sub: u8| {
        if count >= u32::from(sub) {
            node.number(index, sub)
        } else {
            0
        }
    };
    let has_cob_id = count >= 1 && node.has_entry(index, 1);
    let before = if has_cob_id {
        node.number(index, 1)
    } else {
        INVALID
    };
    let cob_id = match wanted.cob_id {
        None => before,
        Some(Some(cob_id)) => cob_id,
        Some(None) => automatic(node, index, next)?,
    };
    let mut writes = Vec::new();
    let mut partners = None;
    let mut write = |index: u16, sub: u8, number: u32| {
        writes.push(node.write(index, sub, number.into())?);
        Ok::<(), Unfit>(())
    };
    if before != cob_id | INVALID {
        write(index, 1, cob_id | INVALID)?;
    }
    if cob_id & INVALID == 0 {
        for (sub, number, is_here) in [
            (2, wanted.transmission, true),
            (3, wanted.inhibit_time, is_tpdo),
            (5, wanted.event_timer, is_tpdo),
        ] {
            let before = if sub == 2 || is_here { given(sub) } else { 0 };
            if let Some(number) = number.filter(|number| is_here && *number != before) {
                write(index, sub, number)?;
            }
        }
        if let Some(deadline) = wanted.event_deadline
            && !is_tpdo
            && deadline != given(5)
        {
            // dcfgen writes the event timer if both are given.
            write(index, 5, wanted.event_timer.unwrap_or(deadline))?;
        }
        if let Some(start) = wanted
            .sync_start
            .filter(|start| is_tpdo && *start != given(6))
        {
            write(index, 6, start)?;
        }
        let partner = if is_tpdo {
            [None, wanted.event_deadline, None, Some(cob_id)]
        } else {
            [
                wanted.inhibit_time,
                wanted.event_timer,
                wanted.sync_start,
                Some(cob_id),
            ]
        };
        partners = Some(partner.map(|number| number.unwrap_or(0)));
        if let Some(mapping) = &wanted.mapping {
            map(node, index + 0x200, mapping, &mut writes)?;
        }
        if wanted.enabled {
            writes.push(node.write(index, 1, cob_id.into())?);
        }
    }
    node.writes.extend(writes);
    node.partners
        .extend(partners.map(|partner| (index, partner)));
    Ok(())
}

/// The CAN-ID of the pre-defined connection set, or the next free one.
fn automatic(node: &Node, index: u16, next: &mut u32) -> Result<u32, Unfit> {
    let pdo = u32::from(index & 0x1FF);
    let first = if index >= 0x1800 { 0x180 } else { 0x200 };
    if pdo < 4 {
        return Ok(first + 0x100 * pdo + u32::from(node.id));
    }
    if *next >= 0x6E0 {
        let why = format!("no CAN-ID is left for {index:04X}h");
        return Err(Unfit::new(node, index, 1, why));
    }
    *next += 1;
    Ok(*next - 1)
}

fn map(node: &Node, index: u16, mapping: &[Address], writes: &mut Vec<Write>) -> Result<(), Unfit> {
    if node.number(index, 0) > 0 || !mapping.is_empty() {
        writes.push(node.write(index, 0, 0)?);
    }
    for (at, address) in mapping.iter().enumerate() {
        writes.push(entry(node, index, at, *address)?);
    }
    if !mapping.is_empty() {
        writes.push(node.write(index, 0, mapping.len() as i128)?);
    }
    Ok(())
}

/// The write of a mapping entry, counted from 0.
fn entry(node: &Node, index: u16, at: usize, address: Address) -> Result<Write, Unfit> {
    let sub = u8::try_from(at + 1).unwrap_or(u8::MAX);
    let unfit = |why: String| Unfit::new(node, index, sub, why);
    if at >= 64 {
        return Err(unfit("a PDO has at most 64 objects".into()));
    }
    let entry = node.description.entry(address);
    let entry = entry.ok_or_else(|| unfit(format!("object {address} does not exist")))?;
    let bits = entry.data_type.and_then(|data_type| data_type.bits());
    let bits = bits.ok_or_else(|| unfit(format!("{address} cannot be mapped")))?;
    let number = u32::from(address.index) << 16 | u32::from(address.sub) << 8 | u32::from(bits);
    node.write(index, sub, number.into())
}

/// Settings of one PDO in a project; `None` leaves the value of the device.
#[derive(Clone, PartialEq, Debug, Default)]
#[allow(missing_docs)] // the names of CiA 301
pub struct PdoConfiguration {
    /// `Some(None)`: it is chosen automatically.
    pub cob_id: Option<Option<u32>>,
    pub transmission: Option<u32>,
    pub inhibit_time: Option<u32>,
    pub event_timer: Option<u32>,
    /// The event timer of an RPDO.
    pub event_deadline: Option<u32>,
    pub sync_start: Option<u32>,
    pub mapping: Option<Vec<Address>>,
    /// Whether the PDO is valid after the configuration.
    pub enabled: bool,
}
