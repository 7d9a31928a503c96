//! The sentences of the rules in the words of a macro call.

use std::path::{Path, PathBuf};

use od_eds::check::RULES;
use od_eds::patch::{self, Raw};
use od_eds::{Document, load};

use od_eds::patch::Target;
use od_eds::{Fact, Key, Vocabulary};
use od_model::DataType;

use super::*;

/// All cases of the rules, broken.
fn cases() -> Vec<PathBuf> {
    let rules = Path::new(env!("CARGO_MANIFEST_DIR")).join("../crates/od-eds/cases");
    let folders = RULES.iter().map(|rule| rules.join(rule.code));
    let files = folders
        .flat_map(|folder| ["eds", "xdd"].map(|kind| folder.join("bad").with_extension(kind)));
    files.filter(|path| path.exists()).collect()
}

/// Returns whether the finding is about a file in which this key is written.
fn is_told(finding: &Finding, key: Key) -> bool {
    let mut facts = finding.facts.iter();
    facts.any(|(_, fact)| matches!(fact, Fact::Text(text) if key.is(text)))
}

/// In a row a key is a field: no sentence has the key of an EDS, unless the file says it.
#[test]
fn a_row_has_fields_and_not_keys() {
    let cases = cases();
    assert!(cases.len() > 150, "{} cases", cases.len());
    let mut faults = Vec::new();
    for path in cases {
        let document = Document::new(std::fs::read(&path).unwrap());
        for finding in document.load().findings {
            let told = say(&finding, &Row);
            for text in [told.message, told.help] {
                let keys = Key::ALL
                    .into_iter()
                    .filter(|key| Row.key(*key) != key.name());
                let keys = keys.filter(|key| !is_told(&finding, *key));
                faults.extend(
                    keys.filter(|key| text.contains(key.name()))
                        .map(|key| format!("{}: {}: {text}", finding.code(), key.name())),
                );
            }
        }
    }
    faults.sort();
    faults.dedup();
    assert!(faults.is_empty(), "{}", faults.join("\n"));
}

#[test]
fn values_are_written_as_a_row_writes_them() {
    let mut device = load("[1000]\nParameterName=a\nDataType=7\nAccessType=rw\n").description;
    let edits = [
        Edit::add(Target::object(0x2000)).name("a"),
        Edit::modify(Target::object(0x1000)).data_type(DataType::Boolean),
        Edit::modify(Target::object(0x1000)).default(Raw::Integer(2)),
    ];
    let findings = patch::apply(&mut device, &edits);
    let told: Vec<(String, String)> = findings
        .iter()
        .map(|finding| say(finding, &Row))
        .map(|told| (told.message, told.help))
        .collect();
    let expected = [
        (
            "`add 0x2000` lacks `type`",
            "write `type = u16` (UNSIGNED16), or another type",
        ),
        (
            "`default` `2` is not a valid BOOLEAN",
            "write `true` or `false`",
        ),
    ];
    let expected = expected.map(|(message, help)| (message.to_string(), help.to_string()));
    assert_eq!(told, expected);
}
