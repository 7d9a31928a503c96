//! An independent parser: rust-ini reads every section of every case file and of the corpus, and
//! must find the same keys and values as odkit.
//!
//! rust-ini reads a section as it is written. If a line of a section is not plain INI, the two may
//! differ, but then odkit has a finding about this section. Nothing else is skipped.

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::Path;
use std::sync::{Mutex, PoisonError};

use ini::{Ini, ParseOption};
use od_eds::{Document, parse};
use od_tests::corpus;

/// Findings about lines that are not plain INI.
const NOT_PLAIN: [&str; 8] = [
    "W0101", "W0102", "W0103", "E0118", "W0104", "W0105", "W0108", "W0110",
];

/// Prefix of every name: no section of CiA 306 has it.
const MARK: &str = "a section that describes no object, whatever it is called: ";

/// Keys and values in their order.
type Pairs = Vec<(String, String)>;

/// A section as it is written.
struct Chunk {
    /// Its first line, counted from 1, and the line after its last.
    lines: std::ops::Range<u32>,
    text: String,
}

#[derive(Default, Debug)]
struct Sums {
    sections: usize,
    pairs: usize,
    not_plain: usize,
}

#[test]
fn rust_ini_reads_the_same_in_every_case() {
    let here = Path::new(env!("CARGO_MANIFEST_DIR"));
    let mut sums = Sums::default();
    for folder in ["../crates/od-eds/cases", "cases", "../devices/eds"] {
        for file in corpus::files(&here.join(folder), corpus::ALL) {
            compare_file(&file, &mut sums);
        }
    }
    assert!(sums.sections > 5_000 && sums.pairs > 20_000, "{sums:?}");
    assert!(sums.not_plain * 100 < sums.sections, "{sums:?}");
}

#[test]
fn rust_ini_reads_the_same_in_the_corpus() {
    let all = Mutex::new(Sums::default());
    corpus::each(&corpus::files(&corpus::folder(), corpus::ALL), |file| {
        let mut sums = Sums::default();
        compare_file(file, &mut sums);
        let mut all = all.lock().unwrap_or_else(PoisonError::into_inner);
        all.sections += sums.sections;
        all.not_plain += sums.not_plain;
    });
    let sums = all.into_inner().unwrap_or_else(PoisonError::into_inner);
    assert!(sums.not_plain * 100 < sums.sections, "{sums:?}");
}

#[test]
fn rust_ini_reads_all_kinds_of_lines_equally() {
    let plain = [
        "[a]",
        "[]",
        "[b c]",
        "k=v",
        "k = v ",
        "k=",
        ";c",
        " ;c",
        " k=v",
        "\tk=v",
        "\t[c]",
        "k=;v",
        "k=[v]",
        "k=v=w",
        "k=\"v",
        "k='v' x",
        "",
        " ",
        "#c",
        "é=µ",
        "k==",
        "k\u{B}=\u{B}v",
        "k=\0",
        "k=a\\b",
    ];
    let odd = ["[a", "=v", "k", "k:v", "[d] ;x", "[a]]", "\\"];
    let mut sums = Sums::default();
    for a in plain.iter().chain(&odd) {
        for b in plain.iter().chain(&odd) {
            for text in [[a, b, "k=v"].join("\n"), ["[s]", a, b].join("\r\n")] {
                compare(&format!("{text:?}"), &text, &mut sums);
            }
        }
    }
    assert!(sums.not_plain > 500 && sums.sections > 2_000, "{sums:?}");
}

fn compare_file(file: &Path, sums: &mut Sums) {
    let document = Document::new(fs::read(file).unwrap());
    compare(&file.display().to_string(), document.text(), sums);
}

/// Compares both readings of a text, section by section.
fn compare(name: &str, text: &str, sums: &mut Sums) {
    if text.trim_start().starts_with('<') {
        return;
    }
    let chunks = chunks(text);
    // No section of this name describes an object, so a description keeps the section completely.
    let marked: Vec<&str> = chunks.iter().map(|chunk| chunk.text.as_str()).collect();
    let parsed = parse(&marked.concat());
    let mut ours: BTreeMap<u32, (String, Pairs)> = BTreeMap::new();
    for section in parsed.description.sections {
        let pairs = section.pairs.into_iter();
        let pairs = pairs.map(|(key, value)| (key.value, value.value)).collect();
        ours.insert(section.name.span.line, (section.name.value, pairs));
    }
    let findings = parsed.findings.iter();
    let odd: BTreeSet<u32> = findings
        .filter(|finding| NOT_PLAIN.contains(&finding.code()))
        .filter_map(|finding| Some(finding.span()?.line))
        .collect();
    for chunk in &chunks {
        let own = ours.range(chunk.lines.clone()).next();
        let own = own.map(|(_, section)| section.clone());
        let is_plain = odd.range(chunk.lines.clone()).next().is_none();
        let theirs = by_rust_ini(&chunk.text);
        if theirs == Ok(own.clone()) {
            sums.sections += 1;
            sums.pairs += own.map_or(0, |(_, pairs)| pairs.len());
        } else if is_plain {
            let line = chunk.lines.start;
            panic!("{name}: section at line {line}\nours:   {own:?}\ntheirs: {theirs:?}");
        } else {
            sums.not_plain += 1;
        }
    }
}

/// The sections of a text, each with a prefix in its name; the lines before the first section come first.
fn chunks(text: &str) -> Vec<Chunk> {
    let text = text.replace("\r\n", "\n").replace('\r', "\n");
    let mut chunks = Vec::new();
    let mut chunk = Chunk {
        lines: 1..1,
        text: String::new(),
    };
    for (number, line) in (1..).zip(text.split('\n')) {
        let line = line.trim();
        if let Some(name) = line.strip_prefix('[') {
            chunks.push(std::mem::replace(
                &mut chunk,
                Chunk {
                    lines: number..number,
                    text: String::new(),
                },
            ));
            chunk.text = format!("[{MARK}{name}\n");
        } else {
            chunk.text.push_str(line);
            chunk.text.push('\n');
        }
        chunk.lines.end = number + 1;
    }
    chunks.push(chunk);
    chunks
}

/// The section as rust-ini reads it; `None` if it does not exist.
fn by_rust_ini(text: &str) -> Result<Option<(String, Pairs)>, String> {
    // Quotes and backslashes have no meaning in an EDS.
    let option = ParseOption {
        enabled_quote: false,
        enabled_escape: false,
        ..ParseOption::default()
    };
    let ini = Ini::load_from_str_opt(text, option).map_err(|error| error.to_string())?;
    let sections = ini.into_iter().map(|(name, pairs)| {
        let pairs: Pairs = pairs.into_iter().collect();
        (name, pairs)
    });
    let mut sections = sections.filter(|(name, pairs)| name.is_some() || !pairs.is_empty());
    let first = sections
        .next()
        .map(|(name, pairs)| (name.unwrap_or_default(), pairs));
    match sections.next() {
        None => Ok(first),
        Some(more) => Err(format!("{first:?} and {more:?}")),
    }
}
