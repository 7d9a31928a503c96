//! Types that device profiles give their objects, besides those that od-eds checks.

use std::collections::BTreeMap;

use od_eds::outline::profile_types;
use od_model::DataType;
use od_model::DataType::{
    Integer8, Integer16, Integer24, Integer32, Real32, Unsigned8, Unsigned16, Unsigned32,
};

/// First and last index, first and last sub-index, type.
type Row = (u16, u16, u8, u8, DataType);

const DRIVE: &[Row] = &[
    (0x6046, 0x6047, 1, 4, Unsigned32),
    (0x6048, 0x604A, 1, 1, Unsigned32),
    (0x6048, 0x604A, 2, 2, Unsigned16),
    (0x604B, 0x604B, 1, 2, Integer16),
    (0x604C, 0x604C, 1, 2, Integer32),
    (0x606A, 0x606A, 0, 0, Integer16),
    (0x6088, 0x6088, 0, 0, Integer16),
    (0x6089, 0x6089, 0, 0, Integer8),
    (0x608B, 0x608B, 0, 0, Integer8),
    (0x608D, 0x608D, 0, 0, Integer8),
    (0x60BA, 0x60BD, 0, 0, Integer32),
    (0x60C0, 0x60C0, 0, 0, Integer16),
    (0x60C1, 0x60C1, 1, 0xFE, Integer32),
    (0x60C2, 0x60C2, 1, 1, Unsigned8),
    (0x60C2, 0x60C2, 2, 2, Integer8),
    (0x60C4, 0x60C4, 1, 2, Unsigned32),
    (0x60C4, 0x60C4, 3, 3, Unsigned8),
    (0x60C4, 0x60C4, 4, 4, Unsigned16),
    (0x60C4, 0x60C4, 5, 6, Unsigned8),
    (0x60E4, 0x60E5, 0, 0xFE, Integer32),
    (0x60F8, 0x60F8, 0, 0, Integer32),
    (0x60FA, 0x60FA, 0, 0, Integer32),
];

/// Offset values of the sensors of an encoder.
const ENCODER: &[Row] = &[(0x650C, 0x650C, 1, 0xFE, Integer32)];

/// Process and field values of CiA 404, in each of the ranges 6000h (REAL32), 7000h (INTEGER16), 8000h
/// (INTEGER24) and 9000h (INTEGER32): first and last index without the range.
const VALUES: [(u16, u16); 6] = [
    (0x100, 0x100),
    (0x120, 0x127),
    (0x130, 0x130),
    (0x133, 0x137),
    (0x148, 0x149),
    (0x300, 0x330),
];

/// The device profiles whose types are known.
const PROFILES: [u16; 4] = [401, 402, 404, 406];

/// Objects of one logical device: from 6000h on, 800h for each.
const LOGICAL: u16 = 0x800;

/// The types that a profile gives a value.
pub(super) fn types(profile: u16, index: u16, sub: u8) -> Vec<DataType> {
    if profile == 404 {
        let offset = index & 0xFFF;
        let is_value = VALUES
            .iter()
            .any(|(first, last)| (*first..=*last).contains(&offset));
        return match (is_value, index >> 12) {
            (true, 6) => vec![Real32],
            (true, 7) => vec![Integer16],
            (true, 8) => vec![Integer24],
            (true, 9) => vec![Integer32],
            _ => Vec::new(),
        };
    }
    let rows = match profile {
        402 => DRIVE,
        406 => ENCODER,
        _ => &[],
    };
    let own = rows.iter().filter(|(first, last, from, to, _)| {
        (*first..=*last).contains(&index) && (*from..=*to).contains(&sub)
    });
    let own = own.map(|(_, _, _, _, data_type)| *data_type);
    own.chain(profile_types(profile, index).iter().copied())
        .collect()
}

/// Profile of each logical device of a node.
pub(super) struct Profiles {
    /// The profile that 1000h names.
    named: u16,
    /// By number of the logical device, from 6000h on.
    all: BTreeMap<u16, u16>,
}

impl Profiles {
    /// The profile that 1000h names, or where the objects are not like it, the one that most of them
    /// are like. `values` has index, sub-index and length of each value.
    pub(super) fn of(named: u16, values: &[(u16, u8, usize)]) -> Self {
        let mut blocks: BTreeMap<u16, Vec<(u16, u8, usize)>> = BTreeMap::new();
        for (index, sub, len) in values {
            if let Some(at) = index.checked_sub(0x6000) {
                let block = blocks.entry(at / LOGICAL).or_default();
                block.push((0x6000 + at % LOGICAL, *sub, *len));
            }
        }
        let fits = |profile: u16, values: &[(u16, u8, usize)]| {
            let like = values.iter().filter(|(index, sub, len)| {
                let types = types(profile, *index, *sub);
                types.iter().any(|one| one.size() == Some(*len))
            });
            like.count()
        };
        let best = |values: Vec<(u16, u8, usize)>| {
            let others = PROFILES.map(|profile| (fits(profile, &values), profile));
            let best = others.into_iter().max_by_key(|(count, _)| *count);
            match best {
                _ if fits(named, &values) * 4 >= values.len() => named,
                Some((count, profile)) if count * 2 >= values.len() => profile,
                _ => 0,
            }
        };
        let all = blocks
            .into_iter()
            .map(|(number, values)| (number, best(values)))
            .collect();
        Self { named, all }
    }

    /// The types that the profile of its logical device gives a value.
    pub(super) fn types(&self, index: u16, sub: u8) -> Vec<DataType> {
        let Some(at) = index.checked_sub(0x6000) else {
            return Vec::new();
        };
        if self.named == 404 {
            return types(404, index, sub);
        }
        let profile = self.all.get(&(at / LOGICAL)).copied().unwrap_or(0);
        types(profile, 0x6000 + at % LOGICAL, sub)
    }
}
