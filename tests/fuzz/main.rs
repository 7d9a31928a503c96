//! Fuzzing on a stable compiler (cargo-fuzz needs a nightly one): inputs are made by mutation,
//! without coverage to steer them, and the same seed makes the same inputs. What an input must not do is panic, hang, or break
//! what its target says must hold.
//!
//! ```text
//! cargo test -p od-tests --test fuzz                      about a second for each target
//! cargo test -p od-tests --test fuzz -- slcan             one of them
//! ODKIT_FUZZ_SECONDS=600 ODKIT_FUZZ_SEED=7 cargo test …   longer, and other inputs
//! cargo test -p od-tests --test fuzz -- --replay FILE     one input, named as it was written
//! cargo xtask test --long --only fuzz                     a minute each, 10 million SDO frames
//! ```
//!
//! An input that fails is made smaller, written to a file, and printed with the command that
//! runs it again. Put it under `tests/fuzz/found/<target>/`, and every run tries it first.

mod files;
mod harness;
mod mutate;
mod random;
mod target;
mod targets;
mod trace;

use std::path::Path;
use std::process::ExitCode;
use std::time::Instant;

use crate::harness::{Failure, Plan};
use crate::target::Target;
use crate::targets::ALL;

fn main() -> ExitCode {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    harness::quiet_panics();
    if let Some(at) = arguments.iter().position(|word| word == "--replay") {
        return replay(arguments.get(at + 1).map(Path::new));
    }
    let words: Vec<&String> = arguments
        .iter()
        .filter(|word| !word.starts_with('-'))
        .collect();
    let plan = Plan::from_environment();
    let start = Instant::now();
    let (mut passed, mut failed) = (0, 0);
    for target in ALL {
        if !words.is_empty() && !words.iter().any(|word| target.name.contains(word.as_str())) {
            continue;
        }
        let began = Instant::now();
        match harness::run(target, &plan) {
            Ok(count) => {
                passed += 1;
                let seconds = began.elapsed().as_secs_f64();
                println!(
                    "fuzz {} ... ok: {count} inputs in {seconds:.1} s",
                    target.name
                );
            }
            Err(failure) => {
                failed += 1;
                report(target, &failure, plan.seed);
            }
        }
    }
    let verdict = if failed == 0 { "ok" } else { "FAILED" };
    println!(
        "test result: {verdict}. {passed} passed; {failed} failed; 0 ignored; 0 measured; \
         {} filtered out; finished in {:.2}s",
        ALL.len() - passed - failed,
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

fn report(target: &Target, failure: &Failure, seed: u64) {
    println!("fuzz {} ... FAILED with seed {seed}", target.name);
    println!("  {}", failure.why.replace('\n', "\n  "));
    println!("  input: {}", mutate::shown(&failure.input));
    match harness::keep(target.name, &failure.input) {
        Ok(path) => println!(
            "  again: cargo test -p od-tests --test fuzz -- --replay {}\n",
            path.display()
        ),
        Err(error) => println!("  it could not be written to a file: {error}\n"),
    }
}

/// Runs one file; its folder's name, or the start of its own, names the target.
fn replay(path: Option<&Path>) -> ExitCode {
    let Some((path, target)) = path.and_then(|path| Some((path, target_of(path)?))) else {
        let names: Vec<&str> = ALL.iter().map(|target| target.name).collect();
        eprintln!(
            "--replay takes a file that is called after its target, like {}-1.input; the \
             targets are {}",
            names[0],
            names.join(", ")
        );
        return ExitCode::from(2);
    };
    let input = match std::fs::read(path) {
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
