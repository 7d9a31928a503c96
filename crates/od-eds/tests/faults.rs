//! Files with one fault each, and valid ones that look odd: `faults.txt` says what is edited in `faults.eds`,
//! and which finding is at which line.
//!
//! `ODKIT_FAULTS=name cargo test -p od-eds --test faults -- --nocapture` shows the file of a case.

use std::collections::BTreeMap;
use std::fmt::Write;

use od_eds::{Document, Finding, Severity};

const BASE: &str = include_str!("faults.eds");
const TABLE: &str = include_str!("faults.txt");

/// The lists, each with the objects that it has.
const LISTS: [&str; 3] = ["MandatoryObjects", "OptionalObjects", "ManufacturerObjects"];

/// A case of the table.
struct Case<'a> {
    /// The code that is expected at the marked line; `V` for a valid file.
    wanted: &'a str,
    name: &'a str,
    edits: Vec<&'a str>,
}

/// A line of the file, and whether the finding is expected there.
type Line = (String, bool);

/// A file as it is edited: sections with their header and lines.
struct File {
    sections: Vec<(String, Vec<Line>)>,
    /// Lists that the case itself edits.
    own_lists: bool,
}

impl File {
    fn base() -> Self {
        let mut sections: Vec<(String, Vec<Line>)> = Vec::new();
        for line in BASE.lines() {
            if let Some(name) = line.strip_prefix('[') {
                sections.push((
                    name.trim_end_matches(']').into(),
                    vec![(line.into(), false)],
                ));
            } else if let Some((_, lines)) = sections.last_mut() {
                lines.push((line.into(), false));
            }
        }
        Self {
            sections,
            own_lists: false,
        }
    }

    /// The lines of a section, which is added if it is new.
    fn section(&mut self, name: &str) -> &mut Vec<Line> {
        let known = |section: &(String, _)| section.0.eq_ignore_ascii_case(name);
        let at = self.sections.iter().position(known).unwrap_or_else(|| {
            let lines = vec![(format!("[{name}]"), false), (String::new(), false)];
            self.sections.push((name.into(), lines));
            self.sections.len() - 1
        });
        &mut self.sections[at].1
    }

    /// Makes one edit.
    fn edit(&mut self, edit: &str) {
        let (name, what) = edit.split_once("] ").expect("a section and an edit");
        let (at_header, name) = match name.strip_prefix('!') {
            Some(name) => (true, &name[1..]),
            None => (false, &name[1..]),
        };
        self.own_lists |= LISTS.contains(&name);
        let (marked, what) = match what.strip_prefix('!') {
            Some(what) => (true, what),
            None => (false, what),
        };
        let lines = self.section(name);
        lines[0].1 |= at_header;
        match what.split_at_checked(1) {
            _ if what == "--" => self.sections.retain(|section| section.0 != name),
            Some((">", header)) => lines[0] = (header.into(), marked),
            Some(("+", line)) => {
                lines.pop();
                lines.extend([(line.into(), marked), (String::new(), false)]);
            }
            Some(("-", key)) => {
                let start = format!("{key}=");
                lines.retain(|(line, _)| !line.starts_with(&start));
            }
            Some(("=", row)) => {
                lines[0].1 |= marked;
                value(lines, row);
            }
            Some(("*", row)) => {
                lines[0].1 |= marked;
                self.array(name, row);
            }
            _ => set(lines, what, marked),
        }
    }

    fn array(&mut self, name: &str, row: &str) {
        let fields: Vec<&str> = row.split('|').collect();
        let values = &fields[3..];
        let own = self.section(name);
        set(own, &format!("ParameterName={}", fields[0]), false);
        set(own, "ObjectType=0x8", false);
        set(own, &format!("SubNumber={}", values.len() + 1), false);
        let count = format!("Highest sub-index supported|5|const|{}", values.len());
        value(self.section(&format!("{name}sub0")), &count);
        for (sub, default) in values.iter().enumerate() {
            let row = format!(
                "{} {}|{}|{}|{default}",
                fields[0],
                sub + 1,
                fields[1],
                fields[2]
            );
            value(self.section(&format!("{name}sub{:X}", sub + 1)), &row);
        }
    }

    /// Adds objects that are new to their list, and takes out those that are gone.
    fn list(&mut self) {
        for (at, list) in LISTS.iter().enumerate() {
            let objects: Vec<String> = self
                .sections
                .iter()
                .map(|(name, _)| name.clone())
                .filter(|name| name.len() == 4)
                .filter(|name| match u16::from_str_radix(name, 16) {
                    Ok(0x1000 | 0x1001 | 0x1018) => at == 0,
                    Ok(0x2000..=0x5FFF) => at == 2,
                    index => index.is_ok() && at == 1,
                })
                .collect();
            let lines = self.section(list);
            lines.truncate(1);
            lines.push((format!("SupportedObjects={}", objects.len()), false));
            let entries = (1..).zip(objects);
            lines.extend(entries.map(|(number, index)| (format!("{number}=0x{index}"), false)));
            lines.push((String::new(), false));
        }
    }

    /// The text, and the number of the marked line.
    fn text(&self) -> (String, Option<u32>) {
        let lines: Vec<&Line> = self.sections.iter().flat_map(|(_, lines)| lines).collect();
        let marked = (1..).zip(&lines).find(|(_, line)| line.1);
        let text: Vec<&str> = lines.iter().map(|line| line.0.as_str()).collect();
        (text.join("\n"), marked.map(|(number, _)| number))
    }
}

/// Sets a key, which is added after the others if it is new.
fn set(lines: &mut Vec<Line>, pair: &str, marked: bool) {
    let (key, _) = pair.split_once('=').expect("a key and a value");
    let start = format!("{key}=");
    match lines.iter_mut().find(|(line, _)| line.starts_with(&start)) {
        Some(line) => *line = (pair.into(), line.1 || marked),
        None => lines.insert(lines.len() - 1, (pair.into(), marked)),
    }
}

/// Makes a VAR of `name|type|access|default`.
fn value(lines: &mut Vec<Line>, row: &str) {
    let [name, data_type, access, default] = row.split('|').collect::<Vec<_>>()[..] else {
        panic!("{row}");
    };
    set(lines, &format!("ParameterName={name}"), false);
    for pair in ["ObjectType=0x7", &format!("DataType=0x{data_type:0>4}")] {
        set(lines, pair, false);
    }
    set(lines, &format!("AccessType={access}"), false);
    set(lines, &format!("DefaultValue={default}"), false);
    set(lines, "PDOMapping=0", false);
}

/// The cases, and the kinds that they refer to.
fn cases() -> Vec<Case<'static>> {
    let (cases, kinds) = TABLE.split_once("## Kinds\n").expect("kinds at the end");
    let mut known: BTreeMap<&str, Vec<&str>> = BTreeMap::new();
    let mut name = "";
    for line in kinds.lines() {
        if line.starts_with('%') {
            name = line
        } else {
            known.entry(name).or_default().push(line)
        }
    }
    let mut found: Vec<Case<'_>> = Vec::new();
    for line in cases.lines().filter(|line| !line.starts_with('#')) {
        match (line.as_bytes(), line.split_once(' ')) {
            ([b'[' | b'!', ..], _) => found.last_mut().expect("a case").edits.push(line),
            ([b'%', ..], _) => found.last_mut().expect("a case").edits.extend(&known[line]),
            (_, Some((wanted, name))) => found.push(Case {
                wanted,
                name,
                edits: Vec::new(),
            }),
            _ => panic!("{line}"),
        }
    }
    found
}

/// The findings of a case, and the line where one is expected.
fn run(case: &Case<'_>) -> (Vec<Finding>, Option<u32>) {
    let mut file = File::base();
    case.edits.iter().for_each(|edit| file.edit(edit));
    if !file.own_lists && !case.edits.is_empty() {
        file.list();
    }
    let (text, line) = file.text();
    if std::env::var("ODKIT_FAULTS").as_deref() == Ok(case.name) {
        println!("{text}");
    }
    (Document::new(text.as_bytes()).load().findings, line)
}

/// Returns the findings in a few words.
fn shown(findings: &[Finding]) -> String {
    let all = findings.iter().map(|finding| {
        let line = finding.span().map_or(0, |span| span.line);
        format!("{}@{line}", finding.code())
    });
    all.collect::<Vec<_>>().join(" ")
}

#[test]
fn each_fault_is_found_at_its_line() {
    let (mut faults, mut missed, mut report) = (0, 0, String::new());
    for case in cases().iter().filter(|case| case.wanted != "V") {
        faults += 1;
        let (findings, line) = run(case);
        let there = |finding: &&Finding| match (finding.span(), line) {
            (Some(span), Some(line)) => span.line == line,
            (None, None) => true,
            _ => false,
        };
        let wanted = match case.wanted {
            "E" => Severity::Error,
            "W" => Severity::Warning,
            _ => Severity::Info,
        };
        let is_wanted = |finding: &&Finding| match case.wanted.len() {
            1 => finding.severity() >= wanted,
            _ => finding.code() == case.wanted,
        };
        let found = findings
            .iter()
            .filter(there)
            .find(|finding| is_wanted(finding));
        if std::env::var("ODKIT_FAULTS").as_deref() == Ok("all") {
            println!(
                "{} {}",
                found.map_or(case.wanted, |found| found.code()),
                case.name
            );
        }
        if found.is_none() {
            missed += 1;
            let at = line.unwrap_or(0);
            let found = shown(&findings);
            let _ = writeln!(
                report,
                "{} {}: line {at}, found {found}",
                case.wanted, case.name
            );
        }
    }
    assert!(report.is_empty(), "{report}{missed} of {faults} missed");
    assert!(faults >= 256);
}

#[test]
fn valid_files_have_no_finding() {
    let (mut valid, mut report) = (0, String::new());
    for case in cases().iter().filter(|case| case.wanted == "V") {
        valid += 1;
        let (mut findings, _) = run(case);
        findings.retain(|finding| finding.severity() > Severity::Info);
        if !findings.is_empty() {
            let _ = writeln!(report, "{}: {}", case.name, shown(&findings));
        }
    }
    assert!(report.is_empty(), "{report}");
    assert!(valid >= 40);
}
