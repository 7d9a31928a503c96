use alloc::string::String;
use alloc::vec::Vec;

use super::{Impact, compare};
use crate::description::tables::Tables;

const BASE: &str = "\
[MandatoryObjects]
SupportedObjects=1
1=0x1000
[OptionalObjects]
SupportedObjects=2
1=0x1017
2=0x1800
[1000]
ParameterName=Device type
DataType=0x7
AccessType=ro
DefaultValue=0x00020196
[1017]
ParameterName=Heartbeat
DataType=0x6
AccessType=rw
DefaultValue=0
LowLimit=0
HighLimit=1000
[1800]
ParameterName=TPDO
ObjectType=0x9
SubNumber=3
[1800sub0]
ParameterName=Highest
DataType=0x5
AccessType=ro
DefaultValue=2
[1800sub1]
ParameterName=COB-ID
DataType=0x7
AccessType=rw
DefaultValue=$NODEID+0x180
[1800sub2]
ParameterName=Type
DataType=0x5
AccessType=rw
DefaultValue=254
";

/// Checks the differences after a replacement in the text.
#[track_caller]
fn check(from: &str, to: &str, expected: &[&str]) {
    assert!(BASE.contains(from), "{from:?} is not in the text");
    let changed = BASE.replace(from, to);
    let tables = [BASE, &changed].map(|text| Tables::new(&crate::parse(text).description));
    let both = [tables[0].dictionary(), tables[1].dictionary()];
    let found: Vec<String> = compare(both[0], both[1])
        .iter()
        .map(|d| {
            let mark = if d.impact == Impact::Breaking {
                "!"
            } else {
                ""
            };
            let place = d.place();
            alloc::format!(
                "{mark}{place} {}: {} > {}",
                d.field.name(),
                d.before,
                d.after
            )
        })
        .collect();
    assert_eq!(found, expected);
}

#[test]
fn another_spelling_is_no_difference() {
    check("0x00020196", "131478", &[]);
    check(
        "DataType=0x7\nAccessType=ro",
        "AccessType=RO\nDataType=0x0007",
        &[],
    );
}

#[test]
fn a_change_that_masters_rely_on_breaks() {
    check(
        "0x00020196",
        "0x00010196",
        &["!1000h default: 0x00020196 > 0x00010196"],
    );
    check(
        "$NODEID+0x180",
        "$NODEID+0x280",
        &["!1800h:01 default: $NODEID+0x180 > $NODEID+0x280"],
    );
    check(
        "DataType=0x6",
        "DataType=0x7",
        &["!1017h data type: UNSIGNED16 > UNSIGNED32"],
    );
    check(
        "AccessType=rw\nDefaultValue=254",
        "AccessType=const\nDefaultValue=254",
        &[
            "!1800h:02 access: rw > const",
            "!1800h:02 storage: communication > not saved",
        ],
    );
}

#[test]
fn narrower_limits_break_and_wider_ones_do_not() {
    check(
        "HighLimit=1000",
        "HighLimit=500",
        &["!1017h high limit: 0x03E8 > 0x01F4"],
    );
    check(
        "HighLimit=1000",
        "HighLimit=2000",
        &["1017h high limit: 0x03E8 > 0x07D0"],
    );
    check(
        "HighLimit=1000",
        "HighLimit=",
        &["1017h high limit: 0x03E8 > "],
    );
    check("LowLimit=0", "LowLimit=5", &["!1017h low limit: 0 > 5"]);
}

#[test]
fn names_and_plain_defaults_do_not() {
    check(
        "ParameterName=Heartbeat",
        "ParameterName=Producer",
        &["1017h name: Heartbeat > Producer"],
    );
    check(
        "DefaultValue=0\nLowLimit",
        "DefaultValue=100\nLowLimit",
        &["1017h default: 0 > 0x0064"],
    );
    check(
        "ParameterName=TPDO",
        "ParameterName=TPDO 1",
        &["1800h name: TPDO > TPDO 1"],
    );
}

#[test]
fn objects_and_members_are_added_and_removed() {
    check(
        "SupportedObjects=2\n1=0x1017\n2=0x1800",
        "SupportedObjects=1\n1=0x1800",
        &[],
    );
    let without = &BASE[BASE.find("[1800sub2]").unwrap_or(0)..];
    check(without, "", &["!1800h:02 removed: UNSIGNED8 rw > "]);
    let tables = [BASE, ""].map(|text| Tables::new(&crate::parse(text).description));
    let [full, none] = [tables[0].dictionary(), tables[1].dictionary()];
    assert_eq!(compare(full, none).len(), 3);
    assert!(
        compare(full, none)
            .iter()
            .all(|d| d.impact == Impact::Breaking)
    );
    assert!(
        compare(none, full)
            .iter()
            .all(|d| d.impact == Impact::Compatible)
    );
}
