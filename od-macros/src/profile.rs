//! `profile = cia406;`: 1000h must have the same device profile number.

use od_eds::{Description, Value};
use od_model::Address;
use proc_macro2::Ident;

use crate::report::Report;

/// Compares with the low half of 1000h (CiA 301, object 1000h: device profile number).
pub(crate) fn check(profile: &Ident, description: &Description, report: &mut Report) {
    let text = profile.to_string();
    let number = text.strip_prefix("cia").and_then(|n| n.parse::<u16>().ok());
    let Some(number) = number else {
        let digits = text.trim_start_matches(|c: char| !c.is_ascii_digit());
        let help = match digits.parse::<u16>() {
            Ok(number) => format!("did you mean `cia{number}`?"),
            Err(_) => "`cia` and its number, for example `cia406`".into(),
        };
        let message = format!("`{profile}` is not a profile\nhelp: {help}");
        report.at(profile.span(), message);
        return;
    };
    let entry = description.entry(Address::new(0x1000, 0));
    let default = entry.and_then(|e| e.parameter.as_ref().or(e.default.as_ref()));
    let Some(Value::Unsigned(device_type)) = default.map(|d| &d.value) else {
        // A missing 1000h is already reported.
        return;
    };
    let says = device_type & 0xFFFF;
    // Devices without a device profile have number 0: CiA 301 only.
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
