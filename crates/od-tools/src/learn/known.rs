//! The device profile of each logical device of a node.

use std::collections::BTreeMap;

use od_eds::outline::profile_types;
use od_model::DataType;

/// The device profiles whose types are known.
const PROFILES: [u16; 4] = [401, 402, 404, 406];

/// Objects of one logical device: from 6000h on, 800h for each.
const LOGICAL: u16 = 0x800;

/// Profile of each logical device of a node.
pub(super) struct Profiles {
    /// The profile that 1000h names.
    named: u16,
    /// By number of the logical device, from 6000h on.
    all: BTreeMap<u16, u16>,
}

impl Profiles {
    /// The profile that 1000h names; if the objects do not fit it, the profile that fits most of
    /// them. `values` has index, sub-index and length of each value.
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
                let types = profile_types(profile, *index, *sub);
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

    /// The types of a value in the profile of its logical device.
    pub(super) fn types(&self, index: u16, sub: u8) -> Vec<DataType> {
        let Some(at) = index.checked_sub(0x6000) else {
            return Vec::new();
        };
        if self.named == 404 {
            return profile_types(404, index, sub);
        }
        let profile = self.all.get(&(at / LOGICAL)).copied().unwrap_or(0);
        profile_types(profile, 0x6000 + at % LOGICAL, sub)
    }
}
