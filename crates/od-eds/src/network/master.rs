//! The master of a network in a project, and its own concise DCF (CiA 302-2).

use alloc::vec;
use alloc::vec::Vec;

use super::concise::Write;
use super::node::Node;
use super::write::Unfit;
use od_model::Address;

/// Settings of a project for its master.
#[derive(Clone, PartialEq, Debug)]
#[allow(missing_docs)] // the keys of dcfgen, which CiA 301 and CiA 302-2 explain
pub struct Master {
    pub node_id: u8,
    /// kbit/s.
    pub bit_rate: u32,
    /// Vendor-ID, product code, revision number and serial number.
    pub identity: [u32; 4],
    /// Microseconds.
    pub sync_period: u32,
    pub sync_window: u32,
    pub sync_overflow: u32,
    pub time_cob_id: u32,
    pub emcy_inhibit_time: u32,
    pub heartbeat_multiplier: f64,
    /// Whether it watches the heartbeats of the nodes.
    pub consumes_heartbeat: bool,
    /// Milliseconds.
    pub heartbeat_producer: u32,
    pub error_behavior: Vec<(u8, u32)>,
    pub nmt_inhibit_time: u32,
    /// Bits of 1F80h without bit 0.
    pub startup: u32,
    pub boot_time: u32,
}

impl Default for Master {
    fn default() -> Self {
        Self {
            node_id: 255,
            bit_rate: 1000,
            identity: [0; 4],
            sync_period: 0,
            sync_window: 0,
            sync_overflow: 0,
            time_cob_id: 0x100,
            emcy_inhibit_time: 0,
            heartbeat_multiplier: 3.0,
            consumes_heartbeat: true,
            heartbeat_producer: 0,
            error_behavior: vec![(1, 0)],
            nmt_inhibit_time: 0,
            startup: 0,
            boot_time: 0,
        }
    }
}

/// Inserts the writes of 1016h before those of a node: to watch the master, or not to.
///
/// # Errors
/// A value is invalid.
pub fn consume_heartbeat(master: &Master, node: &mut Node) -> Result<(), Unfit> {
    let time = (f64::from(master.heartbeat_producer) * master.heartbeat_multiplier) as u32;
    let entries = node.members(0x1016).into_iter();
    let entries: Vec<_> = entries.map(|sub| (sub, node.number(0x1016, sub))).collect();
    let id = |value: u32| value >> 16 & 0xFF;
    let is_master = |value: u32| id(value) == u32::from(master.node_id);
    if node.consumes_heartbeat && time > 0 {
        let own = entries.iter().find(|(_, value)| is_master(*value));
        let is_free = |value: u32| value & 0xFFFF == 0 || !(1..=127).contains(&id(value));
        let free = entries.iter().find(|(_, value)| is_free(*value));
        if let Some((sub, _)) = own.or(free) {
            let value = u32::from(master.node_id) << 16 | time & 0xFFFF;
            let write = node.write(0x1016, *sub, value.into())?;
            node.writes.insert(0, write);
        }
        return Ok(());
    }
    for (sub, value) in entries {
        if value & 0xFFFF != 0 && is_master(value) {
            let write = node.write(0x1016, sub, (id(value) << 16).into())?;
            node.writes.insert(0, write);
        }
    }
    Ok(())
}

/// The writes of `master.bin`: identities, which a DCF for many masters cannot contain.
pub fn writes(master: &Master, nodes: &[Node]) -> Vec<Write> {
    let number = |index, sub, number: u32| Write {
        address: Address::new(index, sub),
        data: number.to_le_bytes().to_vec(),
    };
    let mut writes = Vec::new();
    if master.identity[3] != 0 {
        writes.push(number(0x1018, 4, master.identity[3]));
    }
    for node in nodes {
        let has = |sub| node.has_entry(0x1018, sub);
        for (index, value, is_expected) in [
            (0x1F55, node.software.1, true),
            (0x1F87, node.revision_number, has(3)),
            (0x1F88, node.serial_number, has(4)),
        ] {
            if value != 0 && is_expected {
                writes.push(number(index, node.id, value));
            }
        }
    }
    writes
}
