//! The rooms, and which room may use which.

use std::collections::{BTreeMap, BTreeSet};

/// A room is a folder of the workspace.
pub(crate) struct Room {
    /// The folder.
    pub(crate) name: &'static str,
    /// Arrows lead from a higher storey to a lower one; `None` is exempt.
    storey: Option<u8>,
}

const fn room(name: &'static str, storey: u8) -> Room {
    Room {
        name,
        storey: Some(storey),
    }
}

/// All rooms, from the lowest storey up.
pub(crate) const ROOMS: [Room; 20] = [
    room("od-model", 1),
    room("crates/od-thumb", 1),
    room("crates/od-wire", 2),
    room("crates/od-eds", 2),
    room("crates/od-client", 3),
    room("crates/od-runtime", 3),
    room("od-macros", 3),
    room("crates/od-lsp", 3),
    room("crates/od-board", 4),
    room("crates/od-sim", 4),
    room("crates/odkit", 5),
    room("crates/od-tools", 5),
    room("devices", 6),
    room("crates/od-capi", 6),
    room("crates/od-cli", 7),
    room("playground", 7),
    room("python", 7),
    room("firmware", 7),
    room("tests", 7),
    Room {
        name: "xtask",
        storey: None,
    },
];

/// The dependencies on a higher or the same storey, as pairs of rooms. Tests may have them, because
/// a test is above everything that it needs.
pub(crate) fn arrows_up(files: &BTreeMap<String, String>) -> BTreeSet<(&str, &str)> {
    let manifests = || {
        files
            .iter()
            .filter(|(path, _)| path.ends_with("Cargo.toml"))
    };
    let packages: BTreeMap<&str, &str> = manifests()
        .filter_map(|(path, text)| Some((package(text)?, room_of(path))))
        .collect();
    let mut found = BTreeSet::new();
    for (path, text) in manifests() {
        let from = room_of(path);
        for to in dependencies(text).filter_map(|name| packages.get(name)) {
            let leads_down = match (storey(from), storey(to)) {
                (Some(from), Some(to)) => to < from,
                _ => false,
            };
            if *to != from && !leads_down {
                found.insert((from, *to));
            }
        }
    }
    found
}

/// Returns whether the name is that of a source file.
pub(crate) fn is_code(path: &str) -> bool {
    path.ends_with(".rs") || (path.ends_with(".ts") && !path.ends_with(".d.ts"))
}

/// The room that contains a file; for a file outside all rooms, its first folder.
fn room_of(path: &str) -> &str {
    let is_in = |room: &&Room| {
        path.strip_prefix(room.name)
            .is_some_and(|rest| rest.starts_with('/'))
    };
    let room = ROOMS.iter().find(is_in).map(|room| room.name);
    room.or_else(|| path.split('/').next()).unwrap_or(path)
}

fn storey(name: &str) -> Option<u8> {
    ROOMS.iter().find(|room| room.name == name)?.storey
}

/// The name in `[package]`.
fn package(manifest: &str) -> Option<&str> {
    let (_, body) = manifest.split_once("[package]")?;
    let line = body.lines().find(|line| line.starts_with("name"))?;
    line.split('"').nth(1)
}

/// The dependencies in a manifest, also those for one system.
fn dependencies(manifest: &str) -> impl Iterator<Item = &str> {
    let mut is_inside = false;
    manifest.lines().filter_map(move |line| {
        let line = line.trim();
        if let Some(section) = line.strip_prefix('[') {
            let kind = section.trim_end_matches(']').rsplit('.').next();
            is_inside = matches!(kind, Some("dependencies" | "build-dependencies"))
                && section != "workspace.dependencies]";
            return None;
        }
        let name = line.split(['=', '.', ' ']).next()?.trim();
        (is_inside && !name.is_empty() && !name.starts_with('#')).then_some(name)
    })
}

#[test]
fn an_arrow_to_the_side_leads_up_too() {
    let file = |path: &str, text: &str| (path.to_owned(), text.to_owned());
    let files = BTreeMap::from([
        file("Cargo.toml", "[workspace.dependencies]\nod-cli = 1"),
        file(
            "crates/od-wire/Cargo.toml",
            "[package]\nname = \"od-wire\"\n[dependencies]\nod-model = 1",
        ),
        file(
            "od-model/Cargo.toml",
            "[package]\nname = \"od-model\"\n[dependencies]\nserde = 1",
        ),
        file(
            "crates/od-eds/Cargo.toml",
            "[package]\nname = \"od-eds\"\n[dependencies]\nod-model.workspace = true\n\
             [target.'cfg(unix)'.dependencies]\nod-wire = { path = \"\" }\n\
             [dev-dependencies]\nod-sim.workspace = true\n\
             [build-dependencies]\nod-cli.workspace = true",
        ),
        file("crates/od-sim/Cargo.toml", "[package]\nname = \"od-sim\"\n"),
        file(
            "crates/od-cli/Cargo.toml",
            "[package]\nname = \"od-cli\"\n[dependencies]\nod-eds = 1",
        ),
    ]);
    let found: Vec<_> = arrows_up(&files).into_iter().collect();
    assert_eq!(
        found,
        [
            ("crates/od-eds", "crates/od-cli"),
            ("crates/od-eds", "crates/od-wire")
        ]
    );
}
