//! Fixes that restore a file: one value of a valid file is made wrong, and the fix writes the old line again.

use od_eds::Document;
use od_eds::fix::{Applicability, fix};

const MODULE: &str = include_str!("faults.eds");

/// Code of the finding, section, the line that is right, and one that is wrong.
const OF_MODULE: &[(&str, &str, &str, &str)] = &[
    ("E0301", "1014", "ObjectType=0x7", "ObjectType=0x77"),
    ("E0301", "1018", "ObjectType=0x9", "ObjectType=many"),
    ("E0402", "1015", "DataType=0x0006", "DataType=0x0600"),
    ("E0402", "1018sub3", "DataType=0x0007", "DataType=0x0077"),
    ("E0405", "1018sub3", "AccessType=ro", "AccessType=any"),
    ("E0405", "2001sub0", "AccessType=const", "AccessType=cons"),
    (
        "W0520",
        "1014",
        "DefaultValue=$NODEID+0x80",
        "DefaultValue=$NODEID+0x580",
    ),
    ("W0520", "1005", "DefaultValue=0x80", "DefaultValue=0x701"),
    (
        "E0532",
        "1014",
        "DefaultValue=$NODEID+0x80",
        "DefaultValue=$NODEID+0x180",
    ),
    (
        "W0521",
        "1800sub1",
        "DefaultValue=$NODEID+0x180",
        "DefaultValue=$NODEID+0x200",
    ),
    (
        "W0522",
        "1400sub1",
        "DefaultValue=$NODEID+0x200",
        "DefaultValue=$NODEID+0x2000",
    ),
    (
        "W0651",
        "1016sub2",
        "DefaultValue=0",
        "DefaultValue=0x008500FA",
    ),
    (
        "I0610",
        "FileInfo",
        "CreationDate=11-21-2026",
        "CreationDate=2026-11-21",
    ),
    (
        "I0610",
        "FileInfo",
        "CreationDate=11-21-2026",
        "CreationDate=21.11.2026",
    ),
    (
        "I0610",
        "FileInfo",
        "CreationDate=11-21-2026",
        "CreationDate=21-11-2026",
    ),
    (
        "I0610",
        "FileInfo",
        "ModificationDate=11-21-2026",
        "ModificationDate=11/21/2026",
    ),
    (
        "I0610",
        "FileInfo",
        "CreationTime=09:30AM",
        "CreationTime=09:30",
    ),
    (
        "W0247",
        "DeviceInfo",
        "DynamicChannelsSupported=0",
        "DynamicChannelsSupported=3",
    ),
];

/// The module with a line of a section replaced.
fn with(section: &str, right: &str, wrong: &str) -> String {
    let at = MODULE.find(&format!("[{section}]\n")).expect("the section");
    let line = at
        + MODULE[at..]
            .find(&format!("\n{right}\n"))
            .expect("the line")
        + 1;
    format!(
        "{}{wrong}{}",
        &MODULE[..line],
        &MODULE[line + right.len()..]
    )
}

fn codes(document: &Document) -> Vec<&'static str> {
    let findings = document.load().findings;
    findings.iter().map(|finding| finding.code()).collect()
}

#[test]
fn the_value_of_the_standard_is_written_again() {
    assert_eq!(codes(&Document::new(MODULE)), [""; 0]);
    for (code, section, right, wrong) in OF_MODULE {
        let document = Document::new(with(section, right, wrong));
        let found = codes(&document);
        assert!(found.contains(code), "{wrong}: {found:?}");
        let find = |document: &Document| document.load().findings;
        let done = fix(&document, Applicability::Unsafe, find);
        let text = done.document.text();
        assert!(text == MODULE, "{code} {wrong}: {}", diff(text));
    }
}

/// The first line that differs from the module.
fn diff(text: &str) -> String {
    let mut lines = text.lines().zip(MODULE.lines());
    let found = lines.find(|(own, right)| own != right);
    found.map_or_else(String::new, |(own, right)| {
        format!("`{own}`, not `{right}`")
    })
}

/// Pairs of rules that differ in one value, which follows from another object of the file.
#[test]
fn a_value_that_follows_from_another_object_is_written_again() {
    macro_rules! pairs {
        ($($code:literal)*) => {
            [$((
                $code,
                include_str!(concat!("../cases/", $code, "/bad.eds")),
                include_str!(concat!("../cases/", $code, "/fixed.eds")),
            )),*]
        };
    }
    for (code, bad, good) in pairs!("W0206" "W0536" "W0538" "W0656" "W0911" "W0915" "W0919" "W0922" "W0955" "W0956" "W0959")
    {
        let find = |document: &Document| document.load().findings;
        let done = fix(&Document::new(bad), Applicability::Unsafe, find);
        assert!(
            done.document.text() == good,
            "{code}: {}",
            done.document.text()
        );
    }
}
