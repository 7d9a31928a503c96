//! The table agrees with itself and with the sources.

use std::fs;
use std::path::Path;
use std::string::String;
use std::vec::Vec;

use super::*;
use crate::codes::rule;
use crate::finding::Severity;

#[test]
fn codes_are_unique_and_ascending() {
    for pair in RULES.windows(2) {
        assert!(pair[0].code[1..] < pair[1].code[1..], "{}", pair[1].code);
    }
    for r in RULES {
        // A code never changes its name. Some severities were raised because a master stops; none
        // was lowered.
        let letter = match r.code.as_bytes().first() {
            Some(b'E') => Severity::Error,
            Some(b'W') => Severity::Warning,
            Some(b'I') => Severity::Info,
            _ => panic!("{}", r.code),
        };
        assert!(r.severity >= letter, "{}", r.code);
        assert_eq!(r.code.len(), 5);
        assert!(!r.title.is_empty() && !r.why.is_empty() && !r.source.is_empty());
    }
}

/// A code in a comment or a test is that of a rule.
#[test]
fn every_code_in_the_sources_is_a_rule() {
    let mut sources = Vec::new();
    read(
        &Path::new(env!("CARGO_MANIFEST_DIR")).join("src"),
        &mut sources,
    );
    for source in &sources {
        let bytes = source.as_bytes();
        for at in 1..bytes.len().saturating_sub(5) {
            let code = &bytes[at..at + 5];
            if matches!(code[0], b'E' | b'W' | b'I')
                && code[1] == b'0'
                && code[2..].iter().all(u8::is_ascii_digit)
                && !bytes[at - 1].is_ascii_alphanumeric()
                && !bytes[at + 5].is_ascii_alphanumeric()
            {
                let code = &source[at..at + 5];
                assert!(rule(code).is_some(), "{code} is not the code of a rule");
            }
        }
    }
}

fn read(folder: &Path, sources: &mut Vec<String>) {
    for entry in fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.is_dir() {
            read(&path, sources);
        } else if !path.components().any(|part| part.as_os_str() == "rules") {
            sources.push(fs::read_to_string(path).unwrap());
        }
    }
}
