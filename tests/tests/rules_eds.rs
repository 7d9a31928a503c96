//! docs/RULES-EDS.md agrees with the catalogue of rules.
//!
//! `ODKIT_ACCEPT=1 cargo test -p od-tests --test rules_eds` writes it again.

use std::fmt::Write;

use od_eds::Severity;
use od_eds::check::RULES;
use od_tests::scripts::{cell, compare_page};

const FOLDERS: [(&str, &str); 11] = [
    ("01", "Text and INI structure"),
    ("02", "Lists, sections and keys"),
    ("03", "Objects and their members"),
    ("04", "Types, values and limits"),
    ("05", "PDOs"),
    ("06", "Standard objects, identity and services"),
    ("07", "Edits of a macro call"),
    ("08", "Findings that a file allows"),
    ("09", "Device profiles"),
    ("11", "What a target of `odkit convert` cannot express"),
    ("12", "Networks"),
];

fn page() -> String {
    let mut page = String::from(
        "# Rules for EDS files\n\n\
         These are the rules of `odkit check`. A code never changes; its letter is its first severity. An error makes generated\n\
         code unsound or a master fail; an error marked *builds* is of the second kind, and the macro builds a device all the\n\
         same. A master can cope with the fault of a warning; a remark is worth knowing. A finding whose consequence is another\n\
         one than that of its rule has its own severity. `odkit explain CODE` shows an example before and after.\n\n\
         **Fixes.** `--fix` applies the safe fixes: with them every tool reads what odkit read before.\n\
         `--unsafe-fixes` also applies likely corrections. `--diff` shows both and writes nothing. A fix\n\
         changes no other line and keeps encoding and line ends; a second run changes nothing.\n\n\
         **Allowing.** `;odkit-allow=W0350 reason`, on a line of its own: before the first section and\n\
         in [FileInfo] for the whole file, in a section for the findings there and for all findings\n\
         about its object. On the command line: `--allow W0350` or `--allow W0350:2000`.\n\n\
         **Two's complement.** In a signed type a hexadecimal number above the highest positive value\n\
         is a bit pattern, as wide as the type or sign extended to 32 or 64 bits: `0xFF` is -1 in an\n\
         INTEGER8, and so is `0xFFFFFFFF`. A HighLimit that would come out below a LowLimit of 0 or\n\
         more is read as it is written. A decimal number is its value: 255 is not a valid INTEGER8.\n\n\
         **Exit codes** of `odkit check`: 0 no errors, 1 errors are left, a file could not be read or\n\
         written, or `--diff` shows something, 2 wrong usage. `--strict` counts warnings as errors.\n\n\
         This page is generated from the catalogue in `crates/od-eds/src/rules`:\n\
         `ODKIT_ACCEPT=1 cargo test -p od-tests --test rules_eds`.\n",
    );
    for (number, title) in FOLDERS {
        let _ = write!(
            page,
            "\n## {number}: {title}\n\n| code | severity | what | fix | source |\n|---|---|---|---|---|\n"
        );
        for rule in RULES.iter().filter(|rule| &rule.code[1..3] == number) {
            let severity = match rule.severity {
                Severity::Error if rule.buildable => "error, builds",
                Severity::Error => "error",
                Severity::Warning => "warning",
                Severity::Info => "remark",
            };
            let (code, fix) = (rule.code, rule.fixability.name());
            let (title, source) = (cell(rule.title), cell(rule.source));
            let _ = writeln!(page, "| {code} | {severity} | {title} | {fix} | {source} |");
        }
    }
    page
}

#[test]
fn the_page_is_current() {
    let result = compare_page("RULES-EDS.md", &page());
    assert!(
        result.is_ok(),
        "{}",
        result
            .unwrap_err()
            .replace("--test rules", "--test rules_eds")
    );
}

#[test]
fn every_rule_is_on_the_page() {
    for rule in RULES {
        assert!(
            FOLDERS
                .iter()
                .any(|(number, _)| *number == &rule.code[1..3]),
            "{}",
            rule.code
        );
    }
    assert!(RULES.len() >= 60);
}

/// The page about other tools contains each of them, and each of their rules.
#[test]
fn the_page_about_tools_is_complete() {
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/../docs/COMPATIBILITY.md");
    let page = std::fs::read_to_string(path).unwrap();
    for tool in od_eds::tools::TOOLS {
        assert!(
            page.contains(&format!("| `{}` |", tool.name)),
            "{}",
            tool.name
        );
        for rule in tool.rules {
            let row = format!("| {} |", rule.code);
            let found = page.lines().find(|line| line.starts_with(&row));
            let found = found.unwrap_or_else(|| panic!("{} is missing", rule.code));
            assert!(found.contains(rule.title), "{found}");
        }
    }
}
