//! Which values are saved, and which of them a sub-index of 1010h and 1011h covers.

use od_model::row::Row;
use od_model::{Address, Group};

use crate::profile::StoreProfile;

/// Returns whether 1010h saves the value.
pub(super) const fn is_saved(row: &Row) -> bool {
    !matches!(row.group(), Group::None) && row.is_stored()
}

/// Returns whether the value belongs to the operating records (hours, counters of errors):
/// saved objects of the manufacturer that no master can write.
///
/// Every save includes them, and no restore changes them.
pub const fn is_life_record(row: &Row) -> bool {
    matches!(row.group(), Group::Manufacturer) && !row.writable()
}

/// Returns whether the value is a saved setting, not one of the operating records.
pub(crate) const fn is_kept(row: &Row) -> bool {
    is_saved(row) && !is_life_record(row)
}

/// Returns whether sub-index `sub` of 1010h or 1011h covers this value, or the other value of its
/// pair ([`StoreProfile::twins`]).
pub(super) fn is_covered(profile: &StoreProfile, row: &Row, sub: u8) -> bool {
    let twin = |[one, other]: &[Address; 2]| match row.address() {
        address if address == *one => Some(*other),
        address if address == *other => Some(*one),
        _ => None,
    };
    let mut twins = profile.twins.iter().filter_map(twin);
    row.group().covered_by(sub)
        || is_saved(row) && twins.any(|twin| Group::of_index(twin.index).covered_by(sub))
}

/// Returns whether writing to sub-index `sub` of 1011h restores the default of this value.
pub fn restores(profile: &StoreProfile, row: &Row, sub: u8) -> bool {
    is_covered(profile, row, sub) && !is_life_record(row)
}

#[cfg(test)]
mod tests {
    use od_model::{Access, DataType, Entry, Literal, ObjectCode, Range, Slot};

    use super::*;
    use crate::profile::Profile;

    fn row(index: u16, group: Group, access: Access, len: u16) -> Row {
        let entry = Entry {
            address: Address::new(index, 0),
            data_type: DataType::Unsigned32,
            access,
            mappable: false,
            group,
            name: Range::new(0, 0),
            default: Literal::None,
            low: Literal::None,
            high: Literal::None,
            slot: Slot { offset: 0, len },
        };
        Row::new(&entry, ObjectCode::Var, 0, 0)
    }

    #[test]
    fn settings_and_operating_records_have_their_own_rules() {
        use Access::{Const, Ro, Rw};
        use Group::{Application, Communication, Manufacturer, None};
        const PROFILE: &StoreProfile = &Profile::CIA301.store;
        for (index, group, access, len, [saved, record, kept, restored]) in [
            (0x1017, Communication, Rw, 4, [true, false, true, true]),
            (0x6000, Application, Rw, 4, [true, false, true, true]),
            (0x6000, Application, Ro, 4, [true, false, true, true]),
            (0x2000, Manufacturer, Rw, 4, [true, false, true, true]),
            (0x2000, Manufacturer, Ro, 4, [true, true, false, false]),
            (0x2000, None, Rw, 4, [false, false, false, false]),
            (0x1017, Communication, Const, 0, [false, false, false, true]),
        ] {
            let row = row(index, group, access, len);
            assert_eq!(is_saved(&row), saved, "{index:X}");
            assert_eq!(is_life_record(&row), record, "{index:X}");
            assert_eq!(is_kept(&row), kept, "{index:X}");
            assert_eq!(restores(PROFILE, &row, 1), restored, "{index:X}");
        }
    }

    #[test]
    fn the_values_of_a_pair_are_in_the_groups_of_both() {
        const PROFILE: StoreProfile = StoreProfile {
            twins: &[[Address::new(0x1800, 0), Address::new(0x6200, 0)]],
            ..Profile::CIA301.store
        };
        let event = row(0x1800, Group::Communication, Access::Rw, 4);
        let cyclic = row(0x6200, Group::Application, Access::Rw, 4);
        let other = row(0x6201, Group::Application, Access::Rw, 4);
        for (sub, covered) in [
            (1, [true, true, true]),
            (2, [true, true, false]),
            (3, [true, true, true]),
            (4, [false, false, false]),
        ] {
            let rows = [&event, &cyclic, &other];
            let found = rows.map(|row| is_covered(&PROFILE, row, sub));
            assert_eq!(found, covered, "{sub}");
        }
        let unsaved = row(0x6200, Group::None, Access::Rw, 4);
        assert!(!is_covered(&PROFILE, &unsaved, 2));
    }
}
