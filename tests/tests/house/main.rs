//! The house keeps its order: no circle of files, no dependency that leads up, files of at most
//! 400 lines, and no room larger than planned. The tree is read as text.
//!
//! `breaches.txt` lists what is not in order yet. It only shrinks:
//! `ODKIT_ACCEPT=1 cargo test -p od-tests --test house` writes it again, for files that moved and
//! for breaches that ended, and refuses a longer one.

mod graph;
mod rooms;
mod rust;
mod tokens;
mod typescript;

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::Path;

use crate::graph::Arrows;
use crate::rooms::{ALL, ROOMS};
use crate::rust::Modules;

/// Lines that a file may have.
const LONGEST: usize = 400;

/// An error in one place, and the correction.
struct Breach {
    /// Its name in the list: `circle a/b.rs -> a/c.rs`, `long a/b.rs`. Files are named by
    /// folder and name, so that a folder can move.
    line: String,
    /// The count, if it has one: the list holds the highest that is allowed.
    count: Option<usize>,
    advice: String,
}

#[test]
fn the_house_is_in_order() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("..");
    let mut files = BTreeMap::new();
    for room in ROOMS {
        collect(&root, room.name, &mut files);
    }
    let breaches = breaches(&files);
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/house/breaches.txt");
    let listed = read(&fs::read_to_string(&path).unwrap_or_default());
    if std::env::var_os("ODKIT_ACCEPT").is_some() {
        let faults = longer(&listed, &breaches);
        assert!(
            faults.is_empty(),
            "the list only shrinks\n{}",
            faults.join("\n")
        );
        fs::write(&path, write(&breaches)).unwrap();
        return;
    }
    let faults = differences(&listed, &breaches);
    assert!(faults.is_empty(), "{}", faults.join("\n"));
}

/// All that is not in order.
fn breaches(files: &BTreeMap<String, String>) -> Vec<Breach> {
    let modules = Modules::of(files);
    let mut arrows = Arrows::default();
    modules.arrows(&mut arrows);
    typescript::arrows(files, &mut arrows);
    let mut found = Vec::new();
    for (from, to) in arrows.circles() {
        found.push(Breach {
            line: format!("circle {} -> {}", short(from), short(to)),
            count: None,
            advice: format!(
                "{from} names something of {to}, and a way leads back: move what both need into \
                 a file below them"
            ),
        });
    }
    for (from, to) in rooms::arrows_up(files) {
        found.push(Breach {
            line: format!("up {from} -> {to}"),
            count: None,
            advice: format!(
                "{from} may not depend on {to}: see ROOMS in tests/tests/house/rooms.rs"
            ),
        });
    }
    for file in modules.through_the_root() {
        found.push(Breach {
            line: format!("root {}", short(file)),
            count: None,
            advice: format!(
                "{file} takes a name from lib.rs that another file defines: write the path of \
                 that file, as `crate::frame::Frame`"
            ),
        });
    }
    for (file, text) in files.iter().filter(|(file, _)| rooms::is_code(file)) {
        let count = text.lines().count();
        if count > LONGEST {
            found.push(Breach {
                line: format!("long {}", short(file)),
                count: Some(count),
                advice: format!(
                    "{file} has {count} lines of at most {LONGEST}: split it by what it does"
                ),
            });
        }
    }
    let lines = rooms::lines(files);
    let all = ("all", lines.values().sum(), ALL);
    let rooms = ROOMS
        .iter()
        .filter_map(|room| Some((room.name, *lines.get(room.name)?, room.lines)));
    for (name, count, most) in rooms.chain([all]).filter(|(_, count, most)| count > most) {
        found.push(Breach {
            line: format!("lines {name}"),
            count: Some(count.next_multiple_of(100)),
            advice: format!("{name} has {count} lines of at most {most}"),
        });
    }
    found
}

/// Name of a file with its folder, and with its room where that folder is the room's `src`.
fn short(path: &str) -> &str {
    let mut slashes = path.rmatch_indices('/').skip(1);
    let at = match slashes.next() {
        Some((at, _)) if path[at..].starts_with("/src/") => slashes.next().map(|(at, _)| at),
        found => found.map(|(at, _)| at),
    };
    at.map_or(path, |at| &path[at + 1..])
}

/// The list: each line with what is allowed at most.
fn read(text: &str) -> BTreeMap<String, Option<usize>> {
    let lines = text
        .lines()
        .filter(|line| !line.is_empty() && !line.starts_with('#'));
    lines
        .map(|line| match line.rsplit_once(' ') {
            Some((name, count)) if count.bytes().all(|byte| byte.is_ascii_digit()) => {
                (name.to_owned(), count.parse().ok())
            }
            _ => (line.to_owned(), None),
        })
        .collect()
}

fn write(breaches: &[Breach]) -> String {
    let lines: BTreeSet<String> = breaches
        .iter()
        .map(|breach| match breach.count {
            Some(count) => format!("{} {count}", breach.line),
            None => breach.line.clone(),
        })
        .collect();
    let lines: Vec<String> = lines.into_iter().collect();
    format!(
        "# What is not in order yet; see main.rs. This list only shrinks.\n{}\n",
        lines.join("\n")
    )
}

/// Breaches that the list does not allow, and entries of the list that are no longer needed.
fn differences(listed: &BTreeMap<String, Option<usize>>, breaches: &[Breach]) -> Vec<String> {
    let new = breaches
        .iter()
        .filter(|breach| match listed.get(&breach.line) {
            Some(most) => breach.count > *most,
            None => true,
        });
    let mut faults: Vec<String> = new
        .map(|breach| format!("new: {}\n  {}", breach.line, breach.advice))
        .collect();
    let still: BTreeSet<&String> = breaches.iter().map(|breach| &breach.line).collect();
    let ended = listed.keys().filter(|line| !still.contains(line));
    faults.extend(ended.map(|line| {
        format!("ended, or moved: {line}\n  write the list again: ODKIT_ACCEPT=1 cargo test -p od-tests --test house")
    }));
    faults
}

/// The kinds of which there would be more than before. Lines may go from room to room.
fn longer(listed: &BTreeMap<String, Option<usize>>, breaches: &[Breach]) -> Vec<String> {
    if listed.is_empty() {
        return Vec::new();
    }
    let mut faults = Vec::new();
    for kind in ["circle", "up", "root", "long"] {
        let is_kind = |line: &str| line.split(' ').next() == Some(kind);
        let before = listed.keys().filter(|line| is_kind(line)).count();
        let now: BTreeSet<_> = breaches
            .iter()
            .filter(|breach| is_kind(&breach.line))
            .map(|breach| &breach.line)
            .collect();
        if now.len() > before {
            faults.push(format!("{kind}: {} instead of {before}", now.len()));
            let new = breaches
                .iter()
                .filter(|breach| is_kind(&breach.line) && !listed.contains_key(&breach.line));
            faults.extend(new.map(|breach| format!("  {}", breach.advice)));
        }
    }
    let all = breaches.iter().find(|breach| breach.line == "lines all");
    if let Some(all) =
        all.filter(|all| listed.get("lines all").is_none_or(|most| all.count > *most))
    {
        faults.push(format!("lines: {}", all.advice));
    }
    faults
}

/// The texts of a folder that are code or a manifest.
fn collect(root: &Path, folder: &str, files: &mut BTreeMap<String, String>) {
    const MADE: [&str; 6] = ["target", "node_modules", "dist", "pkg", "results", ".git"];
    let Ok(entries) = fs::read_dir(root.join(folder)) else {
        return;
    };
    for entry in entries {
        let entry = entry.unwrap();
        let name = entry.file_name().into_string().unwrap();
        let path = format!("{folder}/{name}");
        if entry.file_type().unwrap().is_dir() {
            if !MADE.contains(&name.as_str()) {
                collect(root, &path, files);
            }
        } else if rooms::is_code(&name) || name == "Cargo.toml" {
            let text = fs::read_to_string(root.join(&path)).unwrap();
            files.insert(path, text);
        }
    }
}

#[test]
fn the_list_only_shrinks() {
    let breach = |line: &str, count| Breach {
        line: line.into(),
        count,
        advice: "split it".into(),
    };
    let list = "# x\ncircle a/b.rs -> a/c.rs\nlong a/d.rs 500\nlines all 60000\n";
    let listed = read(list);
    let same = [
        breach("circle a/b.rs -> a/c.rs", None),
        breach("long a/d.rs", Some(450)),
        breach("lines all", Some(60_000)),
    ];
    assert!(differences(&listed, &same).is_empty() && longer(&listed, &same).is_empty());
    assert_eq!(read(&write(&same)).len(), 3);
    let moved = [breach("circle a/e.rs -> a/c.rs", None)];
    assert_eq!(differences(&listed, &moved).len(), 4);
    assert!(longer(&listed, &moved).is_empty());
    let grown = [
        breach("long a/d.rs", Some(501)),
        breach("long a/e.rs", Some(401)),
        breach("lines all", Some(60_100)),
    ];
    assert_eq!(differences(&listed, &grown[..1]).len(), 3);
    assert_eq!(longer(&listed, &grown).len(), 3);
}
