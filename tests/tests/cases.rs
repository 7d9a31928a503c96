//! EDS in, diagnostics out: one folder of `tests/cases` is one case.
//!
//! `ODKIT_ACCEPT=1` writes the findings into `diagnostics.txt`; read it before
//! committing it. `tests/corpus` has files with one trait of real files each;
//! `ODKIT_CORPUS` names another folder to read instead.

use std::collections::{BTreeMap, BTreeSet};
use std::fmt::Write as _;
use std::path::{Path, PathBuf};
use std::{env, fs};

use od_eds::{Document, Parsed};
use od_eds::{Eds, Severity, Tables, check, say};
use od_tests::corpus;

#[test]
fn diagnostics_are_as_accepted() {
    let mut wrong = Vec::new();
    let cases = cases();
    for case in &cases {
        let found = rendered(&case.document);
        let path = case.folder.join("diagnostics.txt");
        if env::var_os("ODKIT_ACCEPT").is_some() {
            fs::write(&path, &found).expect("the case's folder is writable");
            continue;
        }
        let accepted = fs::read_to_string(&path).unwrap_or_default();
        if accepted.replace("\r\n", "\n") != found {
            wrong.push(format!("{}:\n{}", case.name, difference(&accepted, &found)));
        }
    }
    assert!(
        wrong.is_empty(),
        "{}\n`ODKIT_ACCEPT=1 cargo test -p od-tests --test cases` accepts them",
        wrong.join("\n")
    );
    assert!(cases.len() >= 25, "{} cases", cases.len());
}

#[test]
fn every_case_is_read_again_from_its_own_text() {
    for case in cases() {
        if let Err(fault) = round_trip(&case.document) {
            panic!("{}: {fault}", case.name);
        }
    }
}

#[test]
fn the_corpus_is_read_and_written_again() {
    let files = corpus::files(&corpus::folder(), corpus::ALL);
    assert!(files.len() >= 60, "{} files", files.len());
    let mut by_code: BTreeMap<&str, (usize, usize)> = BTreeMap::new();
    for file in &files {
        let bytes = fs::read(file).expect("a file of the corpus is readable");
        let document = Document::new(bytes);
        let name = file.display();
        let loaded = round_trip(&document).unwrap_or_else(|fault| panic!("{name}: {fault}"));
        assert!(!loaded.description.objects.is_empty(), "{name}: no objects");
        let mut codes = BTreeMap::new();
        for finding in &loaded.findings {
            *codes.entry(finding.code()).or_insert(0) += 1;
        }
        if env::var_os("ODKIT_VERBOSE").is_some() {
            let entries = loaded.description.entries().count();
            println!("{name}: {entries} entries {codes:?}");
        }
        for (code, count) in codes {
            let (files, findings) = by_code.entry(code).or_default();
            *files += 1;
            *findings += count;
        }
    }
    println!("{} files; by code: files, findings", files.len());
    for (code, (files, findings)) in by_code {
        println!("{code} {files:4} {findings:6}");
    }
}

/// The first lines of each file in `tests/corpus` name its trait, and the codes that odkit reports for it.
#[test]
fn each_file_of_our_corpus_shows_its_trait() {
    let mut wrong = Vec::new();
    let mut traits = BTreeSet::new();
    for file in corpus::files(&corpus::own(), corpus::ALL) {
        let bytes = fs::read(&file).expect("a file of the corpus is readable");
        let document = Document::new(bytes).named(file.display().to_string());
        let line = |name: &str| {
            let mut lines = document.text().lines().take(3);
            let text = lines
                .find_map(|line| line.split_once(name))
                .map(|(_, text)| text);
            text.map(|text| text.trim_end_matches("-->").trim().to_owned())
        };
        let name = file.file_name().unwrap_or_default().display().to_string();
        let (Some(trait_), Some(expected)) = (line("Trait: "), line("Reports: ")) else {
            wrong.push(format!(
                "{name}: the first lines lack `Trait: ` or `Reports: `"
            ));
            continue;
        };
        if !traits.insert(trait_) {
            wrong.push(format!("{name}: another file has the same trait"));
        }
        let loaded = document.load();
        let codes: BTreeSet<&str> = loaded.findings.iter().map(|found| found.code()).collect();
        let found = if codes.is_empty() {
            "nothing".to_owned()
        } else {
            Vec::from_iter(codes).join(", ")
        };
        if expected != found {
            wrong.push(format!(
                "{name}: odkit reports {found}, the file says {expected}"
            ));
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
    assert!(traits.len() >= 60, "{} files", traits.len());
}

/// Flipped bytes, cut and doubled lines: there is never a panic, and a written text is read with
/// the same result. `ODKIT_ROUNDS` sets the number of rounds.
#[test]
fn broken_texts_are_read_without_a_panic() {
    let texts: Vec<String> = cases()
        .into_iter()
        .map(|case| case.document.text().into())
        .collect();
    let mut random = Xorshift(0x9E37_79B9_7F4A_7C15);
    let rounds = env::var("ODKIT_ROUNDS").ok().and_then(|n| n.parse().ok());
    for round in 0..rounds.unwrap_or(1000) {
        let mut bytes = texts[random.below(texts.len())].clone().into_bytes();
        for _ in 0..=random.below(6) {
            mutate(&mut bytes, &texts, &mut random);
        }
        let document = Document::new(bytes);
        if let Err(fault) = round_trip(&document) {
            panic!("round {round}: {fault}\n{}", document.text());
        }
    }
}

/// Bytes with a meaning for some parser of such files.
const ODD: &[u8] = b"=[];#\\:$-+0x19AF\r\n \"\xFF";

fn mutate(bytes: &mut Vec<u8>, texts: &[String], random: &mut Xorshift) {
    if bytes.is_empty() {
        bytes.push(b'[');
    }
    let at = random.below(bytes.len());
    let line = |at: usize, bytes: &[u8]| {
        let start = bytes[..at].iter().rposition(|b| *b == b'\n');
        let end = bytes[at..].iter().position(|b| *b == b'\n');
        start.map_or(0, |s| s + 1)..end.map_or(bytes.len(), |e| at + e + 1)
    };
    match random.below(7) {
        0 => bytes[at] ^= 1 << random.below(8),
        1 => bytes[at] = ODD[random.below(ODD.len())],
        2 => {
            let range = line(at, bytes);
            bytes.drain(range);
        }
        3 => {
            let copy = bytes[line(at, bytes)].to_vec();
            bytes.splice(at..at, copy);
        }
        4 => {
            let range = line(at, bytes);
            let copy = bytes[range.clone()].to_vec();
            bytes.splice(range.start..range.start, copy);
        }
        5 => bytes.truncate(at),
        _ => {
            let other = texts[random.below(texts.len())].as_bytes();
            if !other.is_empty() {
                let copy = other[line(random.below(other.len()), other)].to_vec();
                let start = line(at, bytes).start;
                bytes.splice(start..start, copy);
            }
        }
    }
}

struct Xorshift(u64);

impl Xorshift {
    fn below(&mut self, end: usize) -> usize {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        (self.0 % end as u64) as usize
    }
}

/// Reads, writes and reads again; checks all properties of any text.
fn round_trip(document: &Document) -> Result<Parsed, String> {
    let text = document.text();
    let loaded = document.load();
    let mut unedited = document.clone();
    if unedited.apply(&[]).is_err() || unedited != *document {
        return Err("an unedited document differs".into());
    }
    let written = od_eds::write(&loaded.description);
    let again = od_eds::parse(&written).description;
    if again != loaded.description {
        return Err(format!(
            "read again, the text differs:\n{}",
            difference(
                &format!("{:#?}", loaded.description),
                &format!("{again:#?}")
            )
        ));
    }
    let canonical = od_eds::canonical(&again);
    let twice = od_eds::canonical(&od_eds::parse(&canonical).description);
    if twice != canonical {
        return Err(format!(
            "written again, the canonical text differs:\n{}",
            difference(&canonical, &twice)
        ));
    }
    let tables = Tables::new(&loaded.description);
    let dictionary = tables.dictionary();
    for entry in dictionary.entries() {
        if dictionary.find(entry.address) != Ok(entry) {
            return Err(format!("{} is not found", entry.address));
        }
    }
    let mut line = 0;
    for finding in &loaded.findings {
        let finding = say(finding, &Eds);
        if check::rule(finding.code).is_none() {
            return Err(format!("{} is not a rule", finding.code));
        }
        if finding.message.is_empty() || finding.help.is_empty() {
            return Err(format!("{} says too little", finding.code));
        }
        let spans = finding.labels.iter().map(|label| label.span);
        for span in finding.span.into_iter().chain(spans) {
            let range = span.start as usize..span.end as usize;
            if text.get(range).is_none() || span.line == 0 || span.column == 0 {
                return Err(format!("{} points nowhere: {span:?}", finding.code));
            }
        }
        let at = finding.span.map_or(u32::MAX, |span| span.line);
        if at < line {
            return Err(format!("{} is not in file order", finding.code));
        }
        line = at;
    }
    Ok(loaded)
}

fn rendered(document: &Document) -> String {
    let mut out = String::new();
    for finding in &document.load().findings {
        let finding = say(finding, &Eds);
        let place = match finding.span {
            Some(span) => format!("{}:{}", span.line, span.column),
            None => "-".into(),
        };
        let severity = match finding.severity {
            Severity::Error => "error",
            Severity::Warning => "warning",
            Severity::Info => "info",
        };
        let address = finding.address.map(|a| format!(" {a}")).unwrap_or_default();
        let code = finding.code;
        let _ = writeln!(
            out,
            "{place}: {code} {severity}{address} {}",
            finding.message
        );
        for label in finding.labels {
            let (line, column) = (label.span.line, label.span.column);
            let _ = writeln!(out, "    {line}:{column}: {}", label.text);
        }
        let _ = writeln!(out, "    help: {}", finding.help);
    }
    out
}

/// The lines that only one of two texts has.
fn difference(accepted: &str, found: &str) -> String {
    let mut out = String::new();
    for (sign, a, b) in [('-', accepted, found), ('+', found, accepted)] {
        let other: Vec<&str> = b.lines().collect();
        for line in a.lines().filter(|line| !other.contains(line)) {
            let _ = writeln!(out, "{sign}{line}");
        }
    }
    out
}

struct Case {
    name: String,
    folder: PathBuf,
    document: Document,
}

/// Every folder of `tests/cases` with an `input.eds` or `input.xdd`, by name.
fn cases() -> Vec<Case> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("cases");
    let mut cases = Vec::new();
    for entry in fs::read_dir(root).expect("tests/cases is there") {
        let folder = entry.expect("a folder can be listed").path();
        let inputs = ["input.eds", "input.xdd"].map(|name| folder.join(name));
        let Some(bytes) = inputs.iter().find_map(|path| fs::read(path).ok()) else {
            continue;
        };
        cases.push(Case {
            name: folder.file_name().unwrap_or_default().display().to_string(),
            folder,
            document: Document::new(bytes),
        });
    }
    cases.sort_by(|a, b| a.name.cmp(&b.name));
    cases
}
