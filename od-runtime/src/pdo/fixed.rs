//! Mappings of TPDOs that nobody can change: the compiler resolves them.

use od_model::Dictionary;
use od_model::typed::MapEntry;

use crate::device::{Device, may_change};
use crate::rooms::KEPT;

/// The mapping of a TPDO.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Fixed {
    /// Positions of the rows of the mapped values.
    rows: [u16; KEPT],
    count: u8,
    /// Length of the frame in bytes.
    pub(super) len: u8,
}

impl Fixed {
    /// Nothing is mapped, or what the object says does not hold: the PDO is off.
    const EMPTY: Self = Self {
        rows: [0; KEPT],
        count: 0,
        len: 0,
    };

    /// The mappings of the first TPDOs, if they are [fixed](is_fixed).
    pub(crate) const fn all<D: Device, const PDO: usize>() -> [Self; PDO] {
        let mut all = [Self::EMPTY; PDO];
        if let Some(dictionary) = &D::DICTIONARY
            && is_fixed::<D>()
        {
            let mut number = 0;
            while number < PDO {
                all[number] = Self::of(dictionary, 0x1A00 + number as u16);
                number += 1;
            }
        }
        all
    }

    /// The mapping that an object says, as [`Mapping::load`](super::mapping::Mapping::load) reads it.
    const fn of(dictionary: &Dictionary<'_>, object: u16) -> Self {
        let (mut fixed, mut bits) = (Self::EMPTY, 0);
        let count = word(dictionary, object, 0);
        while (fixed.count as u32) < count {
            let raw = word(dictionary, object, fixed.count + 1);
            let MapEntry {
                address,
                bits: length,
            } = MapEntry::parse(raw);
            let Some(position) = dictionary.position(address.key()) else {
                return Self::EMPTY;
            };
            let row = dictionary.rows()[position];
            bits += length as u32;
            let is_sound = row.maps_to_tpdo() && !row.is_variable() && row.bits() == length;
            if !is_sound || bits > 64 {
                return Self::EMPTY;
            }
            fixed.rows[fixed.count as usize] = position as u16;
            fixed.count += 1;
        }
        fixed.len = bits.div_ceil(8) as u8;
        fixed
    }

    /// Positions of the rows of the mapped values.
    pub(super) fn rows(&self) -> &[u16] {
        self.rows.get(..self.count.into()).unwrap_or_default()
    }
}

/// Whether no mapping of a TPDO can change, and none has more entries than are kept. To be asked at compile
/// time.
pub(crate) const fn is_fixed<D: Device>() -> bool {
    let Some(dictionary) = &D::DICTIONARY else {
        return false;
    };
    if may_change::<D>(0x1A00, 0x1BFF) || dictionary.len() > u16::MAX as usize {
        return false;
    }
    let mut rest = dictionary.rows();
    while let [row, others @ ..] = rest {
        let is_mapping = matches!(row.index(), 0x1A00..=0x1BFF);
        let is_long = row.address().sub == 0 && row.default(dictionary.pool(), 0) > KEPT as u64;
        if is_mapping && (row.follows_node_id() || row.is_variable() || is_long) {
            return false;
        }
        rest = others;
    }
    true
}

/// The number at an address, which is not in the store: its default. 0 where it is missing.
const fn word(dictionary: &Dictionary<'_>, index: u16, sub: u8) -> u32 {
    let address = od_model::Address::new(index, sub);
    match dictionary.position(address.key()) {
        Some(position) => {
            let row = dictionary.rows()[position];
            let unused = 64 - row.bits() as u32;
            (row.default(dictionary.pool(), 0) << unused >> unused) as u32
        }
        None => 0,
    }
}
