//! Fills in the values that a description leaves out.

use std::prelude::v1::*;

use od_eds::{Description, EntryDescription, Spanned, Value};
use od_model::{Address, Kind};

/// Gives each value without a default the default of the standards, the number in `[DeviceInfo]`, or the limit that
/// is nearest to 0, so that a simulated device does not contradict its own description.
pub(crate) fn fill(description: &mut Description) {
    let info = |key| {
        let section = description.section("DeviceInfo")?;
        let number = od_model::values::integer(section.get(key)?.value.trim())?;
        u64::try_from(number).ok().map(Value::Unsigned)
    };
    let identity = ["VendorNumber", "ProductNumber", "RevisionNumber"].map(info);
    for (index, object) in &mut description.objects {
        for (sub, entry) in &mut object.entries {
            if entry.default.is_some() || entry.parameter.is_some() {
                continue;
            }
            let given = match (*index, *sub) {
                (0x1018, 1..=3) => identity[usize::from(*sub) - 1].clone(),
                _ => standard(Address::new(*index, *sub)).or_else(|| nearest(entry)),
            };
            let data_type = entry.data_type.as_ref().map(|given| given.value);
            if let (Some(value), Some(data_type)) = (given, data_type)
                && value.fits(data_type)
            {
                entry.default = Some(Spanned::from(value));
            }
        }
    }
}

/// COB-IDs of the predefined connection set (CiA 301, chapter 7.3.3).
fn standard(address: Address) -> Option<Value> {
    Some(match (address.index, address.sub) {
        (0x1005, 0) => Value::Unsigned(0x80),
        (0x1012, 0) => Value::Unsigned(0x100),
        (0x1014, 0) => Value::NodeId(0x80),
        (0x1200, 1) => Value::NodeId(0x600),
        (0x1200, 2) => Value::NodeId(0x580),
        _ => return None,
    })
}

/// The limit that is nearest to 0; `None` if 0 is within the limits.
fn nearest(entry: &EntryDescription) -> Option<Value> {
    let kind = entry.data_type.as_ref()?.value.kind();
    if !matches!(kind, Kind::Unsigned | Kind::Signed) {
        return None;
    }
    let number = |limit: &Option<Spanned<Value>>| limit.as_ref().and_then(|one| one.integer(0));
    let limit = match (number(&entry.low), number(&entry.high)) {
        (Some(1..), _) => &entry.low,
        (_, Some(..=-1)) => &entry.high,
        _ => return None,
    };
    limit.as_ref().map(|limit| limit.value.clone())
}
