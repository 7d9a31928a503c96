//! Turns the settings of a project for a node into the writes that configure it.

use alloc::format;
use alloc::string::String;
use alloc::vec::Vec;

use super::node::Node;
use super::pdo;
use super::pdo::PdoConfiguration;
use super::write::Unfit;
use od_model::Address;

/// Settings of a project for all nodes.
#[derive(Clone, PartialEq, Debug)]
pub struct ProjectSettings {
    /// Folder of the concise DCFs on the master; empty: the folder of the master's files.
    pub dcf_path: String,
    /// Factor between the heartbeat time and the consumer time.
    pub heartbeat_multiplier: f64,
    /// Attempts of an SDO (1F81h).
    pub retry_factor: u32,
    /// Next CAN-ID for PDOs without a pre-defined one.
    pub next: u32,
}

impl Default for ProjectSettings {
    fn default() -> Self {
        Self {
            dcf_path: String::new(),
            heartbeat_multiplier: 3.0,
            retry_factor: 3,
            next: 0x680,
        }
    }
}

/// Settings of a project for one node; `None` leaves the value of the device.
#[derive(Clone, PartialEq, Debug, Default)]
#[allow(missing_docs)] // the keys of dcfgen, which CiA 301 and CiA 302-2 explain
pub struct Configuration {
    pub dcf_path: Option<String>,
    pub revision_number: Option<u32>,
    pub serial_number: Option<u32>,
    pub time_cob_id: Option<u32>,
    pub heartbeat_multiplier: Option<f64>,
    pub heartbeat_consumer: bool,
    pub heartbeat_producer: Option<u32>,
    pub retry_factor: Option<u32>,
    pub guard_time: Option<u32>,
    pub life_time_factor: Option<u32>,
    /// Sub-indices of 1029h with their values.
    pub error_behavior: Vec<(u8, u32)>,
    /// PDOs from 1 on, in the order of the project.
    pub rpdo: Vec<(u16, PdoConfiguration)>,
    pub tpdo: Vec<(u16, PdoConfiguration)>,
    /// Bits 2, 3 and 4 of 1F81h, the last one inverted; `None`: the default.
    pub boot: Option<bool>,
    pub mandatory: Option<bool>,
    pub reset_communication: Option<bool>,
    pub software_file: String,
    pub software_version: u32,
    pub restore_configuration: u8,
    /// Further writes.
    pub sdo: Vec<(Address, i128)>,
}

/// Makes the writes of a node.
///
/// # Errors
/// An object is missing or a value is invalid.
pub fn configure(
    node: &mut Node,
    wanted: &Configuration,
    settings: &mut ProjectSettings,
) -> Result<(), Unfit> {
    node.revision_number = wanted
        .revision_number
        .unwrap_or_else(|| node.identity("RevisionNumber", 3));
    let commissioned = node
        .description
        .commissioning()
        .and_then(|own| own.serial_number);
    let serial = wanted.serial_number.or(commissioned);
    node.serial_number = serial.unwrap_or_else(|| node.number(0x1018, 4));
    node.heartbeat_multiplier = wanted
        .heartbeat_multiplier
        .unwrap_or(settings.heartbeat_multiplier);
    node.consumes_heartbeat = wanted.heartbeat_consumer;
    for (index, number) in [
        (0x1012, wanted.time_cob_id),
        (0x1017, wanted.heartbeat_producer),
        (0x100C, wanted.guard_time),
        (0x100D, wanted.life_time_factor),
    ] {
        let before = match index {
            // dcfgen writes a COB-ID that differs from the default, whatever the file contains.
            0x1012 => 0x100,
            index => node.number(index, 0),
        };
        if let Some(number) = number.filter(|number| node.has(index) && *number != before) {
            node.writes.push(node.write(index, 0, number.into())?);
        }
    }
    for &(sub, number) in &wanted.error_behavior {
        if sub > 0 && node.has_entry(0x1029, sub) && node.number(0x1029, sub) != number {
            node.writes.push(node.write(0x1029, sub, number.into())?);
        }
    }
    for (first, wanted) in [(0x1400, &wanted.rpdo), (0x1800, &wanted.tpdo)] {
        for &(number, ref pdo) in wanted {
            let index = first + (number - 1).min(0x1FF);
            if !node.has(index) {
                let why = format!("object {index:04X}h does not exist");
                return Err(Unfit::new(node, index, 0, why));
            }
            pdo::configure(node, index, pdo, &mut settings.next)?;
        }
    }
    for &(address, number) in &wanted.sdo {
        node.writes
            .push(node.write(address.index, address.sub, number)?);
    }
    node.software = (
        wanted.software_file.clone(),
        wanted.software_version,
        wanted.restore_configuration,
    );
    node.assignment = assignment(node, wanted, settings);
    if !node.writes.is_empty() {
        let folder = wanted.dcf_path.as_ref().unwrap_or(&settings.dcf_path);
        let separator = if folder.is_empty() || folder.ends_with('/') {
            ""
        } else {
            "/"
        };
        node.configuration_file = format!("{folder}{separator}{}.bin", node.name);
    }
    Ok(())
}

/// The entry of 1F81h (CiA 302-2, NMT slave assignment).
fn assignment(node: &Node, wanted: &Configuration, settings: &ProjectSettings) -> u32 {
    let effective = |index, wanted: Option<u32>| wanted.unwrap_or_else(|| node.number(index, 0));
    let guard_time = effective(0x100C, wanted.guard_time);
    let guards = guard_time != 0
        && !(effective(0x100D, wanted.life_time_factor) != 0
            && effective(0x1017, wanted.heartbeat_producer) != 0);
    let bits = [
        (true, 0),
        (wanted.boot.unwrap_or(true), 2),
        (wanted.mandatory.unwrap_or(false), 3),
        (!wanted.reset_communication.unwrap_or(true), 4),
        (wanted.software_version != 0, 5),
        (!wanted.software_file.is_empty(), 6),
        (wanted.restore_configuration != 0, 7),
    ];
    let bits = bits.iter().map(|(is_set, bit)| u32::from(*is_set) << bit);
    let retry_factor = wanted.retry_factor.unwrap_or(settings.retry_factor);
    bits.sum::<u32>() | (retry_factor & 0xFF) << 8 | (u32::from(guards) * guard_time) << 16
}
