//! Imports between TypeScript files.

use std::collections::BTreeMap;

use crate::graph::Arrows;

/// Adds the arrows of all `.ts` files: `from './x'`, `import './x'`, `import('./x')`.
pub(crate) fn arrows(files: &BTreeMap<String, String>, arrows: &mut Arrows) {
    for (path, text) in files.iter().filter(|(path, _)| path.ends_with(".ts")) {
        for (name, line) in imports(text) {
            let target = joined(path, name);
            let with_ending = [format!("{target}.ts"), format!("{target}/index.ts"), target];
            for found in with_ending
                .iter()
                .filter(|found| files.contains_key(*found))
            {
                arrows.add(path, found, line, name);
            }
        }
    }
}

/// The relative paths that a text imports, each with its line.
fn imports(text: &str) -> impl Iterator<Item = (&str, usize)> {
    ["from", "import"].into_iter().flat_map(move |word| {
        text.match_indices(word).filter_map(move |(at, _)| {
            let behind = text[at + word.len()..].trim_start();
            let behind = behind.strip_prefix('(').unwrap_or(behind).trim_start();
            let quote = behind.chars().next().filter(|c| matches!(c, '\'' | '"'))?;
            let name = behind[1..].split(quote).next()?;
            let line = text[..at].matches('\n').count() + 1;
            name.starts_with('.').then_some((name, line))
        })
    })
}

/// `./x` and `../x` as seen from a file.
fn joined(file: &str, name: &str) -> String {
    let mut parts: Vec<&str> = file.split('/').collect();
    parts.pop();
    for part in name.split('/') {
        match part {
            "." => {}
            ".." => drop(parts.pop()),
            _ => parts.push(part),
        }
    }
    parts.join("/")
}

#[test]
fn every_form_of_an_import_is_an_arrow() {
    let file = |path: &str, text: &str| (path.to_owned(), text.to_owned());
    let files = BTreeMap::from([
        file("w/a.ts", "import { b } from './b';\nimport 'lit';"),
        file("w/b.ts", "const c = await import( \"./v/c\");"),
        file("w/v/c.ts", "export * from '../d'\nimport '../a'"),
        file("w/d.ts", "import type { B } from './nowhere';"),
    ]);
    let mut found = Arrows::default();
    arrows(&files, &mut found);
    let circles = found.circles();
    let circles = circles
        .iter()
        .map(|found| (found.from, found.line, found.name));
    let expected = [
        ("w/a.ts", 1, "./b"),
        ("w/b.ts", 1, "./v/c"),
        ("w/v/c.ts", 2, "../a"),
    ];
    assert_eq!(circles.collect::<Vec<_>>(), expected);
}
