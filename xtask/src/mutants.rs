//! `cargo xtask mutants`: checks that the tests notice when the code is changed.
//!
//! cargo-mutants changes one thing at a time and runs the tests. A change that no test
//! notices survives: a test is missing, or `tests/mutants.toml` lists it with a reason.

use std::fs;
use std::path::{Path, PathBuf};

use crate::console::{Console, ask, cargo, clean, say};
use crate::error::{Error, Result};
use crate::packages::MUTATED;
use crate::repo::{Repo, program};

/// The version that is built. Other versions make different mutants.
const VERSION: &str = "27.1.0";

/// Seconds that the tests of a mutant may take. If they take longer, the mutant counts as caught.
const PATIENCE: &str = "300";

/// The least share of viable mutants that tests have to catch, in percent.
const LEAST: usize = 90;

/// The command line of `mutants`.
#[derive(Debug, Default, PartialEq, Eq)]
pub(crate) struct Options {
    /// `2/8`: the third of eight parts; parts count from 0.
    shard: Option<String>,
    /// Only these files.
    files: Vec<String>,
}

impl Options {
    /// Reads the arguments after `mutants`.
    pub(crate) fn parse(args: &[String]) -> Result<Options> {
        let mut options = Options::default();
        // `--shard=2/8` is `--shard 2/8`.
        let mut words = args.iter().flat_map(|arg| arg.split('='));
        while let Some(word) = words.next() {
            match (word, words.next()) {
                ("--shard", Some(part)) if part.contains('/') => options.shard = Some(part.into()),
                ("--file", Some(file)) if room(file).is_some() => options.files.push(file.into()),
                ("--file", Some(file)) => {
                    let text = format!("no mutants are made in `{file}`");
                    return Err(Error::Usage(text));
                }
                _ => return Err(Error::Usage(format!("mutants has no option `{word}`"))),
            }
        }
        Ok(options)
    }
}

/// The entry of [`MUTATED`] that contains a file.
fn room(file: &str) -> Option<usize> {
    MUTATED
        .iter()
        .position(|(_, folder, _)| file.starts_with(folder))
}

/// The result of a run.
#[derive(Debug, Default, PartialEq, Eq)]
struct Found {
    caught: usize,
    survivors: Vec<String>,
}

/// Runs cargo-mutants and compares the survivors with the list.
pub(crate) fn run(repo: &Repo, console: &Console, options: &Options) -> Result<()> {
    let path = repo.root.join("tests/mutants.toml");
    let list = fs::read_to_string(&path).map_err(|e| Error::io("read", &path, &e))?;
    let tool = install(repo, console)?;
    let mut found = Found::default();
    for (number, (package, folder, tests)) in MUTATED.iter().enumerate() {
        let here = |file: &&String| room(file) == Some(number);
        let files: Vec<&String> = options.files.iter().filter(here).collect();
        if files.is_empty() && !options.files.is_empty() {
            continue;
        }
        let part = options.shard.as_deref().unwrap_or("all").replace('/', "-");
        let out = repo
            .cache()
            .join("mutants")
            .join(format!("{package}-{part}"));
        fs::create_dir_all(&out).map_err(|e| Error::io("create", &out, &e))?;
        let args = ["mutants", "--iterate", "--no-shuffle", "--output"];
        let mut command = clean(&tool, &repo.root, &args);
        command.arg(&out).args(["--package", package]);
        if files.is_empty() {
            command.args(["--file", &format!("{folder}**/*.rs")]);
        }
        command.args(files.iter().flat_map(|file| ["--file", file]));
        if let Some(shard) = &options.shard {
            command.args(["--shard", shard]);
        }
        let others = tests.iter().map(|(other, _)| *other);
        let packages: Vec<&str> = [*package].into_iter().chain(others).collect();
        let own = own_tests(&repo.root.join("crates").join(package).join("tests"));
        let others = tests.iter().flat_map(|(_, names)| names.iter().copied());
        let names = own.iter().map(String::as_str).chain(others);
        let names: Vec<&str> = names.flat_map(|name| ["--test", name]).collect();
        // Its check of the unchanged code tests only the package that is mutated.
        let mut before = cargo(&repo.root, &["test", "--quiet", "--lib"]);
        before.args(packages.iter().flat_map(|name| ["--package", name]));
        console.run("the tests without a change", before.args(&names))?;
        command.args(["--baseline", "skip", "--timeout", PATIENCE]);
        command.args(packages.iter().flat_map(|name| ["--test-package", name]));
        command.args(["--", "--lib"]).args(&names);
        let result = console.run(&format!("mutants of {package}"), &mut command);
        let out = out.join("mutants.out");
        // It also fails if mutants survive; the list decides which of them may.
        if !out.join("outcomes.json").is_file() {
            return result;
        }
        read(&out, &mut found);
    }
    judge(&found, &list)
}

/// The names of a package's test targets: `NAME.rs`, or a folder with a `main.rs`.
fn own_tests(dir: &Path) -> Vec<String> {
    let files = fs::read_dir(dir).into_iter().flatten().flatten();
    let names = files.filter_map(|file| {
        let name = file.file_name().into_string().ok()?;
        if file.path().join("main.rs").is_file() {
            return Some(name);
        }
        name.strip_suffix(".rs").map(String::from)
    });
    names.collect()
}

/// cargo-mutants in `.xtask`, built there when it is missing.
fn install(repo: &Repo, console: &Console) -> Result<PathBuf> {
    let root = repo.tools().join("mutants");
    let tool = root.join("bin").join(program("cargo-mutants"));
    let wanted = format!("cargo-mutants {VERSION}");
    if ask(&tool, &["mutants", "--version"]).as_deref() != Some(&*wanted) {
        let mut install = cargo(&repo.root, &["install", "--quiet", "--locked", "--debug"]);
        install.args(["cargo-mutants", "--force", "--version", VERSION, "--root"]);
        console.run(
            "building cargo-mutants (once, some minutes)",
            install.arg(&root),
        )?;
    }
    Ok(tool)
}

/// Adds the files of cargo-mutants: one file per outcome, one line per mutant.
fn read(out: &Path, found: &mut Found) {
    let lines = |name: &str| -> Vec<String> {
        let text = fs::read_to_string(out.join(name)).unwrap_or_default();
        text.lines().map(nameless).collect()
    };
    // A test that does not end has noticed the change, too.
    for name in ["caught.txt", "timeout.txt", "previously_caught.txt"] {
        found.caught += lines(name).len();
    }
    found.survivors.extend(lines("missed.txt"));
}

/// Turns `a.rs:12:5: replace …` into `a.rs: replace …`: line numbers change, mutants do not.
fn nameless(line: &str) -> String {
    let mut parts = line.splitn(4, ':');
    match (parts.next(), parts.next(), parts.next(), parts.next()) {
        (Some(file), Some(_), Some(_), Some(what)) => format!("{file}:{what}"),
        _ => String::from(line),
    }
}

/// Prints the survivors that the list gives no reason for; an error if there are any.
fn judge(found: &Found, list: &str) -> Result<()> {
    let accepted = |survivor: &&String| {
        list.lines()
            .filter_map(|line| line.strip_prefix('"')?.split_once("\" = \""))
            .any(|(mutant, reason)| mutant == survivor.as_str() && reason.len() > 1)
    };
    let unknown: Vec<&String> = found.survivors.iter().filter(|s| !accepted(s)).collect();
    for survivor in &unknown {
        say(&format!("  survives: {survivor}"));
    }
    let viable = found.caught + found.survivors.len();
    let (caught, share) = (found.caught, found.caught * 100 / viable.max(1));
    say(&format!(
        "{caught} of {viable} viable mutants caught, {share} %"
    ));
    if viable == 0 {
        return Err(Error::Failed(String::from("there was no mutant")));
    }
    if !unknown.is_empty() || share < LEAST {
        return Err(Error::Failed(format!(
            "{} survive that tests/mutants.toml does not list; at least {LEAST} % have to be caught",
            unknown.len()
        )));
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::{Found, Options, judge, nameless};

    #[test]
    fn command_lines() {
        let parse = |line: &str| {
            let args: Vec<String> = line.split_whitespace().map(String::from).collect();
            Options::parse(&args).ok()
        };
        assert_eq!(parse(""), Some(Options::default()));
        let options = parse("--shard=2/8 --file crates/od-runtime/src/fifo.rs");
        assert!(options.is_some_and(|o| o.files.len() == 1 && o.shard.is_some()));
        for wrong in ["--shard", "--shard 2", "--file README.md", "fifo.rs"] {
            assert_eq!(parse(wrong), None, "{wrong}");
        }
    }

    #[test]
    fn a_survivor_needs_a_reason() {
        let survivor = nameless("a/b.rs:12:5: replace f -> u8 with 0 in g");
        let found = Found {
            caught: 9,
            survivors: vec![survivor],
        };
        let list = "\"a/b.rs: replace f -> u8 with 0 in g\" = \"nobody asks\"\n";
        assert!(judge(&found, list).is_ok());
        assert!(judge(&found, "").is_err());
        assert!(judge(&Found { caught: 8, ..found }, list).is_err());
    }
}
