use alloc::vec;

use super::*;
use crate::catalogue::{Eds, say};
use crate::description::{Description, Value};
use crate::span::{Span, token, token_of};
use od_model::Address;

fn base() -> Description {
    let mut description = Description::default();
    let edits = [
        Edit::add(Target::object(0x1000))
            .name("Device type")
            .data_type(DataType::Unsigned32)
            .default(Raw::Integer(0x196)),
        Edit::add(Target::object(0x1018))
            .code(ObjectCode::Record)
            .name("Identity object"),
        Edit::add(Target::member(0x1018, 1))
            .name("Vendor-ID")
            .data_type(DataType::Unsigned32)
            .default(Raw::Integer(0x5F)),
        Edit::add(Target::member(0x1018, 2))
            .name("Product code")
            .data_type(DataType::Unsigned32)
            .default(Raw::Integer(10)),
    ];
    assert_eq!(apply(&mut description, &edits), vec![]);
    description
}

/// The code, message and help of each finding of one edit against [`base`].
#[track_caller]
fn check(edit: Edit, expected: &[(&str, &str, &str)]) {
    let findings = apply(&mut base(), &[edit]);
    let told: Vec<_> = findings.iter().map(|f| say(f, &Eds)).collect();
    let findings: Vec<_> = told
        .iter()
        .map(|f| (f.code, f.message.as_str(), f.help.as_str()))
        .collect();
    assert_eq!(findings, expected);
}

#[test]
fn a_record_without_sub_index_0_gets_one() {
    let base = base();
    let count = base.entry(Address::new(0x1018, 0)).unwrap();
    assert_eq!(count.default, Some(Spanned::from(Value::Unsigned(2))));
    assert_eq!(*count.access, Access::Const);
}

#[test]
fn an_error_history_without_sub_index_0_is_empty_and_can_be_cleared() {
    let mut description = base();
    let edits = [
        Edit::add(Target::object(0x1003))
            .code(ObjectCode::Array)
            .name("Pre-defined error field"),
        Edit::add(Target::member(0x1003, 1))
            .name("Standard error field")
            .data_type(DataType::Unsigned32),
    ];
    assert_eq!(apply(&mut description, &edits), vec![]);
    let count = description.entry(Address::new(0x1003, 0)).unwrap();
    assert_eq!(count.default, Some(Spanned::from(Value::Unsigned(0))));
    assert_eq!(*count.access, Access::Rw);
}

#[test]
fn sub_index_0_is_updated_unless_it_is_given() {
    let count = |edits: &[Edit]| {
        let mut edited = base();
        edited.objects.get_mut(&0x1018).unwrap().sub_number = Some(Spanned::from(3));
        assert_eq!(apply(&mut edited, edits), vec![]);
        let object = &edited.objects[&0x1018];
        let number = object.sub_number.as_ref().map(|number| number.value);
        (object.entries[&0].default.clone(), number)
    };
    let holds = |value| Some(Spanned::from(Value::Unsigned(value)));
    let serial = Edit::add(Target::member(0x1018, 4))
        .name("Serial number")
        .data_type(DataType::Unsigned32);
    let told = Edit::modify(Target::member(0x1018, 0)).default(Raw::Integer(1));
    let fewer = Edit::remove(Target::member(0x1018, 2));
    assert_eq!(count(core::slice::from_ref(&serial)), (holds(4), Some(4)));
    assert_eq!(count(&[serial, told.clone()]), (holds(1), Some(4)));
    assert_eq!(count(&[fewer]), (holds(1), Some(2)));
    // It describes the object, and does not count.
    let structure = Edit::add(Target::member(0x1018, 0xFF))
        .name("Structure")
        .data_type(DataType::Unsigned32);
    assert_eq!(count(&[structure]), (holds(2), Some(4)));
    assert_eq!(count(&[told]), (holds(1), Some(3)));
}

#[test]
fn edits_change_only_their_target() {
    let mut edited = base();
    let edits = [
        Edit::modify(Target::member(0x1018, 2))
            .default(Raw::Integer(11))
            .access(Access::Const),
        Edit::remove(Target::object(0x1000)),
    ];
    assert_eq!(apply(&mut edited, &edits), vec![]);
    assert!(!edited.objects.contains_key(&0x1000));
    let product = edited.entry(Address::new(0x1018, 2)).unwrap();
    assert_eq!(product.default, Some(Spanned::from(Value::Unsigned(11))));
    assert_eq!(*product.access, Access::Const);
    assert_eq!(*product.name, "Product code");
    let mut vendor = base();
    vendor.objects.remove(&0x1000);
    let vendor = vendor.entry(Address::new(0x1018, 1)).cloned();
    assert_eq!(edited.entry(Address::new(0x1018, 1)).cloned(), vendor);
}

#[test]
fn a_missing_object_is_not_edited() {
    check(
        Edit::modify(Target::member(0x1019, 2)),
        &[(
            "E0701",
            "1019h does not exist",
            "write `0x1018sub2` (\"Identity object\")",
        )],
    );
    check(
        Edit::remove(Target::member(0x1018, 7)),
        &[(
            "E0701",
            "1018h:07 does not exist",
            "write one of the sub-indices sub0–sub2",
        )],
    );
    check(
        Edit::remove(Target::object(0x6502)),
        &[(
            "E0701",
            "6502h does not exist",
            "list the objects of a file with `odkit dump`",
        )],
    );
    check(
        Edit::modify(Target::member(0x1000, 0)),
        &[(
            "E0704",
            "1000h has object code VAR and no sub-objects",
            "write `0x1000` for its value",
        )],
    );
}

#[test]
fn an_existing_object_is_not_added() {
    check(
        Edit::add(Target::member(0x1018, 1)),
        &[(
            "E0702",
            "1018h:01 already exists",
            "write `modify 0x1018sub1 { … }` to change it",
        )],
    );
}

#[test]
fn a_value_has_the_type_of_its_entry() {
    check(
        Edit::modify(Target::object(0x1000)).default(Raw::Integer(-1)),
        &[(
            "E0707",
            "DefaultValue `-1` is not a valid UNSIGNED32",
            "write a number from 0 to 4294967295",
        )],
    );
    check(
        Edit::modify(Target::object(0x1000)).default(Raw::Text("x".into())),
        &[(
            "E0707",
            "DefaultValue `\"x\"` is not a valid UNSIGNED32",
            "write a number from 0 to 4294967295",
        )],
    );
    check(
        Edit::modify(Target::object(0x1000)).data_type(DataType::Unsigned8),
        &[(
            "E0708",
            "DefaultValue `406` of the base is not a valid UNSIGNED8",
            "write DefaultValue too: a number from 0 to 255, or `none`",
        )],
    );
}

#[test]
fn a_changed_type_converts_its_values() {
    let mut edited = base();
    let edit = Edit::modify(Target::object(0x1000)).data_type(DataType::Integer16);
    assert_eq!(apply(&mut edited, &[edit]), vec![]);
    let entry = edited.entry(Address::new(0x1000, 0)).unwrap();
    assert_eq!(entry.default, Some(Spanned::from(Value::Signed(0x196))));
}

#[test]
fn fields_must_fit_their_target() {
    check(
        Edit::modify(Target::object(0x1018)).default(Raw::Integer(1)),
        &[(
            "E0710",
            "1018h has sub-objects, and DefaultValue belongs to one of them",
            "write the sub-object, such as `0x1018sub1`",
        )],
    );
    check(
        Edit::modify(Target::member(0x1018, 1)).code(ObjectCode::Array),
        &[(
            "E0709",
            "`0x1018sub1` is a sub-object and has no ObjectType",
            "write `0x1018 { ObjectType=record }`",
        )],
    );
}

#[test]
fn an_add_needs_name_and_type() {
    check(
        Edit::add(Target::object(0x2110)),
        &[
            (
                "E0705",
                "`add 0x2110` lacks ParameterName",
                "write `ParameterName=\"…\"`",
            ),
            (
                "E0706",
                "`add 0x2110` lacks DataType",
                "write `DataType=0x0006` (UNSIGNED16), or another type",
            ),
        ],
    );
    check(
        Edit::add(Target::member(0x2110, 1)).name("x"),
        &[(
            "E0703",
            "`0x2110sub1` needs object 2110h, which does not exist",
            "write `add 0x2110 { code = record; name = \"…\" }` first",
        )],
    );
}

#[test]
fn a_finding_points_at_its_token() {
    let mut edit = Edit::remove(Target::object(0x2110));
    edit.target.span = token(7);
    let findings = apply(&mut base(), &[edit]);
    assert_eq!(findings[0].span().and_then(token_of), Some(7));
    assert_eq!(
        token_of(Span {
            line: 3,
            ..token(7)
        }),
        None
    );
}
