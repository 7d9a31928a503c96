//! Stages that are cargo commands.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::sync::{Mutex, PoisonError};

use crate::console::cargo;
use crate::error::{Error, Result};
use crate::packages::{BENCHES, CLI, NO_STD, PAGE_CORE, PEER};
use crate::setup::target;
use crate::size::{self, measure};
use crate::test::context::Context;

/// All packages that are built for the host, except the benchmarks with their peers, and sources that another
/// package also has. Always the same packages and features: another selection would need another build.
#[rustfmt::skip]
pub(super) const ALL: [&str; 9] =
    ["--workspace", "--exclude", BENCHES, "--exclude", PEER, "--exclude", PAGE_CORE.0, "--features", FEATURES];

/// All packages of [`ALL`] with every feature, for what generates no code.
#[rustfmt::skip]
const CHECKED: [&str; 8] =
    ["--workspace", "--exclude", BENCHES, "--exclude", PEER, "--exclude", PAGE_CORE.0, "--all-features"];

/// Every feature that is not a default, except `defmt`: its formats give symbols names that no shared library can
/// export, and the Python module is one.
const FEATURES: &str = "\
    od-board/embassy,od-board/flash,od-devices/std,od-devices/text,od-eds/explain,od-eds/json,od-eds/serde,\
    od-eds/tools,od-eds/xdd,od-model/alloc,od-model/names,od-model/serde,od-runtime/std,od-sim/dbc,od-sim/eds,\
    od-sim/lessons,od-sim/real,od-sim/serve,odkit/embassy,odkit/flash,odkit/names,odkit/std";

/// Folders of packages whose tests are not in [`unit`].
const OUTSIDE: [&str; 5] = ["tests", "tests/compile", "tests/bench", "python", "target"];

pub(super) fn fmt(context: &Context<'_>) -> Result<()> {
    let check = ["--check", "--", "--color=never"];
    let bindgen = [
        "fmt",
        "--all",
        "--manifest-path",
        "xtask/bindgen/Cargo.toml",
    ];
    run(context, "formatting", &[&bindgen[..], &check].concat())?;
    let firmware = ["fmt", "--all", "--manifest-path", "firmware/Cargo.toml"];
    run(context, "formatting", &[&firmware[..], &check].concat())?;
    let device = ["fmt", "--manifest-path", "crates/od-capi/device/Cargo.toml"];
    run(context, "formatting", &[&device[..], &check].concat())?;
    run(
        context,
        "formatting",
        &[&["fmt", "--all"], &check[..]].concat(),
    )
}

pub(super) fn clippy(context: &Context<'_>) -> Result<()> {
    let packages: &[&str] = match (context.quick, context.long) {
        (true, _) => &["--all-features"],
        (_, true) => &["--workspace", "--all-features"],
        _ => &CHECKED,
    };
    // `unit` compiles tests as well; checking them here would take half as long again. The
    // peers of the benchmarks are checked in a long run, where they are built.
    let targets: &[&str] = if context.long {
        &["--all-targets"]
    } else {
        &[]
    };
    let rest = ["--", "-D", "warnings"];
    let args = [&["clippy"], packages, targets, &rest].concat();
    run(context, "clippy", &args)
}

/// The folder with `odkit`, the Python module, and the examples that the tests of other languages run. A second
/// caller does not call cargo again, which may be busy with a longer build.
pub(super) fn odkit(context: &Context<'_>) -> Result<PathBuf> {
    static BUILT: Mutex<bool> = Mutex::new(false);
    let mut is_built = BUILT.lock().unwrap_or_else(PoisonError::into_inner);
    if !*is_built {
        let mut build = cargo(&context.repo.root, &["build"]);
        build.args(ALL).args([
            "--lib",
            "--bin",
            CLI.1,
            "--example",
            "corpus",
            "--example",
            "tools",
        ]);
        context.console.run("building odkit", &mut build)?;
        *is_built = true;
    }
    Ok(context.repo.target.join("debug"))
}

/// Test targets of [`programs`].
const PROGRAMS: [&str; 1] = ["all"];

/// Builds all test programs in one call of cargo, which compiles in parallel what several stages run.
pub(super) fn build(context: &Context<'_>) -> Result<()> {
    odkit(context)?;
    let what = ["--lib", "--bins", "--examples", "--tests"];
    let args = [&["test", "--no-run"], &ALL[..], &what].concat();
    run(context, "test programs", &args)
}

/// The tests of all packages except the integration tests and [`programs`]; in a quick run only those inside the
/// sources. Without
/// the packages of the other stages, some would have fewer features and would be built again.
pub(super) fn unit(context: &Context<'_>) -> Result<()> {
    let names = if context.quick {
        Vec::new()
    } else {
        beside_sources(context)?
    };
    let what = ["--lib", "--bins", "--examples", "--no-fail-fast"];
    test(context, "unit tests", &[&ALL[..], &what].concat(), &names)
}

/// The command line as a user runs it, and the client and the node as a whole: half of the time of all tests beside
/// sources, and mostly waiting for programs and buses.
pub(super) fn programs(context: &Context<'_>) -> Result<()> {
    let names = PROGRAMS.map(String::from);
    let args = [&ALL[..], &["--no-fail-fast"]].concat();
    test(context, "tests of programs", &args, &names)
}

/// The test targets of the packages that [`unit`] tests.
fn beside_sources(context: &Context<'_>) -> Result<Vec<String>> {
    let mut names = Vec::new();
    for parent in ["", "crates", "tests"] {
        for member in folder(&context.repo.root.join(parent))? {
            let dir = member.join("tests");
            if !OUTSIDE
                .map(|it| context.repo.root.join(it))
                .contains(&member)
                && dir.is_dir()
            {
                names.extend(targets(&dir)?);
            }
        }
    }
    names.retain(|name| !PROGRAMS.contains(&name.as_str()));
    Ok(names)
}

/// Some of the integration tests.
pub(super) fn outside(context: &Context<'_>, names: &[&str]) -> Result<()> {
    let names: Vec<String> = names.iter().copied().map(String::from).collect();
    test(context, &names.join(", "), &ALL, &names)
}

/// The integration tests that have no stage of their own.
pub(super) fn other_outside(context: &Context<'_>) -> Result<()> {
    let mut names = targets(&context.repo.root.join("tests/tests"))?;
    names.retain(|name| !["conformance", "mutations"].contains(&name.as_str()));
    let args = [&ALL[..], &["--no-fail-fast"]].concat();
    test(context, "tests from outside", &args, &names)
}

/// The test targets of a folder: files, and folders with a `main.rs`.
fn targets(dir: &Path) -> Result<Vec<String>> {
    let is_test = |path: &PathBuf| {
        path.extension().is_some_and(|it| it == "rs") || path.join("main.rs").is_file()
    };
    let paths = folder(dir)?.into_iter().filter(is_test);
    let names = paths.filter_map(|path| Some(path.file_stem()?.to_string_lossy().into_owned()));
    Ok(names.collect())
}

/// The content of a folder, sorted.
fn folder(dir: &Path) -> Result<Vec<PathBuf>> {
    let files = fs::read_dir(dir).map_err(|e| Error::io("read", dir, &e))?;
    let mut paths: Vec<PathBuf> = files.flatten().map(|file| file.path()).collect();
    paths.sort();
    Ok(paths)
}

/// Mutated input: about a second for each target; with `--long` a minute, in an optimised build
/// with all checks.
pub(super) fn fuzz(context: &Context<'_>) -> Result<()> {
    let profile: &[&str] = if context.long {
        &["--profile", "fuzz"]
    } else {
        &[]
    };
    let mut names = ["fuzz", "mutations"].map(String::from).to_vec();
    names.extend(context.long.then(|| String::from("compiled")));
    test(context, "fuzz targets", &[profile, &ALL].concat(), &names)
}

pub(super) fn doc(context: &Context<'_>) -> Result<()> {
    let args = [&ALL[..], &["--doc", "--no-fail-fast"]].concat();
    test(context, "documentation tests", &args, &[])
}

pub(super) fn rustdoc(context: &Context<'_>) -> Result<()> {
    let mut command = cargo(&context.repo.root, &["doc", "--no-deps", "--lib"]);
    command.args(CHECKED).env("RUSTDOCFLAGS", "-D warnings");
    context.console.run("documentation", &mut command)
}

pub(super) fn no_std(context: &Context<'_>) -> Result<()> {
    target::add(context.repo, context.console, target::BARE)?;
    // Other stages build the code of this firmware, too; here only its dependencies matter.
    for package in NO_STD {
        let args = ["check", "--package", package, "--no-default-features"];
        let what = format!("{package} without the standard library");
        cross(context, &what, &[target::BARE], &args)?;
    }
    // It has a lock file of its own, so it builds the macros and their dependencies again.
    if context.long {
        let args = ["check", "--manifest-path", "firmware/rtic/Cargo.toml"];
        cross(context, "a node in RTIC", &[target::BARE], &args)?;
    }
    // The last package depends on the others.
    target::add(context.repo, context.console, target::SMALLEST)?;
    let both = ["--package", "od-devices", "--package", "od-capi"];
    let args = [&["check", "--no-default-features"], &both[..]].concat();
    let what = "od-devices and od-capi for a Cortex-M0";
    cross(context, what, &[target::SMALLEST], &args)?;
    let args = ["check", "--package", "od-board", "--all-features"];
    let what = "od-board with every feature for a Cortex-M0";
    cross(context, what, &[target::SMALLEST], &args)
}

pub(super) fn size(context: &Context<'_>) -> Result<()> {
    size::check(context.repo, context.console, context.long)
}

/// The conformance scripts of three devices, on an emulated microcontroller.
pub(super) fn firmware(context: &Context<'_>) -> Result<()> {
    measure::prepare(context.repo, context.console)?;
    let build = ["build", "--release", "--package", "odkit-firmware-twin"];
    let mut command = cargo(&context.repo.root.join("firmware"), &build);
    command
        .args(["--target", target::BARE, "--target-dir"])
        .arg(&context.repo.target);
    context.console.run("the firmware", &mut command)?;
    let programs = context.repo.target.join(target::BARE).join("release");
    let mut command = cargo(&context.repo.root, &["test"]);
    command.args(ALL).args(["--test", "firmware"]);
    command.env("ODKIT_FIRMWARE", programs);
    long(context, &mut command);
    context.console.run("scripts on the firmware", &mut command)
}

pub(super) fn hosts(context: &Context<'_>) -> Result<()> {
    for target in target::HOSTS {
        target::add(context.repo, context.console, target)?;
    }
    let args = ["check", "--package", CLI.0];
    cross(
        context,
        "odkit for Windows and macOS",
        &target::HOSTS,
        &args,
    )
}

/// cargo for other targets, in the target directory of [`Lane::Cross`](super::Lane::Cross).
fn cross(context: &Context<'_>, what: &str, targets: &[&str], args: &[&str]) -> Result<()> {
    let mut command = cargo(&context.repo.root, args);
    command.args(targets.iter().flat_map(|target| ["--target", target]));
    command.arg("--target-dir");
    command.arg(context.repo.target.join("cross"));
    context.console.run(what, &mut command)
}

/// The profile for tests is enough to check that they work.
pub(super) fn bench(context: &Context<'_>) -> Result<()> {
    let what = ["--features", "peers", "--tests", "--benches"];
    let args = [&["test", "--package", BENCHES][..], &what].concat();
    run(context, "benchmarks", &args)
}

fn run(context: &Context<'_>, what: &str, args: &[&str]) -> Result<()> {
    let mut command = cargo(&context.repo.root, args);
    context.console.run(what, &mut command)
}

fn test(context: &Context<'_>, what: &str, args: &[&str], names: &[String]) -> Result<()> {
    let mut command = cargo(&context.repo.root, &["test"]);
    command.args(args);
    command.args(names.iter().flat_map(|name| ["--test", name]));
    long(context, &mut command);
    context.console.run(what, &mut command)
}

/// Tests read `ODKIT_LONG`.
pub(super) fn long(context: &Context<'_>, command: &mut Command) {
    if context.long {
        command.env("ODKIT_LONG", "1");
    }
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeSet;
    use std::path::Path;

    use serde_json::Value;

    use super::{BENCHES, FEATURES, PAGE_CORE, PEER};
    use crate::console::cargo;

    /// A stage tests only what it builds.
    #[test]
    fn all_features_but_defmt_are_built() {
        let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("..");
        let mut metadata = cargo(&root, &["metadata", "--no-deps", "--format-version", "1"]);
        let metadata: Value = serde_json::from_slice(&metadata.output().unwrap().stdout).unwrap();
        let mut expected = BTreeSet::new();
        for package in metadata["packages"].as_array().unwrap() {
            let name = package["name"].as_str().unwrap();
            let features = package["features"].as_object().unwrap();
            let defaults = features.get("default").and_then(Value::as_array);
            let is_default = |it: &str| defaults.is_some_and(|all| all.iter().any(|one| one == it));
            if ![BENCHES, PEER, PAGE_CORE.0].contains(&name) {
                let others = features.keys().filter(|it| !is_default(it));
                let others = others.filter(|it| !["default", "defmt"].contains(&it.as_str()));
                expected.extend(others.map(|it| format!("{name}/{it}")));
            }
        }
        let built: BTreeSet<String> = FEATURES.split(',').map(String::from).collect();
        assert_eq!(built, expected);
    }
}
