//! Makes the objects of a new description.

use alloc::format;
use alloc::string::String;

use crate::description::{Description, EntryDescription, ObjectDescription, Value};
use crate::span::Spanned;
use od_model::{Access, DataType, ObjectCode};

pub(super) fn value(
    name: impl Into<String>,
    data_type: DataType,
    access: Access,
    default: Option<Value>,
) -> EntryDescription {
    let mut entry = EntryDescription::new(name, data_type);
    entry.access = Spanned::from(access);
    entry.default = default.map(Spanned::from);
    entry
}

pub(super) fn unsigned(number: u32) -> Option<Value> {
    Some(Value::Unsigned(number.into()))
}

pub(super) fn var(made: &mut Description, index: u16, entry: EntryDescription) {
    made.objects.insert(index, ObjectDescription::var(entry));
}

/// An ARRAY or RECORD: the members with their sub-indices, and their number.
pub(super) fn members(
    made: &mut Description,
    index: u16,
    (name, code): (&str, ObjectCode),
    count: u32,
    members: impl IntoIterator<Item = (u8, EntryDescription)>,
) {
    let first = value(
        "Highest sub-index supported",
        DataType::Unsigned8,
        Access::Const,
        unsigned(count),
    );
    let mut object = ObjectDescription::var(first);
    object.code = Spanned::from(code);
    object.name = Spanned::from(String::from(name));
    object.entries.extend(members);
    object.sub_number = Some(Spanned::from(object.entries.len() as u32));
    made.objects.insert(index, object);
}

/// An ARRAY of numbers: the given ones, and 0 in all others.
pub(super) fn array(
    made: &mut Description,
    index: u16,
    (name, data_type, access): (&str, DataType, Access),
    (count, other): (u8, u32),
    numbers: &[(u8, u32)],
) {
    let entries = (1..=count).map(|sub| {
        let given = numbers.iter().find(|(own, _)| *own == sub);
        let default = if other == 0 { None } else { unsigned(other) };
        let mut entry = value(format!("{name}{sub}"), data_type, access, default);
        entry.parameter = given
            .and_then(|(_, number)| unsigned(*number))
            .map(Spanned::from);
        (sub, entry)
    });
    members(
        made,
        index,
        (name, ObjectCode::Array),
        count.into(),
        entries,
    );
}
