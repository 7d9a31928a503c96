//! Emergencies (CiA 301, chapter 7.2.7): codes of CiA 301, of a device's profile and of its manual.

use std::format;
use std::prelude::v1::*;

use od_runtime::{CobId, Frame};

use super::said::{Service, Words};
use crate::device::VirtualDevice;

/// Vendor-ID of the encoders of the three manuals.
const MANUALS: u32 = 0xEC;

/// Meaning of an error code for any device: CiA 301, table 26.
pub(crate) fn code_text(code: u16) -> &'static str {
    match code {
        0x8110 => return "CAN overrun",
        0x8120 => return "CAN error passive",
        0x8130 => return "life guard or heartbeat error",
        0x8140 => return "recovered from bus-off",
        0x8150 => return "CAN-ID collision",
        0x8210 => return "PDO not processed, length error",
        0x8220 => return "PDO too long",
        0x8230 => return "DAM MPDO not processed, its object is not available",
        0x8240 => return "unexpected SYNC data length",
        0x8250 => return "RPDO timeout",
        _ => {}
    }
    match code >> 8 {
        0x00 => "no error, or error reset",
        0x10 => "generic error",
        0x21 => "current, device input side",
        0x22 => "current inside the device",
        0x23 => "current, device output side",
        0x20..=0x2F => "current",
        0x31 => "mains voltage",
        0x32 => "voltage inside the device",
        0x33 => "output voltage",
        0x30..=0x3F => "voltage",
        0x41 => "ambient temperature",
        0x42 => "device temperature",
        0x40..=0x4F => "temperature",
        0x50..=0x5F => "device hardware",
        0x61 => "internal software",
        0x62 => "user software",
        0x63 => "data set",
        0x60..=0x6F => "device software",
        0x70..=0x7F => "additional modules",
        0x81 => "communication",
        0x82 => "protocol error",
        0x80..=0x8F => "monitoring",
        0x90..=0x9F => "external error",
        0xF0..=0xFE => "additional functions",
        0xFF => "device-specific",
        _ => "reserved",
    }
}

/// Meaning of an error code of a device: its manual, its profile (1000h), or CiA 301.
pub(crate) fn text_of(code: u16, device: Option<&VirtualDevice>) -> &'static str {
    let own = device.and_then(|device| {
        let kind = device.dictionary().entry(0x1000, 0)?.default.integer(0)?;
        match (kind & 0xFFFF, device.lss_address()) {
            (402, _) => drive(code),
            (406, [MANUALS, ..]) => manual(code),
            _ => None,
        }
    });
    own.unwrap_or_else(|| code_text(code))
}

/// The words of the manuals of the encoders.
fn manual(code: u16) -> Option<&'static str> {
    Some(match code {
        0x5530 => "EEPROM error",
        0x6010 => "software reset (watchdog)",
        0x7320 => "position error",
        0x7510 => "internal communication error",
        0xFF00 => "battery low",
        _ => return None,
    })
}

/// Error codes of a drive (CiA 402-2, error codes).
fn drive(code: u16) -> Option<&'static str> {
    Some(match code {
        0x2310 => "continuous over-current, device output side",
        0x2320 => "short circuit or earth leakage, device output side",
        0x2330 => "earth leakage, device output side",
        0x2340 => "short circuit, device output side",
        0x3110 => "mains over-voltage",
        0x3120 => "mains under-voltage",
        0x3130 => "phase failure",
        0x3210 => "DC link over-voltage",
        0x3220 => "DC link under-voltage",
        0x3230 => "load error",
        0x4110 => "excess ambient temperature",
        0x4120 => "too low ambient temperature",
        0x4210 => "excess device temperature",
        0x4220 => "too low device temperature",
        0x4310 => "excess drive temperature",
        0x4320 => "too low drive temperature",
        0x5110 => "low voltage of the supply",
        0x5530 => "non-volatile data memory",
        0x6010 => "software reset (watchdog)",
        0x6320 => "parameter error",
        0x7110 => "brake chopper",
        0x7120 => "motor",
        0x7121 => "motor blocked",
        0x7122 => "motor error or commutation malfunction",
        0x7300 => "sensor",
        0x7301 => "tacho fault",
        0x7303 => "resolver 1 fault",
        0x7305 => "incremental sensor 1 fault",
        0x7310 => "speed",
        0x7320 => "position",
        0x7500 => "communication",
        0x7510 => "serial interface 1",
        0x8311 => "excess torque",
        0x8331 => "torque fault",
        0x8400 => "velocity speed controller",
        0x8500 => "position controller",
        0x8611 => "following error",
        0x8612 => "reference limit",
        _ => return None,
    })
}

/// Finds the EMCY of a device even if its 1014h is not the predefined value.
pub(super) fn explain(devices: &[VirtualDevice], frame: &Frame) -> Option<Words> {
    let device = devices.iter().find(|device| {
        let cob_id = device.stored(0x1014, 0).map(|raw| CobId::new(raw as u32));
        cob_id.is_some_and(|cob_id| cob_id.is_valid() && cob_id.can_id() == frame.id())
    })?;
    Some(words(device.node_id().raw(), Some(device), frame))
}

pub(super) fn words(node: u8, device: Option<&VirtualDevice>, frame: &Frame) -> Words {
    let Some(emcy) = od_wire::emcy::Emcy::parse(frame.data()) else {
        return Words::new(Service::Emcy, Some(node), "eight bytes are required").error();
    };
    let info = od_model::values::hex(&emcy.info);
    let text = format!(
        "{:04X}h {}, error register {:02X}h, {info}",
        emcy.code,
        text_of(emcy.code, device),
        emcy.register
    );
    let words = Words::new(Service::Emcy, Some(node), text);
    if emcy.code == 0 { words } else { words.error() }
}
