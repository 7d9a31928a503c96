//! `cargo xtask dist`: one folder that can be released.
//!
//! Each part has a file here and a folder there. The same inputs give the same bytes: times of files are
//! those of the commit.

mod bill;
mod binaries;
mod contents;
pub(crate) mod crates;
mod dist;
mod notices;
mod npm;
mod sbom;
mod site;
mod systems;
mod vscode;
mod wheel;

use std::env;
use std::path::{Path, PathBuf};

use crate::console::{Console, ask_in};
use crate::error::{Error, Result};
use crate::files;
use crate::repo::Repo;
use dist::Dist;

/// A part of a release: its name is the value of `--only` and the name of its folder.
struct Part {
    name: &'static str,
    /// Its content, as a line of the folder's README.
    about: &'static str,
    make: fn(&Dist<'_>, &Path) -> Result<()>,
}

#[rustfmt::skip]
const PARTS: [Part; 7] = [
    Part { name: "crates", about: "packages for crates.io", make: crates::make },
    Part { name: "npm", about: "the virtual encoder for JavaScript: `npm install ./FILE`", make: npm::make },
    Part { name: "vscode", about: "the extension for Visual Studio Code: `code --install-extension FILE`", make: vscode::make },
    Part { name: "site", about: "the playground and the documentation, for any web server that sends files", make: site::make },
    Part { name: "sbom", about: "what each part is made of, as CycloneDX 1.5", make: sbom::make },
    Part { name: "python", about: "the package for Python 3.9 and later, for Linux and Windows: `pip install FILE`; a Mac takes the sources and Rust", make: wheel::make },
    Part { name: "bin", about: "the command line, without further files: rename the one of your system to `odkit`", make: binaries::make },
];

/// The command line of `dist`.
#[derive(Debug, PartialEq, Eq)]
pub(crate) struct Options {
    only: Vec<String>,
    out: Option<PathBuf>,
}

impl Options {
    /// All parts; they are written into this folder.
    pub(crate) fn whole(out: &Path) -> Options {
        Options {
            only: Vec::new(),
            out: Some(out.to_path_buf()),
        }
    }

    /// Reads the arguments after `dist`.
    pub(crate) fn parse(args: &[String]) -> Result<Options> {
        let (mut only, mut out) = (Vec::new(), None);
        // `--out=DIR` is `--out DIR`.
        let parts = |arg: &String| if arg.starts_with("--") { 2 } else { 1 };
        let mut words = args.iter().flat_map(|arg| arg.splitn(parts(arg), '='));
        while let Some(word) = words.next() {
            let value = words.next().filter(|value| !value.is_empty());
            match (word, value) {
                ("--only", Some(names)) => {
                    for name in names.split(',') {
                        only.push(known(name)?);
                    }
                }
                ("--out", Some(dir)) => out = Some(PathBuf::from(dir)),
                ("--only" | "--out", None) => {
                    return Err(Error::Usage(format!("{word} needs a value")));
                }
                _ => return Err(Error::Usage(format!("dist has no option `{word}`"))),
            }
        }
        Ok(Options { only, out })
    }
}

fn known(name: &str) -> Result<String> {
    let names = PARTS.map(|part| part.name);
    if names.contains(&name) {
        return Ok(String::from(name));
    }
    let names = names.join(", ");
    let text = format!("no part is named `{name}`; parts: {names}");
    Err(Error::Usage(text))
}

/// Makes the selected parts, then the lists of their contents.
pub(crate) fn run(repo: &Repo, console: &Console, options: &Options) -> Result<()> {
    let out = options
        .out
        .clone()
        .unwrap_or_else(|| repo.root.join("dist"));
    let out = std::path::absolute(&out).map_err(|e| Error::io("find", &out, &e))?;
    begin(&out, options.only.is_empty())?;
    let commit = ask_in(&repo.root, "git", &["log", "-1", "--format=%ct"]);
    let epoch = env::var("SOURCE_DATE_EPOCH").ok().or(commit);
    let dist = Dist {
        repo,
        console,
        version: repo.locked_version("odkit")?,
        // The earliest time that a zip archive can hold.
        epoch: epoch.unwrap_or_else(|| String::from("315532800")),
    };
    let mut failed = Vec::new();
    for part in PARTS {
        let is_wanted =
            options.only.is_empty() || options.only.iter().any(|name| name == part.name);
        if !is_wanted {
            continue;
        }
        let folder = out.join(part.name);
        files::fresh(&folder)?;
        if let Err(error) = (part.make)(&dist, &folder) {
            console.note(&format!("{}: {}", part.name, error.message()));
            files::remove(&folder)?;
            failed.push(format!("{}: {}", part.name, error.message()));
        }
    }
    if !failed.is_empty() {
        let repeat = "`--only NAME` makes single parts again";
        let text = format!("not made: {}\n{repeat}", failed.join("\n  "));
        return Err(Error::Failed(text));
    }
    let parts = PARTS.map(|part| (part.name, part.about));
    contents::write(&dist, &out, &parts)?;
    console.note(&format!("the release is in {}", out.display()));
    Ok(())
}

/// Empties the folder of a whole release. A folder that contains other files is an error.
fn begin(out: &Path, whole: bool) -> Result<()> {
    let is_ours =
        out.join(contents::SUMS).is_file() || PARTS.iter().any(|part| out.join(part.name).is_dir());
    let is_empty = !out.exists() || files::entries(out)?.is_empty();
    if !is_ours && !is_empty {
        let text = format!(
            "{} has other files: name another folder with `--out`",
            out.display()
        );
        return Err(Error::Failed(text));
    }
    if whole {
        files::fresh(out)
    } else {
        files::create(out)
    }
}

#[cfg(test)]
mod tests {
    use std::path::{Path, PathBuf};

    use super::{Options, begin};
    use crate::files;

    fn parse(line: &str) -> Option<Options> {
        let args: Vec<String> = line.split_whitespace().map(String::from).collect();
        Options::parse(&args).ok()
    }

    #[test]
    fn command_lines() {
        let all = parse("").expect("everything is made");
        assert!(all.only.is_empty() && all.out.is_none());
        let some = parse("--only npm,bin --only=crates --out a=b").expect("these are parts");
        assert_eq!(some.only, ["npm", "bin", "crates"]);
        assert_eq!(some.out, Some(PathBuf::from("a=b")));
        for wrong in [
            "--only",
            "--only=",
            "--only nonsense",
            "--out",
            "--odd",
            "npm",
        ] {
            assert_eq!(parse(wrong), None, "{wrong}");
        }
    }

    #[test]
    fn a_folder_of_somebody_else_stays() {
        let dir = std::env::temp_dir().join(format!("xtask-dist-{}", std::process::id()));
        files::write(&dir.join("letter.txt"), "dear").expect("a temporary folder is writable");
        let refused = begin(&dir, true).expect_err("it is not a release");
        assert!(refused.message().contains("--out"), "{}", refused.message());
        assert!(dir.join("letter.txt").is_file());
        files::write(&dir.join("SHA256SUMS"), "").expect("a temporary folder is writable");
        begin(&dir, false).expect("it is a release");
        assert!(dir.join("letter.txt").is_file());
        begin(&dir, true).expect("it is a release");
        assert_eq!(files::entries(&dir), Ok(vec![]));
        begin(Path::new(&dir), true).expect("it is empty");
        let _ = std::fs::remove_dir_all(&dir);
    }

    #[test]
    fn all_parts_have_one_version() {
        let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("..");
        let read = |name: &str| files::read(&root.join(name)).expect("it can be read");
        let manifest = read("Cargo.toml");
        let own = format!("version = \"{}\"", env!("CARGO_PKG_VERSION"));
        let parts = |line: &&str| line.contains("{ path = ") && line.contains("version = ");
        assert!(manifest.lines().filter(parts).count() > 10);
        for line in manifest.lines().filter(parts) {
            assert!(line.contains(&own), "Cargo.toml: {line}");
        }
        let own = format!("\"version\": \"{}\"", env!("CARGO_PKG_VERSION"));
        for name in ["package.json", "package-lock.json"] {
            let extension = read(&format!("editors/vscode/{name}"));
            let line = extension.lines().find(|line| line.contains("\"version\""));
            assert!(line.is_some_and(|it| it.contains(&own)), "{name}: {line:?}");
        }
    }

    #[test]
    fn workflows_name_commits_and_call_cargo() {
        let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../.github/workflows");
        let is_commit =
            |it: &str| it.len() == 40 && it.bytes().all(|byte| byte.is_ascii_hexdigit());
        let mut calls = 0;
        for file in files::entries(&folder).expect("there are workflows") {
            let text = files::read(&file).expect("it can be read");
            for line in text.lines() {
                // A tag can be moved, a commit cannot.
                let Some((_, action)) = line.split_once("uses: ") else {
                    continue;
                };
                let commit = action.split(['@', ' ']).nth(1);
                assert!(commit.is_some_and(is_commit), "{}: {line}", file.display());
            }
            // rustup installs the compiler of rust-toolchain.toml, and xtask everything else.
            let own = text.matches("- run: cargo xtask ").count();
            let compilers = text.matches("- run: rustup toolchain install").count();
            assert!(own > 0 && compilers > 0, "{}", file.display());
            calls += own;
        }
        assert!(calls >= 5, "{calls}");
    }
}
