//! `cargo bench -p od-benches --features peers [-- timing | counts | table | count …]`
//!
//! - nothing: `timing`, then `counts`, then the table
//! - `timing`: nanoseconds per operation; `OD_BENCH_ROUNDS` (default 800) rounds
//! - `counts`: instructions per operation, where there is valgrind
//! - `table`: what earlier runs measured
//! - `count CONTENDER DISCIPLINE N`: N operations and nothing else, for callgrind;
//!   a discipline is a dictionary size, `pdo`, or a device such as `gxmm` or `en580c-moving`

use std::env;
use std::path::Path;
use std::process::ExitCode;

use od_benches::discipline::disciplines;
use od_benches::results::{Results, Unit};
use od_benches::roster;
use od_benches::{callgrind, stopwatch, table};

fn main() -> ExitCode {
    let mut arguments: Vec<String> = env::args().skip(1).collect();
    // Cargo adds `--bench`, unless it runs benches as tests.
    let measure = !arguments.is_empty();
    arguments.retain(|argument| argument != "--bench");
    let arguments: Vec<&str> = arguments.iter().map(String::as_str).collect();

    let directory = Path::new(env!("CARGO_TARGET_TMPDIR"));
    let mut results = Results::load(directory);
    match arguments[..] {
        [] if !measure => {
            time(&mut results, 1);
            return ExitCode::SUCCESS;
        }
        [] => {
            time(&mut results, rounds());
            count(&mut results);
        }
        ["timing"] => time(&mut results, rounds()),
        ["counts"] => count(&mut results),
        ["table"] => {}
        ["count", name, discipline, operations] => return run(name, discipline, operations),
        _ => {
            eprintln!("usage: [timing | counts | table | count CONTENDER DISCIPLINE N]");
            return ExitCode::from(2);
        }
    }
    results.save().expect("Cargo's own directory is writable");
    println!("{}", table::render(&results));
    ExitCode::SUCCESS
}

/// Number of rounds.
fn rounds() -> usize {
    let rounds = env::var("OD_BENCH_ROUNDS").ok();
    rounds.and_then(|rounds| rounds.parse().ok()).unwrap_or(800)
}

fn time(results: &mut Results, rounds: usize) {
    for discipline in disciplines() {
        eprintln!("timing {discipline}");
        let (names, mut subjects): (Vec<_>, Vec<_>) = roster::NAMES
            .into_iter()
            .filter_map(|name| Some((name, roster::subject(name, discipline)?)))
            .unzip();
        let times = stopwatch::race(&mut subjects, rounds);
        for (name, time) in names.into_iter().zip(times) {
            results.set(Unit::Nanoseconds, discipline, name, time);
        }
    }
}

fn count(results: &mut Results) {
    if !callgrind::available() {
        eprintln!("no valgrind, so no instruction counts (Debian: apt install valgrind)");
        return;
    }
    for discipline in disciplines() {
        eprintln!("counting {discipline}");
        for name in roster::NAMES {
            if roster::subject(name, discipline).is_some() {
                let number = callgrind::instructions(name, discipline);
                results.set(Unit::Instructions, discipline, name, number);
            }
        }
    }
}

/// Runs one subject for [`callgrind`].
fn run(name: &str, discipline: &str, operations: &str) -> ExitCode {
    let (Ok(discipline), Ok(operations)) = (discipline.parse(), operations.parse()) else {
        eprintln!("not a discipline and a number: `{discipline} {operations}`");
        return ExitCode::from(2);
    };
    let Some(mut subject) = roster::subject(name, discipline) else {
        eprintln!("`{name}` does not take part in `{discipline}`");
        eprintln!("contenders: {}", roster::NAMES.join(", "));
        return ExitCode::from(2);
    };
    subject.run(operations);
    ExitCode::SUCCESS
}
