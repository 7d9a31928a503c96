//! Names of objects in the standards, by index.

mod drive;
mod encoder;
mod io;
mod measuring;

use od_eds::Description;
use od_eds::outline::specified;
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
    let (table, source, devices): (&[Row], _, _) = match profile? {
        401 => (io::TABLE, "CiA 401", 8),
        402 => (drive::TABLE, "CiA 402", 8),
        404 => (measuring::TABLE, "CiA 404", 1),
        406 => (encoder::TABLE, "CiA 406", 1),
        _ => return None,
    };
    // The objects of the second device of a module are 800h higher, and so on.
    let own = index.checked_sub(0x6000)?;
    let index = match own / 0x800 < devices {
        true if devices > 1 => 0x6000 + own % 0x800,
        _ => index,
    };
    let row = table
        .iter()
        .find(|(first, last, _)| (*first..=*last).contains(&index));
    row.map(|(_, _, name)| (*name, source))
}

/// The objects of a profile: index and name.
pub(crate) fn of_profile(profile: u16) -> impl Iterator<Item = (u16, &'static str)> {
    let table: &[Row] = match profile {
        401 => io::TABLE,
        402 => drive::TABLE,
        404 => measuring::TABLE,
        406 => encoder::TABLE,
        _ => &[],
    };
    table.iter().map(|(first, _, name)| (*first, *name))
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

/// An index, or the first and last one of a range, and the name of the objects there.
type Row = (u16, u16, &'static str);

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn tables_are_sorted() {
        for table in [io::TABLE, drive::TABLE, measuring::TABLE, encoder::TABLE] {
            assert!(table.iter().all(|(first, last, _)| first <= last));
            let sorted = table.windows(2).all(|pair| pair[0].1 < pair[1].0);
            assert!(sorted);
        }
    }

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
