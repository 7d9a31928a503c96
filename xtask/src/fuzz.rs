//! `cargo xtask fuzz`: libFuzzer on the targets of `tests/fuzz`, with a nightly compiler.
//!
//! `cargo test -p od-tests --test fuzz` runs the same targets on the pinned compiler, without
//! coverage. Inputs that fail go to `tests/fuzz/found/TARGET`, where that test tries them first;
//! inputs that reach new code are minimised and kept in `tests/fuzz/corpus/TARGET` if they are small.

use std::fs;
use std::path::{Path, PathBuf};

use crate::console::{Console, ask, ask_in, cargo, clean, say};
use crate::error::{Error, Result};
use crate::packages::TESTS;
use crate::repo::{Repo, program};
use crate::setup::toolchain;

/// The version of cargo-fuzz that is built.
const VERSION: &str = "0.13.2";

/// Files of a target's corpus in the repository, and bytes of each and of all together.
const FILES: usize = 100;
const FILE_BYTES: u64 = 4 * 1024;
const ALL_BYTES: u64 = 64 * 1024;

/// The command line of `fuzz`.
#[derive(Debug, PartialEq, Eq)]
pub(crate) struct Options {
    target: String,
    minutes: u64,
}

impl Options {
    /// Reads the arguments after `fuzz`.
    pub(crate) fn parse(args: &[String]) -> Result<Options> {
        let (mut target, mut minutes) = (None, 5);
        let mut words = args.iter().flat_map(|arg| arg.split('='));
        while let Some(word) = words.next() {
            if word == "--minutes" {
                let given = words.next().and_then(|word| word.parse().ok());
                minutes = given.filter(|minutes| *minutes > 0).ok_or_else(|| {
                    Error::Usage(String::from("--minutes needs a number, such as 10"))
                })?;
            } else if word.starts_with('-') || target.is_some() {
                return Err(Error::Usage(format!("fuzz has no option `{word}`")));
            } else {
                target = Some(String::from(word));
            }
        }
        match target {
            Some(target) => Ok(Options { target, minutes }),
            None => Err(Error::Usage(String::from(
                "fuzz needs a target: `cargo test -p od-tests --test fuzz -- --list` names them",
            ))),
        }
    }
}

/// Runs libFuzzer on one target, then keeps what it found.
pub(crate) fn run(repo: &Repo, console: &Console, options: &Options) -> Result<()> {
    let target = options.target.as_str();
    let work = Folder::new(&repo.cache().join("fuzz").join(target), "new")?;
    let seeds = Folder::new(&repo.cache().join("fuzz").join(target), "seeds")?;
    seeds.clear()?;
    let mut write = cargo(&repo.root, &["test", "--quiet", "--package", TESTS]);
    write.args(["--test", "fuzz", "--", "--exact", target]);
    write.env("ODKIT_FUZZ_SEEDS", &seeds.0);
    console.run("the inputs to start from", &mut write)?;
    if seeds.files()?.is_empty() {
        return Err(Error::Usage(format!(
            "fuzz has no target `{target}`; `cargo test -p {TESTS} --test fuzz -- --list` names them"
        )));
    }

    let (tool, host) = install(repo, console)?;
    let built = repo.target.join("cargo-fuzz");
    let mut build = clean(&tool, &repo.root.join("tests/fuzz/coverage"), &["fuzz"]);
    // The compiler of this command is pinned; libFuzzer needs another one.
    build.env("RUSTUP_TOOLCHAIN", "nightly");
    build.env_remove("RUSTC").env_remove("CARGO");
    build.args([
        "build",
        "--fuzz-dir",
        ".",
        "--target",
        &host,
        "--target-dir",
    ]);
    console.run("building for libFuzzer", build.arg(&built).arg("any"))?;

    let found = Folder::new(&repo.root.join("tests/fuzz/found"), target)?;
    let before = found.files()?;
    let fuzz = |what: &str, folders: &[&Folder], args: &[&str]| {
        let program = built.join(&host).join("release").join(program("any"));
        let mut command = clean(&program, &repo.root, args);
        command.env("ODKIT_FUZZ_TARGET", target);
        console.run(what, command.args(folders.iter().map(|folder| &folder.0)))
    };
    let seconds = format!("-max_total_time={}", options.minutes * 60);
    let artifacts = format!("-artifact_prefix={}/", found.0.display());
    let run = fuzz(
        &format!("libFuzzer, {} min", options.minutes),
        &[&work, &seeds],
        &[&seconds, &artifacts, "-timeout=20", "-print_final_stats=1"],
    );
    let after = found.files()?;
    for file in after.iter().filter(|file| !before.contains(file)) {
        let shown = file.strip_prefix(&repo.root).unwrap_or(file).display();
        say(&format!(
            "  failed: {shown}\n  again: ODKIT_FUZZ_INPUT={shown} cargo test -p {TESTS} --test fuzz -- --exact {target} --nocapture"
        ));
    }
    run?;

    let corpus = Folder::new(&repo.root.join("tests/fuzz/corpus"), target)?;
    let least = Folder::new(&repo.cache().join("fuzz").join(target), "least")?;
    least.clear()?;
    fuzz(
        "the fewest inputs that reach the same code",
        &[&least, &corpus, &work],
        &["-set_cover_merge=1", "-use_counters=0", "-max_len=4096"],
    )?;
    keep(&least, &corpus)
}

/// Copies the small files of a minimised corpus into the repository.
fn keep(from: &Folder, to: &Folder) -> Result<()> {
    let mut files: Vec<(u64, PathBuf)> = Vec::new();
    for path in from.files()? {
        let length = fs::metadata(&path).map_err(|e| Error::io("read", &path, &e))?;
        files.push((length.len(), path));
    }
    files.sort();
    to.clear()?;
    let all = files.len();
    let (mut count, mut bytes) = (0, 0);
    for (length, path) in files {
        let is_small = length <= FILE_BYTES && bytes + length <= ALL_BYTES && count < FILES;
        if let (true, Some(name)) = (is_small, path.file_name()) {
            fs::copy(&path, to.0.join(name)).map_err(|e| Error::io("copy", &path, &e))?;
            count += 1;
            bytes += length;
        }
    }
    say(&format!(
        "  {count} of {all} inputs, {bytes} bytes, are in {}; commit them",
        to.0.display()
    ));
    Ok(())
}

/// Returns the folder if it exists.
struct Folder(PathBuf);

impl Folder {
    fn new(parent: &Path, name: &str) -> Result<Folder> {
        let path = parent.join(name);
        fs::create_dir_all(&path).map_err(|e| Error::io("create", &path, &e))?;
        Ok(Folder(path))
    }

    fn files(&self) -> Result<Vec<PathBuf>> {
        let files = fs::read_dir(&self.0).map_err(|e| Error::io("read", &self.0, &e))?;
        Ok(files.flatten().map(|file| file.path()).collect())
    }

    fn clear(&self) -> Result<()> {
        for path in self.files()? {
            fs::remove_file(&path).map_err(|e| Error::io("remove", &path, &e))?;
        }
        Ok(())
    }
}

/// A nightly compiler, and cargo-fuzz in `.xtask`, built there when it is missing: the program,
/// and the system that the compiler compiles for.
fn install(repo: &Repo, console: &Console) -> Result<(PathBuf, String)> {
    toolchain::add(repo, console, "nightly")?;
    let args = ["run", "nightly", "rustc", "--print", "host-tuple"];
    let host = ask_in(&repo.root, "rustup", &args);
    let host = host.ok_or_else(|| Error::Missing(String::from("`rustup` does not run")))?;
    let root = repo.tools().join("fuzz");
    let tool = root.join("bin").join(program("cargo-fuzz"));
    let wanted = format!("cargo-fuzz {VERSION}");
    if ask(&tool, &["fuzz", "--version"]).as_deref() != Some(&*wanted) {
        let mut install = cargo(&repo.root, &["install", "--quiet", "--locked", "--debug"]);
        install.args(["cargo-fuzz", "--force", "--version", VERSION, "--root"]);
        console.run("building cargo-fuzz (once)", install.arg(&root))?;
    }
    Ok((tool, host))
}

#[cfg(test)]
mod tests {
    use super::{FILES, Folder, Options, keep};

    #[test]
    fn command_lines() {
        let parse = |line: &str| {
            let args: Vec<String> = line.split_whitespace().map(String::from).collect();
            Options::parse(&args).ok().map(|o| (o.target, o.minutes))
        };
        assert_eq!(parse("eds"), Some(("eds".into(), 5)));
        assert_eq!(parse("eds --minutes=7"), Some(("eds".into(), 7)));
        assert_eq!(parse("--minutes 2 xdd"), Some(("xdd".into(), 2)));
        for wrong in [
            "",
            "--minutes 5",
            "eds --minutes",
            "eds --minutes 0",
            "eds xdd",
            "-x",
        ] {
            assert_eq!(parse(wrong), None, "{wrong}");
        }
    }

    #[test]
    fn only_what_is_small_is_kept() {
        let dir = std::env::temp_dir().join(format!("odkit-corpus-{}", std::process::id()));
        let from = Folder::new(&dir, "from").expect("a folder");
        let to = Folder::new(&dir, "to").expect("a folder");
        std::fs::write(to.0.join("old"), "old").expect("a file");
        for number in 0..FILES + 20 {
            std::fs::write(from.0.join(format!("{number:03}")), "x").expect("a file");
        }
        std::fs::write(from.0.join("large"), vec![0; 5000]).expect("a file");
        keep(&from, &to).expect("it is copied");
        let kept = to.files().expect("files");
        assert_eq!(kept.len(), FILES);
        assert!(
            !kept
                .iter()
                .any(|path| path.ends_with("large") || path.ends_with("old"))
        );
        std::fs::remove_dir_all(&dir).expect("it is removed");
    }
}
