//! `profile = cia406;`: the device says the same of itself in 1000h.

use od_eds::{Description, Value};
use od_model::Address;
use proc_macro2::Ident;

use crate::report::Report;

/// Compares with the low half of 1000h (CiA 301, object 1000h: device profile number).
pub(crate) fn check(profile: &Ident, description: &Description, report: &mut Report) {
    let text = profile.to_string();
    let number = text.strip_prefix("cia").and_then(|n| n.parse::<u16>().ok());
    let Some(number) = number else {
        report.at(
            profile.span(),
            format!(
                "`{profile}` is not a profile\nhelp: `cia` and its number, for example `cia406`"
            ),
        );
        return;
    };
    let entry = description.entry(Address::new(0x1000, 0));
    let default = entry.and_then(|e| e.parameter.as_ref().or(e.default.as_ref()));
    let Some(Value::Unsigned(device_type)) = default.map(|d| &d.value) else {
        // The missing 1000h is reported already.
        return;
    };
    let says = device_type & 0xFFFF;
    // CiA 301 itself is the profile of devices that follow no other: number 0.
    let wanted = if number == 301 { 0 } else { u64::from(number) };
    if says != wanted {
        let help = match says {
            0 => "1000h says that the device follows no profile".to_string(),
            says => format!("1000h says `profile = cia{says};`"),
        };
        report.at(
            profile.span(),
            format!("the device type in 1000h is 0x{device_type:08X}: this is not a CiA {number} device\nhelp: {help}"),
        );
    }
}
