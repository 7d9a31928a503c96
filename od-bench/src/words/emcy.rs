//! Emergencies (CiA 301, chapter 7.2.7; codes of the manuals).

use std::format;
use std::prelude::v1::*;

use od_runtime::{CobId, Frame};

use super::said::{Service, Words};
use crate::device::VirtualDevice;

/// Meaning of an error code: the words of the manual, otherwise the class of CiA 301, table 26.
pub fn code_text(code: u16) -> &'static str {
    match code {
        0x0000 => "no error, or error reset",
        0x1000 => "generic error",
        0x5530 => "EEPROM error",
        0x6010 => "software reset (watchdog)",
        0x7320 => "position error",
        0x7510 => "internal communication error",
        0x8110 => "CAN overrun",
        0x8120 => "CAN error passive",
        0x8130 => "life guard or heartbeat error",
        0x8140 => "recovered from bus-off",
        0x8210 => "PDO not processed, too short",
        0x8220 => "PDO too long",
        0xFF00 => "battery low",
        0x0001..=0x0FFF => "no error",
        0x1001..=0x1FFF => "generic error",
        0x2000..=0x2FFF => "current",
        0x3000..=0x3FFF => "voltage",
        0x4000..=0x4FFF => "temperature",
        0x5000..=0x5FFF => "hardware",
        0x6000..=0x6FFF => "software",
        0x7000..=0x7FFF => "additional modules",
        0x8000..=0x8FFF => "monitoring",
        0x9000..=0x9FFF => "external error",
        0xF000..=0xFFFF => "additional functions or device-specific",
        _ => "reserved",
    }
}

/// Finds the EMCY of a device even if its 1014h is not the predefined value.
pub(super) fn explain(devices: &[VirtualDevice], frame: &Frame) -> Option<Words> {
    let device = devices.iter().find(|device| {
        let cob_id = device.stored(0x1014, 0).map(|raw| CobId::new(raw as u32));
        cob_id.is_some_and(|cob_id| cob_id.is_valid() && cob_id.can_id() == frame.id())
    })?;
    Some(words(device.node_id().raw(), frame))
}

pub(super) fn words(node: u8, frame: &Frame) -> Words {
    let Some(emcy) = od_wire::emcy::Emcy::parse(frame.data()) else {
        return Words::new(Service::Emcy, Some(node), "eight bytes are required").error();
    };
    let info = od_model::values::hex(&emcy.info);
    let text = format!(
        "{:04X}h {}, error register {:02X}h, {info}",
        emcy.code,
        code_text(emcy.code),
        emcy.register
    );
    let words = Words::new(Service::Emcy, Some(node), text);
    if emcy.code == 0 { words } else { words.error() }
}
