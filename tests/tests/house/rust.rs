//! Imports between Rust files: `use`, and paths in the code.
//!
//! Modules are found by the paths of their files, so no macro has to be expanded. An arrow leads to
//! the file that defines a name, even if another file re-exports it. A file that only re-exports
//! names of the modules below it has no arrows to them.

use std::collections::{BTreeMap, BTreeSet};

use crate::graph::Arrows;
use crate::tokens::{Token, tokens};

/// Place of a module: the folder of its crate's root, and the names from there.
type Place = (String, Vec<String>);

/// One file.
struct Module<'t> {
    file: &'t str,
    place: Place,
    tokens: Vec<Token<'t>>,
    /// The line of each token.
    lines: Vec<usize>,
    uses: Vec<Use>,
    paths: Vec<(Vec<String>, usize)>,
}

/// A name that a file imports.
struct Use {
    path: Vec<String>,
    name: String,
    is_public: bool,
    /// The line of the `use`.
    line: usize,
}

/// All Rust files.
pub(crate) struct Modules<'t> {
    all: Vec<Module<'t>>,
    by_place: BTreeMap<Place, usize>,
}

impl<'t> Modules<'t> {
    /// Reads the `.rs` files among these.
    pub(crate) fn of(files: &'t BTreeMap<String, String>) -> Self {
        let mut all = Vec::new();
        let mut by_place = BTreeMap::new();
        // A `tests.rs` is what `#[cfg(test)] mod tests;` declares.
        let is_product = |file: &str| file.ends_with(".rs") && !file.ends_with("/tests.rs");
        for (file, text) in files.iter().filter(|(file, _)| is_product(file)) {
            let Some(place) = place(file, files) else {
                continue;
            };
            by_place.insert(place.clone(), all.len());
            let (tokens, lines) = tokens(text);
            all.push(Module {
                file,
                place,
                tokens,
                lines,
                uses: Vec::new(),
                paths: Vec::new(),
            });
        }
        let mut modules = Self { all, by_place };
        for at in 0..modules.all.len() {
            let (uses, paths) = modules.names(&modules.all[at]);
            (modules.all[at].uses, modules.all[at].paths) = (uses, paths);
        }
        modules
    }

    /// Adds an arrow for each file that uses something of another.
    pub(crate) fn arrows(&self, arrows: &mut Arrows) {
        for module in &self.all {
            for (path, line) in module.needed() {
                if let Some(to) = self.definer(&module.place.0, path, &mut BTreeSet::new()) {
                    let name = format!("crate::{}", path.join("::"));
                    arrows.add(module.file, self.all[to].file, line, &name);
                }
            }
        }
    }

    /// The names that a file takes from the root of its crate although another file defines them:
    /// the file, the line and the name.
    pub(crate) fn through_the_root(&self) -> BTreeSet<(&str, usize, &str)> {
        let mut found = BTreeSet::new();
        for module in &self.all {
            let Some(root) = self.by_place.get(&(module.place.0.clone(), Vec::new())) else {
                continue;
            };
            for (path, line) in module.needed().filter(|_| !module.place.1.is_empty()) {
                let direct = self.deepest(&module.place.0, path).map(|(at, _)| at);
                let definer = self.definer(&module.place.0, path, &mut BTreeSet::new());
                if direct == Some(*root) && definer != direct {
                    found.insert((module.file, line, path[0].as_str()));
                }
            }
        }
        found
    }

    /// The files of a `src` that no other file of their crate declares or includes: the compiler does not read
    /// them.
    pub(crate) fn undeclared(&self, files: &BTreeMap<String, String>) -> Vec<&'t str> {
        let is_declared = |(root, names): &Place| {
            let Some(name) = names.last() else {
                return true;
            };
            let is_target =
                |folder: &str| matches!(folder, "bin" | "tests" | "examples" | "benches");
            let folder = names.iter().rev().nth(1);
            let folder = folder.map_or(root.rsplit('/').next().unwrap_or(root), String::as_str);
            let (declared, included) = (format!("mod {name};"), format!("{name}.rs\""));
            is_target(folder)
                || files
                    .range(format!("{root}/")..format!("{root}0"))
                    .any(|(_, text)| text.contains(&declared) || text.contains(&included))
        };
        let is_product = |module: &&Module<'_>| module.place.0.ends_with("/src");
        let modules = self.all.iter().filter(is_product);
        let undeclared = modules.filter(|module| !is_declared(&module.place));
        undeclared.map(|module| module.file).collect()
    }

    /// The imports of a file, and the paths in its code, both from the root of the crate.
    fn names(&self, module: &Module<'_>) -> (Vec<Use>, Vec<(Vec<String>, usize)>) {
        let (mut uses, mut paths) = (Vec::new(), Vec::new());
        let tokens = &module.tokens;
        let mut at = 0;
        while at < tokens.len() {
            let is_use =
                tokens[at] == Token::Word("use") && tokens.get(at + 1) != Some(&Token::Mark('<'));
            if is_use {
                let is_public = is_public(&tokens[..at]);
                let line = module.lines[at];
                let mut found = Vec::new();
                at += 1 + tree(&tokens[at + 1..], &[], &mut found);
                for (path, name) in found {
                    if let Some(path) = self.absolute(&module.place, &path) {
                        uses.push(Use {
                            path,
                            name,
                            is_public,
                            line,
                        });
                    }
                }
                continue;
            }
            let begins = at == 0 || tokens[at - 1] != Token::Path;
            let line = module.lines[at];
            let mut path = Vec::new();
            while let Some(Token::Word(word)) = tokens.get(at) {
                path.push((*word).to_owned());
                at += 1;
                match tokens.get(at..at + 2) {
                    Some([Token::Path, Token::Word(_)]) => at += 1,
                    _ => break,
                }
            }
            if path.is_empty() {
                at += 1;
            } else if begins && path.len() > 1 {
                paths.extend(self.absolute(&module.place, &path).map(|path| (path, line)));
            }
        }
        (uses, paths)
    }

    /// A path from the root of the crate; `None` for one of another crate.
    fn absolute(&self, place: &Place, path: &[String]) -> Option<Vec<String>> {
        let mut base = place.1.clone();
        let rest = match path.first()?.as_str() {
            "crate" => return Some(path[1..].to_vec()),
            "self" => &path[1..],
            "super" => {
                let up = path.iter().take_while(|part| *part == "super").count();
                base.truncate(base.len().checked_sub(up)?);
                &path[up..]
            }
            _ => {
                let mut child = place.clone();
                child.1.push(path[0].clone());
                self.by_place.get(&child)?;
                path
            }
        };
        base.extend_from_slice(rest);
        Some(base)
    }

    /// The module that a path leads into, and the number of names that belong to it.
    fn deepest(&self, root: &str, path: &[String]) -> Option<(usize, usize)> {
        (0..=path.len()).rev().find_map(|length| {
            let place = (root.to_owned(), path[..length].to_vec());
            Some((*self.by_place.get(&place)?, length))
        })
    }

    /// The module in which the last name of a path is defined.
    fn definer(
        &self,
        root: &str,
        path: &[String],
        seen: &mut BTreeSet<(usize, String)>,
    ) -> Option<usize> {
        let (at, length) = self.deepest(root, path)?;
        let Some(name) = path
            .get(length)
            .filter(|name| seen.insert((at, (*name).clone())))
        else {
            return Some(at);
        };
        for found in &self.all[at].uses {
            let mut target = found.path.clone();
            if found.name == *name {
                target.extend_from_slice(&path[length + 1..]);
                return self.definer(root, &target, seen);
            }
            if found.name == "*" && found.is_public {
                target.extend_from_slice(&path[length..]);
                let definer = self.definer(root, &target, seen);
                if definer.is_some_and(|definer| self.all[definer].defines(name)) {
                    return definer;
                }
            }
        }
        Some(at)
    }
}

impl Module<'_> {
    /// The paths that make arrows, each with its line.
    fn needed(&self) -> impl Iterator<Item = (&[String], usize)> {
        let is_window = |used: &Use| used.is_public && used.path.starts_with(&self.place.1);
        let uses = self.uses.iter().filter(move |used| !is_window(used));
        let uses = uses.map(|used| (used.path.as_slice(), used.line));
        let paths = self.paths.iter();
        uses.chain(paths.map(|(path, line)| (path.as_slice(), *line)))
    }

    fn defines(&self, name: &str) -> bool {
        const ITEMS: [&str; 8] = [
            "fn", "struct", "enum", "const", "static", "trait", "type", "mod",
        ];
        self.tokens.windows(2).any(|pair| match pair {
            [Token::Word(item), Token::Word(own)] => ITEMS.contains(item) && *own == name,
            _ => false,
        })
    }
}

/// Place of the module of a file; `None` if no crate has it.
fn place(file: &str, files: &BTreeMap<String, String>) -> Option<Place> {
    let mut folder = file;
    let root = loop {
        folder = folder.rsplit_once('/')?.0;
        let has = |name: &str| files.contains_key(&format!("{folder}/{name}.rs"));
        let last = folder.rsplit('/').next().unwrap_or(folder);
        if has("lib") || has("main") || matches!(last, "tests" | "examples" | "benches") {
            break folder;
        }
    };
    let inside = file.strip_prefix(root)?.strip_prefix('/')?;
    let inside = inside.strip_suffix(".rs")?;
    let mut names: Vec<String> = inside.split('/').map(str::to_owned).collect();
    if names.len() > 1 && names.last().is_some_and(|name| name == "mod") {
        names.pop();
    }
    let has_library = files.contains_key(&format!("{root}/lib.rs"));
    if inside == "lib" || (inside == "main" && !has_library) {
        names.clear();
    }
    Some((root.to_owned(), names))
}

/// Returns whether the `use` after these tokens is `pub` or `pub(…)`.
fn is_public(before: &[Token<'_>]) -> bool {
    let before = match before {
        [.., Token::Mark(')')] => {
            let open = before.iter().rposition(|token| *token == Token::Mark('('));
            &before[..open.unwrap_or(0)]
        }
        _ => before,
    };
    before.last() == Some(&Token::Word("pub"))
}

/// Parses a tree of `use`: each path with the name that it gets. Returns the number of tokens.
fn tree(tokens: &[Token<'_>], prefix: &[String], found: &mut Vec<(Vec<String>, String)>) -> usize {
    let mut path = prefix.to_vec();
    let mut name = None;
    let mut at = 0;
    let mut is_group = false;
    while let Some(token) = tokens.get(at) {
        match token {
            Token::Word("as") => {
                if let Some(Token::Word(alias)) = tokens.get(at + 1) {
                    name = Some((*alias).to_owned());
                }
                at += 1;
            }
            // `use a::{self}` is `a`.
            Token::Word("self") if !path.is_empty() => {}
            Token::Word(word) => path.push((*word).to_owned()),
            Token::Mark('*') => name = Some("*".into()),
            Token::Mark('{') => {
                is_group = true;
                at += 1;
                while !matches!(tokens.get(at), None | Some(Token::Mark('}'))) {
                    at += tree(&tokens[at..], &path, found);
                    at += usize::from(tokens.get(at) == Some(&Token::Mark(',')));
                }
            }
            Token::Mark(',' | '}' | ';') => break,
            Token::Path | Token::Mark(_) => {}
        }
        at += 1;
    }
    if !is_group {
        let name = name.or_else(|| path.last().cloned()).unwrap_or_default();
        found.push((path, name));
    }
    at
}

#[cfg(test)]
mod tests {
    use super::*;

    fn files(pairs: &[(&str, &str)]) -> BTreeMap<String, String> {
        let pairs = pairs.iter();
        pairs
            .map(|(path, text)| ((*path).to_owned(), (*text).to_owned()))
            .collect()
    }

    #[track_caller]
    fn check(pairs: &[(&str, &str)], expected: &[(&str, &str)]) {
        let files = files(pairs);
        let mut arrows = Arrows::default();
        Modules::of(&files).arrows(&mut arrows);
        let circles = arrows.circles();
        let found: Vec<_> = circles.iter().map(|found| (found.from, found.to)).collect();
        assert_eq!(found, expected);
    }

    #[test]
    fn a_circle_names_the_line_and_the_path() {
        let files = files(&[
            ("x/src/lib.rs", "mod a; mod b;"),
            ("x/src/a.rs", "//! a\n\nuse crate::b::{\n    B,\n};\n"),
            (
                "x/src/b.rs",
                "fn f() {\n    super::a::g();\n    super::a::h();\n}",
            ),
        ]);
        let mut arrows = Arrows::default();
        Modules::of(&files).arrows(&mut arrows);
        let circles = arrows.circles();
        let found: Vec<_> = circles
            .iter()
            .map(|found| (found.line, found.name))
            .collect();
        assert_eq!(found, [(3, "crate::b::B"), (2, "crate::a::g")]);
    }

    #[test]
    fn a_circle_is_found_in_every_form_of_an_import() {
        let both = [("x/src/a.rs", "x/src/b.rs"), ("x/src/b.rs", "x/src/a.rs")];
        let root = ("x/src/lib.rs", "mod a; mod b; pub use a::A; pub use b::*;");
        for (a, b) in [
            ("use crate::b::B;", "use crate::a::A;"),
            ("use super::b;", "fn f() { crate::a::g() }"),
            ("use crate::{b::{self, B as C}};", "use crate::A;"),
            ("fn f() -> super::b::B {}", "use super::{a as c};"),
            ("struct A; use crate::B;", "struct B; use crate::A;"),
        ] {
            check(&[root, ("x/src/a.rs", a), ("x/src/b.rs", b)], &both);
        }
    }

    #[test]
    fn a_parent_that_calls_what_calls_it_is_a_circle() {
        let child = ("x/src/a/b.rs", "use super::help;");
        let both = [
            ("x/src/a/b.rs", "x/src/a/mod.rs"),
            ("x/src/a/mod.rs", "x/src/a/b.rs"),
        ];
        let root = ("x/src/lib.rs", "mod a;");
        let calls = ("x/src/a/mod.rs", "mod b; fn help() { b::go() }");
        check(&[root, calls, child], &both);
        for shows in ["mod b; pub use b::Go; fn help() {}", "mod b; fn help() {}"] {
            check(&[root, ("x/src/a/mod.rs", shows), child], &[]);
        }
    }

    #[test]
    fn tests_words_and_other_crates_are_no_arrows() {
        check(
            &[
                ("x/src/lib.rs", "mod a; mod b;"),
                (
                    "x/src/a.rs",
                    "use crate::b::B; // crate::a::A\nuse other::b::B;",
                ),
                (
                    "x/src/b.rs",
                    "/// [A](crate::a::A)\nconst T: &str = \"crate::a\";\n\
                     #[cfg(test)]\nmod tests { use crate::a::A; }",
                ),
            ],
            &[],
        );
    }

    #[test]
    fn a_file_that_no_other_declares_is_found() {
        let files = files(&[
            (
                "x/src/lib.rs",
                "mod a; const B: &str = include_str!(\"b.rs\");",
            ),
            ("x/src/a.rs", ""),
            ("x/src/b.rs", ""),
            ("x/src/c.rs", ""),
            ("x/src/bin/d.rs", ""),
            ("y/src/lib.rs", "mod c;"),
        ]);
        let modules = Modules::of(&files);
        assert_eq!(modules.undeclared(&files), ["x/src/c.rs"]);
    }

    #[test]
    fn a_name_imported_from_a_re_export_is_found() {
        let files = files(&[
            (
                "x/src/lib.rs",
                "mod a; mod b; mod c; pub use a::A; pub struct L;",
            ),
            ("x/src/a.rs", "pub struct A; use crate::L;"),
            ("x/src/b.rs", "use crate::A;"),
            ("x/src/c.rs", "use crate::a::A;"),
        ]);
        let modules = Modules::of(&files);
        let found: Vec<_> = modules.through_the_root().into_iter().collect();
        assert_eq!(found, [("x/src/b.rs", 1, "A")]);
    }
}
