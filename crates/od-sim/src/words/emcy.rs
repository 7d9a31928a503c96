//! Emergencies (CiA 301, chapter 7.2.7) in words: codes of the manuals, else those of `od_wire`.

use std::format;
use std::prelude::v1::*;

use od_runtime::{CobId, Frame};
use od_wire::emcy::{Emcy, text};

use super::description::{Service, Words};
use crate::device::VirtualDevice;

/// Vendor-ID of the encoders of the three manuals.
const MANUALS: u32 = 0xEC;

/// Meaning of an error code of a device: its manual, its profile (1000h), or CiA 301.
pub(crate) fn emcy_text(code: u16, device: Option<&VirtualDevice>) -> &'static str {
    let own = device.and_then(|device| {
        let kind = device.dictionary().entry(0x1000, 0)?.default.integer(0)?;
        match (kind & 0xFFFF, device.lss_address()) {
            (406, [MANUALS, ..]) => manual(code),
            (profile, _) => Some(text(u16::try_from(profile).ok(), code)),
        }
    });
    own.unwrap_or_else(|| text(None, code))
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

/// Finds the EMCY of a device even if its 1014h is not the predefined value.
pub(super) fn explain(devices: &[VirtualDevice], frame: &Frame) -> Option<Words> {
    let device = devices.iter().find(|device| {
        let cob_id = device.stored(0x1014, 0).map(|raw| CobId::new(raw as u32));
        cob_id.is_some_and(|cob_id| cob_id.is_valid() && cob_id.can_id() == frame.id())
    })?;
    Some(words(device.node_id().raw(), Some(device), frame))
}

pub(super) fn words(node: u8, device: Option<&VirtualDevice>, frame: &Frame) -> Words {
    let Some(emcy) = Emcy::parse(frame.data()) else {
        return Words::new(Service::Emcy, Some(node), "eight bytes are required").error();
    };
    let info = od_model::values::hex(&emcy.info);
    let text = format!(
        "{:04X}h {}, error register {:02X}h, {info}",
        emcy.code,
        emcy_text(emcy.code, device),
        emcy.register
    );
    let words = Words::new(Service::Emcy, Some(node), text);
    if emcy.code == 0 { words } else { words.error() }
}
