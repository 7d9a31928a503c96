//! Names of objects in the standards, by index.

use od_eds::Description;
use od_eds::outline::{profile_name, specified};
use od_model::Address;

/// Number of the device profile in 1000h; `None` without a profile.
pub(crate) fn profile(description: &Description) -> Option<u16> {
    let entry = description.entry(Address::new(0x1000, 0))?;
    let value = entry.parameter.as_ref().or(entry.default.as_ref())?;
    let number = value.value.integer(0)?;
    u16::try_from(number & 0xFFFF)
        .ok()
        .filter(|number| *number != 0)
}

/// The name of an object and its standard; `profile` is the profile of the device.
pub(crate) fn name(index: u16, profile: Option<u16>) -> Option<(&'static str, &'static str)> {
    if let Some(known) = specified(index) {
        return Some((known.name, known.source));
    }
    let (profile, source, devices) = match profile? {
        401 => (401, "CiA 401", 8),
        402 => (402, "CiA 402", 8),
        404 => (404, "CiA 404", 1),
        406 => (406, "CiA 406", 1),
        _ => return None,
    };
    // The objects of the second device of a module are 800h higher, and so on.
    let own = index.checked_sub(0x6000)?;
    let index = if devices > 1 && own / 0x800 < devices {
        0x6000 + own % 0x800
    } else {
        index
    };
    profile_name(profile, index).map(|name| (name, source))
}

/// Meaning of an index by its range (CiA 301, table 11).
pub(crate) const fn area(index: u16) -> &'static str {
    match index {
        0x0001..=0x025F => "data type",
        0x1000..=0x1FFF => "communication parameter",
        0x2000..=0x5FFF => "manufacturer-specific object",
        0x6000..=0x9FFF => "object of a device profile",
        0xA000..=0xAFFF => "network variable",
        0xB000..=0xBFFF => "system variable",
        _ => "reserved",
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_index_has_the_name_of_its_profile() {
        let expected = [
            (0x1018, None, Some(("identity object", "CiA 301"))),
            (0x1F80, None, Some(("NMT startup", "CiA 302"))),
            (0x6000, Some(401), Some(("Read input 8-bit", "CiA 401"))),
            (0x6041, Some(402), Some(("Statusword", "CiA 402"))),
            (0x6841, Some(402), Some(("Statusword", "CiA 402"))),
            (0x6130, Some(404), Some(("AI input PV", "CiA 404"))),
            (0x6004, Some(406), Some(("Position value", "CiA 406"))),
            (0x6804, Some(406), None),
            (0x6004, None, None),
            (0x2000, Some(406), None),
        ];
        for (index, profile, found) in expected {
            assert_eq!(name(index, profile), found, "{index:04X}");
        }
    }
}
