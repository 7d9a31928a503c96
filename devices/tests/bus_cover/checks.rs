//! Every dictionary passes the checks that a file would have to.
//!
//! The macro stops at errors, and shows of a variant only what its edits broke. Here the
//! description is made of what is compiled in, and warnings count.

use od_devices::find;
use od_model::{
    Description, Dictionary, EntryDescription, Literal, ObjectDescription, Spanned, Tables, Value,
    check, eds,
};

use crate::models::MODELS;

fn value(dictionary: Dictionary<'_>, literal: Literal) -> Option<Spanned<Value>> {
    let value = match literal {
        Literal::None => return None,
        Literal::Unsigned(number) => Value::Unsigned(number),
        Literal::Signed(number) => Value::Signed(number),
        Literal::Real(number) => Value::Real(number),
        Literal::NodeId(offset) => Value::NodeId(offset),
        Literal::Text(range) => Value::Text(dictionary.text(range).to_string()),
        Literal::Bytes(range) => Value::Bytes(dictionary.blob(range).to_vec()),
    };
    Some(Spanned::from(value))
}

/// The description that this dictionary could have been made from.
fn description(dictionary: Dictionary<'_>) -> Description {
    let mut description = Description::default();
    for object in dictionary.objects() {
        let members = dictionary.members(object);
        let entries = members.iter().map(|entry| {
            let name = dictionary.text(entry.name);
            let made = EntryDescription {
                access: Spanned::from(entry.access),
                mappable: Spanned::from(entry.mappable),
                default: value(dictionary, entry.default),
                low: value(dictionary, entry.low),
                high: value(dictionary, entry.high),
                group: Some(Spanned::from(entry.group)),
                ..EntryDescription::new(name, entry.data_type)
            };
            (entry.address.sub, made)
        });
        let made = ObjectDescription {
            code: Spanned::from(object.code),
            name: Spanned::from(dictionary.text(object.name).to_string()),
            sub_number: Some(Spanned::from(u32::from(object.count))),
            entries: entries.collect(),
            flags: 0,
            extra: Vec::new(),
            span: Default::default(),
        };
        description.objects.insert(object.index, made);
    }
    description
}

#[test]
fn no_device_has_an_error_or_a_warning() {
    for model in &MODELS {
        let dictionary = find(&model.id()).unwrap().dictionary;
        let description = description(dictionary);
        let tables = Tables::new(&description);
        assert!(tables.dictionary() == dictionary, "{}", model.name);
        assert_eq!(check::check(&description), [], "{}", model.name);
    }
}

#[test]
fn nor_has_the_file() {
    let loaded = eds::load(include_str!("../../eds/GXMM.eds"));
    assert_eq!(loaded.diagnostics, []);
}
