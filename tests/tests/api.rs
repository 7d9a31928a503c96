//! `tests/api`: the public items of each library crate, so that a review sees every change of them.
//!
//! rustdoc lists the items as JSON, and the format changes with the compiler. `public-api` reads
//! the output of the compiler in `rust-toolchain.toml`, so a new compiler needs a new version of
//! it. The output is unstable; `tests/api/rustdoc.sh` allows it. `ODKIT_ACCEPT=1 cargo test -p od-tests
//! --test api` writes the lists again.

use std::fs;
use std::path::Path;
use std::process::Command;

use public_api::Builder;

/// Crates that others use as libraries.
const CRATES: [&str; 10] = [
    "od-model",
    "od-wire",
    "od-eds",
    "od-client",
    "od-runtime",
    "od-board",
    "odkit",
    "od-lsp",
    "od-sim",
    "od-tools",
];

/// Packages that `ALL` in `xtask/src/test/stages/rust.rs` leaves out.
const EXCLUDED: [&str; 3] = ["od-benches", "od-benches-zencan", "od-playground-core"];

#[test]
fn public_items_are_those_of_the_lists() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("..");
    let mut cargo = Command::new(env!("CARGO"));
    // The packages and features of the stage `rustdoc`, so that their dependencies are compiled once.
    cargo.args([
        "doc",
        "--quiet",
        "--no-deps",
        "--lib",
        "--all-features",
        "--workspace",
    ]);
    cargo.args(EXCLUDED.iter().flat_map(|name| ["--exclude", name]));
    cargo.current_dir(&root);
    cargo.env("RUSTDOC", root.join("tests/api/rustdoc.sh"));
    cargo.env("RUSTDOCFLAGS", "-Zunstable-options --output-format=json");
    let made = cargo.output().expect("cargo starts");
    let error = String::from_utf8_lossy(&made.stderr);
    assert!(made.status.success(), "{error}");

    let docs = Path::new(env!("CARGO_TARGET_TMPDIR")).join("../doc");
    let mut changed = Vec::new();
    for name in CRATES {
        let json = format!("{}.json", name.replace('-', "_"));
        let items = Builder::from_rustdoc_json(docs.join(json))
            .omit_auto_derived_impls(true)
            .omit_auto_trait_impls(true)
            .omit_blanket_impls(true)
            .build()
            .unwrap_or_else(|error| panic!("{name}: {error}; see the head of this file"));
        let list: String = items.items().map(|item| format!("{item}\n")).collect();
        let path = root.join(format!("tests/api/{name}.txt"));
        let there = fs::read_to_string(&path).unwrap_or_default();
        if std::env::var_os("ODKIT_ACCEPT").is_some() {
            fs::write(&path, list).expect("the list can be written");
        } else if there != list {
            let gone = there.lines().filter(|line| !has(&list, line));
            changed.extend(gone.map(|line| format!("- {line}")));
            let new = list.lines().filter(|line| !has(&there, line));
            changed.extend(new.map(|line| format!("+ {line}")));
        }
    }
    assert!(
        changed.is_empty(),
        "public items changed; write the lists again with\n  \
         ODKIT_ACCEPT=1 cargo test -p od-tests --test api\n{}",
        changed.join("\n")
    );
}

/// Returns whether a list has the line.
fn has(list: &str, line: &str) -> bool {
    list.lines().any(|own| own == line)
}
