//! Debian's compiler with a library of our own making.
//!
//! Debian's `rustc-web` and `rust-web-src` are one matching compiler and library
//! source. Where rustup cannot add a target, the library is built once into a private
//! sysroot under `.xtask/rust`, and a two-line `rustc` in front of Debian's compiler
//! uses it. `/usr/lib` stays as apt-get left it, and a second run costs nothing.

use std::fs;
use std::path::{Path, PathBuf};

use super::target::{WASM, std_of};
use super::{debian, script};
use crate::console::{Console, ask, cargo};
use crate::error::{Error, Result};
use crate::repo::Repo;
use crate::stamp::{Fingerprint, Stamp};

const DEBIAN_RUSTC: &str = "/usr/bin/rustc";

/// The paths of a private sysroot.
struct Private {
    dir: PathBuf,
    bin: PathBuf,
    sysroot: PathBuf,
    library: PathBuf,
    stamp: Stamp,
}

impl Private {
    /// For Debian's compiler of this version; nothing is made yet.
    fn new(repo: &Repo, target: &str, version: &str) -> Private {
        let dir = repo.tools().join("rust");
        let sysroot = dir.join("sysroot");
        let inputs = Fingerprint::new().text(version).text(target);
        Private {
            bin: dir.join("bin"),
            library: std_of(&sysroot, target),
            stamp: Stamp::new(dir.join(format!("{target}.stamp")), inputs),
            sysroot,
            dir,
        }
    }

    fn is_current(&self) -> bool {
        let rustc = self.bin.join("rustc");
        self.stamp.is_current(&[&self.library, &rustc])
    }
}

/// The folder of a `rustc` that `make` made for the compiler that is installed.
pub(super) fn made_before(repo: &Repo, target: &str) -> Option<PathBuf> {
    let private = Private::new(repo, target, &ask(DEBIAN_RUSTC, &["-vV"])?);
    private.is_current().then_some(private.bin)
}

/// Makes Debian's compiler able to build for `target`; the folder of its `rustc`.
pub(super) fn make(repo: &Repo, console: &Console, target: &str) -> Result<PathBuf> {
    check(repo, console, target)?;
    let debian = |args: &[&str]| {
        ask(DEBIAN_RUSTC, args)
            .ok_or_else(|| Error::Missing(format!("{DEBIAN_RUSTC} does not run")))
    };
    let version = debian(&["-vV"])?;
    let host = version
        .lines()
        .find_map(|line| line.strip_prefix("host: "))
        .unwrap_or_default();
    let theirs = PathBuf::from(debian(&["--print", "sysroot"])?);

    let private = Private::new(repo, target, &version);
    private.stamp.clear();
    let built = build_library(&private.dir, console, target)?;
    let library = &private.library;
    if library.exists() {
        fs::remove_dir_all(library).map_err(|e| Error::io("remove", library, &e))?;
    }
    fs::create_dir_all(library).map_err(|e| Error::io("create", library, &e))?;
    for file in built {
        let to = library.join(file.file_name().unwrap_or_default());
        fs::copy(&file, &to).map_err(|e| Error::io("write", &to, &e))?;
    }
    // Build scripts and macros run here, so the host's library has to be there too.
    let link = private.sysroot.join("lib/rustlib").join(host);
    if !link.exists() {
        script::symlink(&theirs.join("lib/rustlib").join(host), &link)?;
    }
    let text = format!(
        "#!/bin/sh\nexec {DEBIAN_RUSTC} --sysroot '{}' \"$@\"\n",
        private.sysroot.display()
    );
    script::write(&private.bin, "rustc", &text)?;
    private.stamp.set()?;
    Ok(private.bin)
}

/// Debian's compiler is only a way out if it can be had and is new enough.
fn check(repo: &Repo, console: &Console, target: &str) -> Result<()> {
    let complete = || {
        Path::new(DEBIAN_RUSTC).is_file()
            && ask(DEBIAN_RUSTC, &["--print", "sysroot"])
                .is_some_and(|s| Path::new(&s).join("lib/rustlib/src/rust/library").is_dir())
    };
    let by_hand = format!("please run `rustup target add {target}` with a network connection");
    if !complete() {
        if !debian::can_install() {
            return Err(Error::Missing(format!(
                "Rust cannot build for {target}: {by_hand}"
            )));
        }
        let found = debian::candidate(console, "rustc-web")?;
        if found.is_none_or(|version| minor(&version) < oldest(repo)) {
            return Err(Error::Missing(format!(
                "Rust cannot build for {target}, and Debian's rustc-web is too old: {by_hand}"
            )));
        }
        let why = format!("Rust cannot build for {target}");
        debian::install(console, &["rustc-web", "rust-web-src"], &why)?;
    }
    let version = ask(DEBIAN_RUSTC, &["--version"]).unwrap_or_default();
    let version = version.trim_start_matches("rustc ");
    if complete() && minor(version) >= oldest(repo) {
        Ok(())
    } else {
        Err(Error::Missing(format!(
            "{DEBIAN_RUSTC} is rustc {version} and cannot build for {target}: {by_hand}"
        )))
    }
}

/// The workspace's `rust-version`, as the number after `1.`.
fn oldest(repo: &Repo) -> u32 {
    fs::read_to_string(repo.root.join("Cargo.toml"))
        .ok()
        .and_then(|text| {
            text.lines()
                .find_map(|line| line.strip_prefix("rust-version = \"").map(minor))
        })
        .unwrap_or(0)
}

/// `96` of `1.96.0+dfsg1-1`; 0 if it is no such version.
fn minor(version: &str) -> u32 {
    let mut numbers = version.split(|c: char| !c.is_ascii_digit());
    match (numbers.next(), numbers.next()) {
        (Some("1"), Some(minor)) => minor.parse().unwrap_or(0),
        _ => 0,
    }
}

/// Builds an empty library with `-Z build-std` and returns what lies beside it.
fn build_library(dir: &Path, console: &Console, target: &str) -> Result<Vec<PathBuf>> {
    let krate = dir.join("empty");
    let source = krate.join("src");
    fs::create_dir_all(&source).map_err(|e| Error::io("create", &source, &e))?;
    let write = |path: PathBuf, text: &str| {
        fs::write(&path, text).map_err(|e| Error::io("write", &path, &e))
    };
    let manifest = "[package]\nname = \"odkit_empty\"\nedition = \"2021\"\n[workspace]\n";
    write(krate.join("Cargo.toml"), manifest)?;
    write(source.join("lib.rs"), "#![no_std]\n")?;

    let crates = if target == WASM {
        "std,panic_abort"
    } else {
        "core,alloc"
    };
    let out = dir.join("target");
    let mut build = cargo(&krate, &["build", "--release", "--target", target]);
    build
        .arg("-Z")
        .arg(format!("build-std={crates}"))
        .arg("--target-dir")
        .arg(&out)
        .env("RUSTC", DEBIAN_RUSTC)
        .env("RUSTC_BOOTSTRAP", "1");
    let what = format!("building Rust's library for {target} (once, under a minute)");
    console.run(&what, &mut build)?;

    let deps = out.join(target).join("release/deps");
    let entries = fs::read_dir(&deps).map_err(|e| Error::io("read", &deps, &e))?;
    let mut files: Vec<PathBuf> = entries
        .filter_map(|entry| entry.ok().map(|entry| entry.path()))
        .filter(|path| {
            path.extension()
                .is_some_and(|extension| extension == "rlib")
        })
        .filter(|path| !path.to_string_lossy().contains("libodkit_empty"))
        .collect();
    files.sort();
    Ok(files)
}

#[cfg(test)]
mod tests {
    use super::minor;

    #[test]
    fn compiler_versions() {
        assert_eq!(minor("1.96.0+dfsg1-1~deb12u2"), 96);
        assert_eq!(minor("1.88"), 88);
        assert_eq!(minor("1.88\""), 88);
        assert_eq!(minor("2.1"), 0);
        assert_eq!(minor("nonsense"), 0);
    }
}
