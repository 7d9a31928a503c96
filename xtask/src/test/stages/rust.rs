//! Stages that are cargo commands.

use crate::console::{ask, cargo};
use crate::error::{Error, Result};
use crate::setup::target::{self, Compiler};
use crate::test::Context;

/// The crates that must do without the standard library.
const NO_STD: [&str; 6] = [
    "od-model",
    "od-wire",
    "od-client",
    "od-runtime",
    "odkit",
    "od-devices",
];

/// Everything but the tests from outside and the benchmarks with their heavy peers.
const CRATES: [&str; 5] = [
    "--workspace",
    "--exclude",
    "od-tests",
    "--exclude",
    "od-benches",
];

pub(super) fn fmt(context: &Context<'_>) -> Result<()> {
    let check = ["--check", "--", "--color=never"];
    let bindgen = ["fmt", "--manifest-path", "xtask/bindgen/Cargo.toml"];
    run(context, "formatting", &[&bindgen[..], &check].concat())?;
    run(
        context,
        "formatting",
        &[&["fmt", "--all"], &check[..]].concat(),
    )
}

pub(super) fn clippy(context: &Context<'_>) -> Result<()> {
    let packages: &[&str] = if context.quick { &[] } else { &["--workspace"] };
    let targets = ["--all-targets", "--all-features", "--", "-D", "warnings"];
    let args = [&["clippy"], packages, &targets].concat();
    run(context, "clippy", &args)
}

pub(super) fn unit(context: &Context<'_>) -> Result<()> {
    let what = [
        "--all-features",
        "--lib",
        "--bins",
        "--tests",
        "--no-fail-fast",
    ];
    test(context, "unit tests", &[&CRATES[..], &what].concat())
}

pub(super) fn doc(context: &Context<'_>) -> Result<()> {
    let what = ["--all-features", "--doc", "--no-fail-fast"];
    test(
        context,
        "documentation tests",
        &[&CRATES[..], &what].concat(),
    )
}

/// One test target of od-tests.
pub(super) fn outside(context: &Context<'_>, name: &str) -> Result<()> {
    if !targets(context)?.iter().any(|target| target == name) {
        return Err(Error::Missing(format!("od-tests has no test `{name}` yet")));
    }
    test(context, name, &["--package", "od-tests", "--test", name])
}

/// The test targets of od-tests that have no stage of their own.
pub(super) fn other_outside(context: &Context<'_>) -> Result<()> {
    let mut names = targets(context)?;
    names.retain(|name| !["ui", "conformance", "fuzz", "mutations"].contains(&name.as_str()));
    if names.is_empty() {
        let text = "od-tests has no other tests yet";
        return Err(Error::Missing(String::from(text)));
    }
    let mut args = vec!["--package", "od-tests", "--no-fail-fast"];
    for name in &names {
        args.extend(["--test", name.as_str()]);
    }
    test(context, "tests from outside", &args)
}

/// Mutated input: about a second for each target, a minute with `--long`, and then in a build
/// that is fast and still checks everything.
pub(super) fn fuzz(context: &Context<'_>) -> Result<()> {
    let target = [
        "--package",
        "od-tests",
        "--test",
        "fuzz",
        "--test",
        "mutations",
    ];
    let profile: &[&str] = if context.long {
        &["--profile", "fuzz"]
    } else {
        &[]
    };
    test(context, "fuzz targets", &[profile, &target].concat())
}

pub(super) fn rustdoc(context: &Context<'_>) -> Result<()> {
    let mut command = cargo(&context.repo.root, &["doc", "--workspace", "--no-deps"]);
    command
        .args(["--lib", "--all-features", "--exclude", "od-benches"])
        .env("RUSTDOCFLAGS", "-D warnings");
    context.console.run("documentation", &mut command)
}

pub(super) fn no_std(context: &Context<'_>) -> Result<()> {
    let compiler = Compiler::get(context.repo, context.console, target::BARE)?;
    for package in NO_STD {
        let mut command = cargo(&context.repo.root, &["build", "--package", package]);
        command.args(["--no-default-features", "--target", target::BARE]);
        compiler.apply(&mut command)?;
        let what = format!("{package} without the standard library");
        context.console.run(&what, &mut command)?;
    }
    Ok(())
}

pub(super) fn bench_build(context: &Context<'_>) -> Result<()> {
    let args = ["bench", "--package", "od-benches", "--no-run"];
    run(context, "benchmarks", &args)
}

/// The names of od-tests' test targets: cargo lists them when `--test` has no name.
fn targets(context: &Context<'_>) -> Result<Vec<String>> {
    let manifest = context.repo.root.join("Cargo.toml");
    let manifest = manifest.to_string_lossy();
    let args = ["metadata", "--no-deps", "--format-version", "1"];
    let args = [&args[..], &["--manifest-path", &manifest]].concat();
    let metadata = ask("cargo", &args)
        .ok_or_else(|| Error::Failed(String::from("`cargo metadata` does not run")))?;
    Ok(test_targets(&metadata, "od-tests"))
}

/// The names of a package's test targets in the output of `cargo metadata`.
///
/// Cargo writes compact JSON; a target is `{"kind":["test"],...,"name":"ui",...}`.
fn test_targets(metadata: &str, package: &str) -> Vec<String> {
    let start = format!("{{\"name\":\"{package}\",\"version\":");
    let Some((_, rest)) = metadata.split_once(&start) else {
        return Vec::new();
    };
    // The package's targets come before its features.
    let Some((_, rest)) = rest.split_once("\"targets\":[") else {
        return Vec::new();
    };
    let targets = rest.split("\"features\":").next().unwrap_or_default();
    targets
        .split("{\"kind\":[\"test\"]")
        .skip(1)
        .filter_map(|target| target.split_once("\"name\":\"")?.1.split('"').next())
        .map(String::from)
        .collect()
}

fn run(context: &Context<'_>, what: &str, args: &[&str]) -> Result<()> {
    let mut command = cargo(&context.repo.root, args);
    context.console.run(what, &mut command)
}

fn test(context: &Context<'_>, what: &str, args: &[&str]) -> Result<()> {
    let mut command = cargo(&context.repo.root, &["test"]);
    command.args(args);
    if context.long {
        command.env("ODKIT_LONG", "1");
    }
    context.console.run(what, &mut command)
}

#[cfg(test)]
mod tests {
    use super::test_targets;

    #[test]
    fn targets_are_found_in_the_metadata() {
        let metadata = concat!(
            r#"{"packages":[{"name":"od-model","version":"0.1.0","dependencies":[],"#,
            r#""targets":[{"kind":["test"],"crate_types":["bin"],"name":"other"}],"features":{}},"#,
            r#"{"name":"od-tests","version":"0.1.0","dependencies":[{"name":"x","features":[]}],"#,
            r#""targets":[{"kind":["lib"],"crate_types":["lib"],"name":"od_tests"},"#,
            r#"{"kind":["test"],"crate_types":["bin"],"name":"ui","src_path":"/x/ui.rs"},"#,
            r#"{"kind":["test"],"crate_types":["bin"],"name":"cases"}],"features":{}}]}"#,
        );
        assert_eq!(test_targets(metadata, "od-tests"), ["ui", "cases"]);
        assert_eq!(test_targets(metadata, "od-model"), ["other"]);
        assert!(test_targets(metadata, "od-none").is_empty());
        assert!(test_targets("", "od-tests").is_empty());
    }
}
