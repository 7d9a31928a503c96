//! The tables of docs/RULES.md and docs/CIA.md are what the scripts say of themselves.
//!
//! `ODKIT_ACCEPT=1 cargo test -p od-tests --test rules` writes them anew.

use std::collections::BTreeMap;
use std::fmt::Write;
use std::fs;

use od_tests::scripts::{self, Header, cell, compare_page};

const LINKS: &str = "../tests/conformance/";

/// All scripts with their headers.
fn headers() -> Vec<(String, Header)> {
    scripts::all()
        .into_iter()
        .map(|file| {
            let text = fs::read_to_string(&file.path).expect("a script is UTF-8");
            match Header::parse(&text) {
                Ok(header) => (file.name, header),
                Err(what) => panic!("tests/conformance/{}: {what}", file.name),
            }
        })
        .collect()
}

fn link(name: &str) -> String {
    let file = name.rsplit('/').next().unwrap_or(name);
    let short = file.strip_suffix(".script").unwrap_or(file);
    format!("[{short}]({LINKS}{name})")
}

fn rules() -> String {
    let headers = headers();
    let mut folders: BTreeMap<&str, Vec<_>> = BTreeMap::new();
    for (name, header) in &headers {
        let (folder, _) = name.rsplit_once('/').unwrap_or(("", name));
        folders.entry(folder).or_default().push((name, header));
    }
    let mut page = format!(
        "# Rules\n\n\
         What our devices do, where it is written, and the script that shows it: {} scripts.\n\
         Manuals are named by the first digits of their file names; C-… and U-… are the\n\
         decisions on what contradicts itself and on what is left unsaid.\n\n\
         This page is generated from the first lines of the scripts:\n\
         `ODKIT_ACCEPT=1 cargo test -p od-tests --test rules`.\n",
        headers.len()
    );
    for (folder, scripts) in folders {
        let _ = write!(
            page,
            "\n## {folder}\n\n| source | rule | script |\n|---|---|---|\n"
        );
        for (name, header) in scripts {
            let (source, rule) = (cell(&header.source), cell(&header.rule));
            let _ = writeln!(page, "| {source} | {rule} | {} |", link(name));
        }
    }
    page
}

#[test]
fn every_rule_is_in_the_table() {
    if let Err(what) = compare_page("RULES.md", &rules()) {
        panic!("{what}");
    }
}
