//! The rules of all tools against their own texts.

extern crate std;

use alloc::collections::BTreeSet;
use alloc::format;
use alloc::string::String;
use alloc::vec::Vec;
use std::fs;
use std::path::{Path, PathBuf};

use super::*;
use crate::catalogue::{Eds, say};
use crate::document::Document;
use crate::finding::Finding;

/// The findings of one tool about a text.
fn found(name: &str, text: &str) -> Vec<Finding> {
    let document = Document::new(text.as_bytes());
    check(
        &document,
        &document.parse().description,
        &[tool(name).unwrap()],
    )
}

/// Code and line of each finding.
fn codes(name: &str, text: &str) -> Vec<String> {
    let findings = found(name, text);
    let shown = findings.iter().map(|finding| {
        let line = finding.span().map_or(0, |span| span.line);
        format!("{}:{line}", finding.code())
    });
    shown.collect()
}

#[test]
fn codes_are_unique_and_of_their_range() {
    let mut known = BTreeSet::new();
    for tool in TOOLS {
        for rule in tool.rules {
            assert!(known.insert(rule.code), "{}", rule.code);
            assert!(rule.code.starts_with('T') && rule.code.len() == 5);
            assert_eq!(rule.code[..3], tool.rules[0].code[..3], "{}", tool.name);
            assert!(!rule.title.is_empty() && !rule.why.is_empty() && !rule.source.is_empty());
            assert!(!rule.example.is_empty(), "{}", rule.code);
            assert!(rule.says.starts_with("{tool} "), "{}", rule.code);
        }
    }
}

fn files(folder: &Path, found: &mut Vec<PathBuf>) {
    for entry in fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.is_dir() {
            files(&path, found)
        } else {
            found.push(path)
        }
    }
}

/// No tool panics on any case, no blank stays empty, and what a fix promises is so: odkit reads the same.
#[test]
fn every_sentence_is_filled() {
    let crate_folder = Path::new(env!("CARGO_MANIFEST_DIR"));
    let mut paths = Vec::new();
    files(&crate_folder.join("cases"), &mut paths);
    for path in paths {
        let document = Document::new(fs::read(&path).unwrap());
        let description = document.parse().description;
        for tool in TOOLS {
            for finding in check(&document, &description, &[*tool]) {
                let said = say(&finding, &Eds);
                for text in [&said.message, &said.help] {
                    let blank = text.find('{').is_some_and(|at| {
                        let rest = &text[at + 1..];
                        rest.find('}')
                            .is_some_and(|end| rest[..end].chars().all(|c| c.is_ascii_lowercase()))
                    });
                    assert!(!blank, "{}: {text} of {}", said.code, path.display());
                }
            }
        }
    }
}

const OBJECT: &str = "[2000]\nParameterName=a\nObjectType=0x7\nDataType=0x0005\nAccessType=rw\n";

#[test]
fn python_canopen() {
    let codes = |text: &str| codes("python-canopen", text);
    assert_eq!(codes(OBJECT), [""; 0]);
    for (more, expected) in [
        ("PDOMapping=\n", "T0105:6"),
        ("accesstype=ro\nDefaultValue=0x1F\n", ""),
        ("DefaultValue=08\n", "T0112:6"),
        ("DefaultValue=7 ; seven\n", ""),
        ("DefaultValue=7 # seven\n", "T0112:6"),
        ("DefaultValue=300\nLowLimit=1e1\n", ""),
        ("AccessType=ro\n", "T0103:6"),
        ("word\n", "T0102:6"),
        ("[2000]\n", "T0103:6"),
        ("[3000sub0]\n", "T0106:6"),
        ("[2000Name]\nNrOfEntries=1\n1=b\n", "T0107:6"),
        (
            "[2001]\nParameterName=b\nDataType=0x0007\nAccessType=rw\nDefaultValue=$NODEID\n",
            "T0112:10",
        ),
        (
            "[2001]\nParameterName=b\nObjectType=0x5\nDataType=0x0007\n",
            "T0111:6",
        ),
        (
            "[2001]\nParameterName=b\nObjectType=8\nCompactSubObj=2\nDataType=7\nAccessType=ro\n",
            "T0115:9",
        ),
        ("[Comments]\nLines=1\n", "T0104:6"),
        ("[DeviceInfo]\nGranularity=8 bit\n", "T0105:7"),
    ] {
        let expected: Vec<&str> = expected.split_whitespace().collect();
        assert_eq!(codes(&format!("{OBJECT}{more}")), expected, "{more}");
    }
    assert_eq!(codes(&format!("x\n{OBJECT}")), ["T0102:1"]);
    assert_eq!(codes("\u{FEFF}[FileInfo]\n"), ["T0101:0"]);
    // A deeper line continues the value above it.
    assert_eq!(
        codes(&OBJECT.replace("\nAccess", "\n Access")),
        ["T0104:1", "T0105:4"]
    );
}

/// Each other tool rejects or drops its part of the files.
#[test]
fn other_tools() {
    let file = "[FileInfo]\n[DeviceInfo]\n[MandatoryObjects]\nSupportedObjects=0\n[OptionalObjects]\n\
        SupportedObjects=2\n1=0x1000\n2=0x1018\n[ManufacturerObjects]\nSupportedObjects=1\n1=0x2000\n\
        [1000]\nParameterName=a\nDataType=7\nAccessType=ro\nDefaultValue=1\n[1018]\nParameterName=b\nObjectType=9\n\
        SubNumber=2\n[1018sub0]\nParameterName=c\nDataType=5\nAccessType=ro\nDefaultValue=1\n[1018sub1]\n\
        ParameterName=d\nDataType=7\nAccessType=ro\nDefaultValue=0x5\n";
    for (tool, more, expected) in [
        ("dcf-tools", "", ""),
        ("dcf-tools", "DefaultValue=0xFF\nLowLimit=010\n", "T0206:37"),
        ("dcf-tools", "DefaultValue=300\n", "T0209:36"),
        ("dcf-tools", "Unit=mm\n", "T0204:36"),
        ("dcf-tools", "[Tools]\n", "T0204:36"),
        ("dcf-tools", "[2000sub1]\n", "T0205:36 T0205:36"),
        ("npm-canopen", "", ""),
        ("npm-canopen", "DefaultValue=010\n", "T0312:36"),
        ("npm-canopen", "DefaultValue=300\n", "T0306:36"),
        ("npm-canopen", "[2001]\nParameterName=x\n", "T0301:36"),
        (
            "npm-canopen",
            "[2000sub1]\nParameterName=x\nDataType=5\n",
            "T0304:36",
        ),
        ("canopen-rs", "", ""),
        ("canopen-rs", "DefaultValue=0x10 ; sixteen\n", "T0403:36"),
        ("canopen-rs", "DefaultValue=010\n", "T0412:36"),
        ("canopennode-editor", "", ""),
        (
            "canopennode-editor",
            "[2001]\nParameterName=x\nDataType=5\n",
            "T0611:36 T0603:36",
        ),
        ("codesys", "", ""),
        ("twincat", "", ""),
    ] {
        let text = format!("{file}{OBJECT}{more}");
        let expected: Vec<&str> = expected.split_whitespace().collect();
        assert_eq!(codes(tool, &text), expected, "{tool}: {more}");
    }
    assert_eq!(codes("canopennode-editor", OBJECT).len(), 3);
    assert_eq!(codes("codesys", "<?xml version='1.0'?>\n"), ["T0701:1"]);
    assert_eq!(
        codes("twincat", &file.replace("DefaultValue=1\n[1018]", "[1018]")),
        ["T0801:12"]
    );
}

/// A fix that one tool can read and another cannot is not offered for both.
#[test]
fn a_fix_suits_every_chosen_tool() {
    let findings = found("python-canopen", &format!("{OBJECT}DefaultValue=010\n"));
    let fix = findings[0].fix.as_ref().unwrap();
    assert_eq!(fix.edits[0].text, "8");
}
