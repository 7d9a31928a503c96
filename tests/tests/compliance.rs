//! docs/COMPLIANCE.md: each clause that a node implements, its code, and the scripts that show it.
//!
//! `tests/conformance/clauses.txt` lists the clauses. Code names a clause in its documentation
//! (`/// CiA 301, 7.2.4.3.3`), a script in its first lines, and a case of `odkit conform` as its clause.
//! `ODKIT_ACCEPT=1 cargo test -p od-tests --test compliance` writes the page again.

use std::collections::BTreeMap;
use std::fmt::Write;
use std::fs;
use std::path::{Path, PathBuf};

use od_tests::scripts::{self, Header, cell, compare_page};

/// Crates whose code implements clauses: the node, its frames, and a master.
const CODE: [&str; 4] = [
    "crates/od-wire/src",
    "crates/od-runtime/src",
    "crates/od-client/src",
    "devices/src",
];
/// Documents with clauses, in the order of the page.
const DOCUMENTS: [&str; 6] = [
    "CiA 301",
    "CiA 305",
    "CiA 406",
    "Manual 000",
    "Manual 001",
    "Manual 003",
];
/// Chapters of the manuals, each with the index of its first object.
const OBJECTS: [(&str, u32, &str); 7] = [
    ("Manual 000", 0x1000, "4.4.2"),
    ("Manual 001", 0x6000, "12.3"),
    ("Manual 001", 0x2000, "12.2"),
    ("Manual 001", 0x1000, "12.1"),
    ("Manual 003", 0x6000, "7.1.3"),
    ("Manual 003", 0x2000, "7.1.2"),
    ("Manual 003", 0x1000, "7.1.1"),
];
/// Maximum number of links in a cell; further ones are only counted.
const SHOWN: usize = 8;

/// A clause of a document.
#[derive(Clone, PartialEq, Eq, PartialOrd, Ord, Debug)]
struct Place {
    document: String,
    clause: String,
}

/// A line of clauses.txt.
struct Clause {
    place: Place,
    subject: String,
    /// Reason why no script shows it; empty if a script does.
    reason: String,
}

fn clauses() -> Vec<Clause> {
    let text = fs::read_to_string(scripts::root().join("clauses.txt")).expect("the clauses");
    let lines = text
        .lines()
        .filter(|line| !line.is_empty() && !line.starts_with('#'));
    lines
        .map(|line| {
            let [document, clause, subject, reason] = line.split('|').collect::<Vec<_>>()[..]
            else {
                panic!("clauses.txt: `{line}` is not document | clause | subject | reason");
            };
            let [document, clause, subject, reason] =
                [document, clause, subject, reason].map(|text| String::from(text.trim()));
            assert!(
                DOCUMENTS.contains(&&*document),
                "clauses.txt: `{document}` is not a document"
            );
            Clause {
                place: Place { document, clause },
                subject,
                reason,
            }
        })
        .collect()
}

/// The clauses that a text names, such as `CiA 301, 7.2.4.3.9 to 7.2.4.3.11`, or an object of a document.
fn named(text: &str) -> Vec<Place> {
    let text = text.replace("manual 00", "Manual 00");
    let mut found = Vec::new();
    let mut starts: Vec<(usize, &str)> = DOCUMENTS
        .iter()
        .flat_map(|name| text.match_indices(name))
        .collect();
    starts.sort_unstable();
    for (at, document) in starts {
        let rest = &text[at + document.len()..];
        let is_end = |c: char| matches!(c, ';' | ')' | '(' | '"' | '\n');
        let mut end = rest.find(is_end).unwrap_or(rest.len());
        end = end.min(rest.find(": ").unwrap_or(end));
        for other in DOCUMENTS {
            end = end.min(rest.find(other).unwrap_or(end));
        }
        let place = |clause: &str| Place {
            document: String::from(document),
            clause: String::from(clause),
        };
        let mut last: Option<&str> = None;
        let mut is_range = false;
        for word in rest[..end].split([' ', ',', '–']) {
            let word = word.trim_end_matches(['.', ':']);
            let object = object(word).filter(|index| *index >= 0x1000);
            let is_clause = word.contains('.') && word.split('.').all(is_number);
            if is_clause && let Some(from) = last.take().filter(|_| is_range) {
                found.extend(between(from, word).iter().map(|clause| place(clause)));
            } else if is_clause {
                found.push(place(word));
                last = Some(word);
            } else if let Some(index) = object {
                found.push(place(&format!("{index:04X}h")));
            }
            is_range = word == "to" || (is_range && word.is_empty());
        }
    }
    found
}

fn is_number(part: &str) -> bool {
    !part.is_empty() && part.bytes().all(|b| b.is_ascii_digit())
}

/// The index in a word such as `1800h:01`.
fn object(word: &str) -> Option<u32> {
    let (digits, rest) = word.split_once('h')?;
    let is_index = digits.len() == 4 && (rest.is_empty() || rest.starts_with(':'));
    is_index
        .then(|| u32::from_str_radix(digits, 16).ok())
        .flatten()
}

/// The clauses after the first, up to the last one, which differ in their last number.
fn between(first: &str, last: &str) -> Vec<String> {
    let parts = |clause: &str| {
        let (chapter, number) = clause.rsplit_once('.')?;
        Some((String::from(chapter), number.parse::<u32>().ok()?))
    };
    match (parts(first), parts(last)) {
        (Some((chapter, from)), Some((same, to))) if chapter == same => (from + 1..=to)
            .map(|number| format!("{chapter}.{number}"))
            .collect(),
        _ => vec![String::from(last)],
    }
}

/// Places that implement or show a clause, as Markdown.
#[derive(Default)]
struct Evidence(BTreeMap<Place, Vec<String>>);

impl Evidence {
    fn add(&mut self, place: Place, link: &str) {
        let links = self.0.entry(place).or_default();
        if !links.iter().any(|known| known == link) {
            links.push(String::from(link));
        }
    }

    /// The links of a clause and of the clauses below it.
    fn of(&self, place: &Place) -> Vec<&str> {
        let below = format!("{}.", place.clause);
        let own = self.0.iter().filter(|(other, _)| {
            other.document == place.document
                && (other.clause == place.clause || other.clause.starts_with(&below))
        });
        let mut links: Vec<&str> = own
            .flat_map(|(_, links)| links)
            .map(String::as_str)
            .collect();
        links.sort_unstable();
        links.dedup();
        links
    }
}

/// Scripts by clause: the clauses in their first lines, the objects there, and those of their case.
fn shown(clauses: &[Clause]) -> Evidence {
    let mut evidence = Evidence::default();
    let cases = cases();
    for file in scripts::all() {
        let text = fs::read_to_string(&file.path).expect("a script is UTF-8");
        let header = Header::parse(&text).unwrap_or_else(|what| panic!("{}: {what}", file.name));
        let short = file.name.trim_end_matches(".script");
        let link = format!("[{short}](../tests/conformance/{})", file.name);
        let case = header.source.strip_prefix("CiA case ");
        let mut places = named(&format!("{}: {}", header.source, header.rule));
        places.extend(case.and_then(|number| cases.get(number)).cloned());
        for place in places {
            for other in of_object(&place, clauses) {
                evidence.add(other, &link);
            }
            evidence.add(place, &link);
        }
    }
    for case in od_tools::conform::case::built_in() {
        for place in named(&case.clause) {
            evidence.add(place, &format!("`odkit conform --only {}`", case.id));
        }
    }
    evidence
}

/// The clauses about an object that a script or code names: those of CiA, and the chapter of its manual.
fn of_object(place: &Place, clauses: &[Clause]) -> Vec<Place> {
    let Some(index) = object(&place.clause) else {
        return Vec::new();
    };
    let mut found: Vec<Place> = OBJECTS
        .iter()
        .find(|(document, from, _)| *document == place.document && index >= *from)
        .map(|(document, _, chapter)| Place {
            document: String::from(*document),
            clause: String::from(*chapter),
        })
        .into_iter()
        .collect();
    let is_about = |clause: &&Clause| {
        let mut indices = clause.subject.split(' ').filter_map(object);
        match (indices.next(), indices.next()) {
            (Some(first), Some(last)) => (first..=last).contains(&index),
            (Some(first), None) => first == index,
            _ => false,
        }
    };
    found.extend(
        clauses
            .iter()
            .filter(is_about)
            .map(|clause| clause.place.clone()),
    );
    found
}

/// The clause of each case of `cia/cases.txt`, by its number.
fn cases() -> BTreeMap<String, Place> {
    let text = fs::read_to_string(scripts::root().join("cia/cases.txt")).expect("the cases");
    let mut found = BTreeMap::new();
    for line in text.lines().filter(|line| !line.starts_with('#')) {
        let mut cells = line.split('|').map(str::trim);
        let (Some(number), Some(clause)) = (cells.next(), cells.next()) else {
            continue;
        };
        if clause != "-" {
            let place = Place {
                document: String::from("CiA 301"),
                clause: String::from(clause),
            };
            found.insert(String::from(number), place);
        }
    }
    found
}

/// Items of the code by the clause that their documentation names.
fn carried_out(clauses: &[Clause]) -> Evidence {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("..");
    let mut evidence = Evidence::default();
    for room in CODE {
        let mut files = Vec::new();
        sources(&root.join(room), &mut files);
        files.sort();
        for path in files {
            let text = fs::read_to_string(&path).expect("a source is UTF-8");
            let relative = path.strip_prefix(&root).expect("it is below the root");
            let file = relative.to_string_lossy().replace('\\', "/");
            for (item, documentation) in documented(&text) {
                let name =
                    item.unwrap_or(file.rsplit_once("src/").map_or(&*file, |(_, name)| name));
                let link = format!("[`{name}`](../{file})");
                for place in named(&documentation) {
                    for other in of_object(&place, clauses) {
                        evidence.add(other, &link);
                    }
                    evidence.add(place, &link);
                }
            }
        }
    }
    evidence
}

fn sources(folder: &Path, found: &mut Vec<PathBuf>) {
    for entry in fs::read_dir(folder).expect("a folder of the repository") {
        let path = entry.expect("an entry of a folder").path();
        let name = path.file_name().unwrap_or_default();
        if path.is_dir() && name != "tests" {
            sources(&path, found);
        } else if path.extension().is_some_and(|ending| ending == "rs") && name != "tests.rs" {
            found.push(path);
        }
    }
}

/// Each documentation comment, in one line, and the name of its item; none for that of the file.
fn documented(text: &str) -> Vec<(Option<&str>, String)> {
    let mut found = Vec::new();
    let mut words = String::new();
    let mut of_file = String::new();
    for line in text.lines().map(str::trim) {
        if let Some(line) = line.strip_prefix("//!") {
            of_file += line;
        } else if let Some(line) = line.strip_prefix("///") {
            words += line;
        } else if !line.starts_with("#[") && !words.is_empty() {
            found.push((Some(item(line)), std::mem::take(&mut words)));
        }
    }
    found.push((None, of_file));
    found
}

/// The name that a line declares: after `fn`, `struct` and others, or its first word.
fn item(line: &str) -> &str {
    let declared = line.split(": ").next().unwrap_or(line);
    let mut words = declared.split(|c: char| !c.is_ascii_alphanumeric() && c != '_');
    let is_keyword =
        |word: &&str| ["fn", "struct", "enum", "trait", "type", "static", "mod"].contains(word);
    let mut rest = words.clone().skip_while(|word| !is_keyword(word)).skip(1);
    let not_first = |word: &&str| !["", "pub", "crate", "super", "in", "const"].contains(word);
    rest.next()
        .or_else(|| words.find(not_first))
        .unwrap_or(line)
}

fn links(all: &[&str]) -> String {
    let mut text = all[..all.len().min(SHOWN)].join("<br>");
    if all.len() > SHOWN {
        let _ = write!(text, "<br>and {} more", all.len() - SHOWN);
    }
    text
}

/// The page and all its faults.
fn page() -> (String, Vec<String>) {
    let clauses = clauses();
    let (code, scripts) = (carried_out(&clauses), shown(&clauses));
    let mut wrong = Vec::new();
    let mut text = String::from(
        "# Clauses, code and scripts\n\n\
         Each clause that a node of odkit carries out: the code that names it, and the scripts and cases of\n\
         `odkit conform` that show it. A clause that is not met has its reason. CiA 301 is cited by version 4.2.0,\n\
         CiA 305 by version 3.0.0, CiA 406 by object, and the manuals as in [MANUALS.md](MANUALS.md).\n\n\
         This page is generated from the documentation of the code, the first lines of the scripts, and\n\
         `tests/conformance/clauses.txt`: `ODKIT_ACCEPT=1 cargo test -p od-tests --test compliance`.\n",
    );
    for document in DOCUMENTS {
        let families = match document {
            "Manual 000" => "[`bus_cover.rs`](../devices/src/bus_cover.rs)",
            "Manual 001" => "[`eam.rs`](../devices/src/eam.rs)",
            "Manual 003" => "[`en580c.rs`](../devices/src/en580c.rs)",
            _ => "",
        };
        let families = match families {
            "" => String::new(),
            file => format!(
                "Its encoders are in {file}, on top of the code of CiA 301, 305 and 406.\n\n"
            ),
        };
        let _ = write!(
            text,
            "\n## {document}\n\n{families}| clause | subject | code | script |\n|---|---|---|---|\n"
        );
        for clause in clauses
            .iter()
            .filter(|clause| clause.place.document == document)
        {
            let Place { clause: number, .. } = &clause.place;
            let shown = scripts.of(&clause.place);
            match (clause.reason.is_empty(), shown.is_empty()) {
                (true, true) => wrong.push(format!(
                    "{document}, {number}: no script names it; write one, or the reason in clauses.txt"
                )),
                (false, false) => wrong.push(format!(
                    "{document}, {number}: {} shows it; remove the reason from clauses.txt",
                    shown[0]
                )),
                _ => {}
            }
            let how = if shown.is_empty() {
                format!("– {}", cell(&clause.reason))
            } else {
                links(&shown)
            };
            let own = code.of(&clause.place);
            let object = clause.subject.split(' ').next().and_then(object);
            let code = match (clause.reason.is_empty(), own.is_empty()) {
                (true, false) => links(&own),
                (true, true) if object.is_some() => String::from("a value of the dictionary"),
                (true, true) if document.starts_with("CiA") => {
                    wrong.push(format!(
                        "{document}, {number}: the documentation of no code names it"
                    ));
                    String::new()
                }
                _ => String::new(),
            };
            let _ = writeln!(
                text,
                "| {number} | {} | {code} | {how} |",
                cell(&clause.subject)
            );
        }
    }
    for (evidence, kind) in [(&code, "code"), (&scripts, "a script")] {
        for (place, links) in &evidence.0 {
            let is_listed = clauses.iter().any(|clause| {
                let listed = &clause.place;
                let (short, long) = (format!("{}.", place.clause), format!("{}.", listed.clause));
                listed.document == place.document
                    && (long.starts_with(&short) || short.starts_with(&long))
            });
            if !is_listed && object(&place.clause).is_none() {
                wrong.push(format!(
                    "{}, {}: {kind} names it ({}), but clauses.txt does not list it",
                    place.document, place.clause, links[0]
                ));
            }
        }
    }
    (text, wrong)
}

#[test]
fn every_clause_has_a_script_or_a_reason() {
    let (text, wrong) = page();
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
    if let Err(what) = compare_page("COMPLIANCE.md", &text) {
        panic!("{what}");
    }
}

#[test]
fn clauses_are_found_in_a_text() {
    let places = |text| -> Vec<String> {
        let found = named(text);
        found
            .iter()
            .map(|place| format!("{} {}", place.document, place.clause))
            .collect()
    };
    assert_eq!(
        places("CiA 301, 7.2.4.3.9 to 7.2.4.3.11: block download"),
        [
            "CiA 301 7.2.4.3.9",
            "CiA 301 7.2.4.3.10",
            "CiA 301 7.2.4.3.11"
        ]
    );
    assert_eq!(
        places("manual 000, object 1014h; CiA 301, 7.5.2.17"),
        ["Manual 000 1014h", "CiA 301 7.5.2.17"]
    );
    assert_eq!(places("7.2.4 alone, CiA 302, 7.1"), [] as [&str; 0]);
}
