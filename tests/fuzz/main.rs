//! Fuzzing on a stable compiler: inputs are made by mutation, without coverage to steer them.
//! An input must not panic, compute without end, or break a promise that its target checks. `tests/fuzz/src/targets` has the targets, and `cargo xtask fuzz TARGET` runs the same
//! ones with libFuzzer, which coverage steers.
//!
//! ```text
//! cargo test -p od-tests --test fuzz                      about a second for each target
//! cargo test -p od-tests --test fuzz -- slcan             one of them
//! ODKIT_FUZZ_SECONDS=600 cargo test …                     longer
//! ODKIT_FUZZ_SEED=7 cargo test …                          the inputs of seed 7
//! ODKIT_FUZZ_SEED=7:1200 cargo test …                     the same, from number 1200 on
//! cargo test -p od-tests --test fuzz -- --replay FILE     one input, with its steps
//! cargo xtask test --long --only fuzz                     a minute each, 1,000 million frames,
//!                                                         and dictionaries that the macro makes
//! ```
//!
//! Each run has a new seed and prints it; one seed makes the same inputs on every machine. An
//! input that fails is made smaller and written to `tests/fuzz/found/TARGET`, where every run
//! tries it first: commit it with the correction. `tests/fuzz/corpus/TARGET` has inputs that
//! libFuzzer found worth keeping.

mod compiled;

use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::time::Instant;

use od_fuzz::files::repository;
use od_fuzz::harness;
use od_fuzz::plan::Plan;
use od_fuzz::random::Random;
use od_fuzz::target::Target;
use od_fuzz::targets::{self, ALL};
use od_fuzz::trace;

fn main() -> ExitCode {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    harness::quiet_panics();
    match arguments.first().map(String::as_str) {
        Some("--replay") => return replay(arguments.get(1).map(Path::new)),
        Some("--seeds") => return seeds(arguments.get(1), arguments.get(2).map(Path::new)),
        _ => {}
    }
    let plan = match Plan::from_environment() {
        Ok(plan) => plan,
        Err(why) => {
            eprintln!("{why}");
            return ExitCode::from(2);
        }
    };
    println!(
        "fuzz: seed {0}; ODKIT_FUZZ_SEED={0} makes the same inputs again",
        plan.seed
    );
    let words = arguments.iter().filter(|word| !word.starts_with('-'));
    let words: Vec<&String> = words.collect();
    let is_meant = |name: &str| words.iter().any(|word| name.contains(word.as_str()));
    let is_named = |target: &&Target| words.is_empty() || is_meant(target.name);
    let start = Instant::now();
    let (mut passed, mut failed) = (0, 0);
    for target in ALL.iter().filter(is_named) {
        match harness::run(target, &plan) {
            Ok(done) => {
                passed += 1;
                println!("fuzz {} ... ok: {}", target.name, done.shown(target));
            }
            Err(failure) => {
                failed += 1;
                println!("{}", failure.shown(target));
            }
        }
    }
    if is_meant(compiled::NAME) || plan.is_long && words.is_empty() {
        match compiled::run(&plan) {
            Ok(count) => {
                passed += 1;
                println!("fuzz {} ... ok: {count} devices", compiled::NAME);
            }
            Err(why) => {
                failed += 1;
                println!("fuzz {} ... FAILED\n  {why}", compiled::NAME);
            }
        }
    }
    let verdict = if failed == 0 { "ok" } else { "FAILED" };
    println!(
        "test result: {verdict}. {passed} passed; {failed} failed; 0 ignored; 0 measured; \
         {} filtered out; finished in {:.2}s",
        (ALL.len() + 1).saturating_sub(passed + failed),
        start.elapsed().as_secs_f64()
    );
    exit_code(failed == 0)
}

fn exit_code(well: bool) -> ExitCode {
    if well {
        ExitCode::SUCCESS
    } else {
        ExitCode::FAILURE
    }
}

/// Runs one file. Its folder is called after its target, or the file is: `sdo-1.input`.
fn replay(path: Option<&Path>) -> ExitCode {
    let Some((path, target)) = path.and_then(|path| Some((there(path), target_of(path)?))) else {
        eprintln!(
            "--replay needs a file in a folder that is called after its target; {}",
            names()
        );
        return ExitCode::from(2);
    };
    let input = match std::fs::read(&path) {
        Ok(input) => input,
        Err(error) => {
            eprintln!("{}: {error}", path.display());
            return ExitCode::from(2);
        }
    };
    trace::begin();
    let began = Instant::now();
    let result = harness::attempt(target, &input);
    match &result {
        Ok(()) => println!("{}: holds, in {:?}", target.name, began.elapsed()),
        Err(why) => println!("{}: {why}", target.name),
    }
    exit_code(result.is_ok())
}

/// Writes what a target starts from into a folder: `cargo xtask fuzz` begins there, too.
fn seeds(name: Option<&String>, folder: Option<&Path>) -> ExitCode {
    let target = name.and_then(|name| targets::of(name));
    let (Some(target), Some(folder)) = (target, folder) else {
        eprintln!("--seeds needs a target and a folder; {}", names());
        return ExitCode::from(2);
    };
    let mut seeds = target.all_seeds();
    seeds.extend(target.make.map(|make| make(&mut Random::new(0))));
    for (number, seed) in seeds.iter().enumerate() {
        let path = folder.join(format!("seed-{number:04}"));
        if let Err(error) = std::fs::write(&path, seed) {
            eprintln!("{}: {error}", path.display());
            return ExitCode::FAILURE;
        }
    }
    ExitCode::SUCCESS
}

fn names() -> String {
    let names: Vec<&str> = ALL.iter().map(|target| target.name).collect();
    format!("the targets are {}", names.join(", "))
}

/// The path itself, or from the root of the repository: cargo runs tests in their package.
fn there(path: &Path) -> PathBuf {
    if path.exists() {
        path.into()
    } else {
        repository("").join(path)
    }
}

fn target_of(path: &Path) -> Option<&'static Target> {
    let words = [
        path.file_name()?,
        path.parent()?.file_name().unwrap_or_default(),
    ];
    let words = words.map(|word| word.to_string_lossy().into_owned());
    ALL.iter().find(|target| {
        let own = words[0].split('-').next() == Some(target.name);
        own || words[1] == target.name
    })
}
