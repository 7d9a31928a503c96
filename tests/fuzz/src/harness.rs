//! Runs inputs on a stable compiler: earlier failures, the seeds, then mutated seeds until the time
//! is over. `tests/fuzz/coverage` runs the same targets with libFuzzer, guided by coverage.

use std::env;
use std::hash::{BuildHasher, RandomState};
use std::panic::{AssertUnwindSafe, catch_unwind, resume_unwind};
use std::path::Path;
use std::sync::{Mutex, PoisonError};
use std::thread;
use std::time::{Duration, Instant};

use crate::files::{self, repository};
use crate::mutate;
use crate::random::Random;
use crate::target::{Enough, Target};

/// Maximum time for one input.
const PATIENCE: Duration = Duration::from_secs(60);

/// A number from the environment.
///
/// # Panics
/// If the variable is not a number.
fn number(name: &str) -> Option<u64> {
    let text = env::var(name).ok()?;
    let number = text.parse();
    Some(number.unwrap_or_else(|_| panic!("{name}=`{text}` is not a number")))
}

/// Time for each target: `ODKIT_FUZZ_SECONDS`, else one second, a minute in a long run.
pub fn time() -> Duration {
    let usual = if env::var_os("ODKIT_LONG").is_some() {
        60
    } else {
        1
    };
    Duration::from_secs(number("ODKIT_FUZZ_SECONDS").unwrap_or(usual))
}

/// The seed of the random generator: `ODKIT_FUZZ_SEED`, else a new one.
pub fn seed() -> u64 {
    // Short enough to be typed: 2^40 runs differ.
    number("ODKIT_FUZZ_SEED").unwrap_or_else(|| RandomState::new().hash_one(0) >> 24)
}

/// Runs a target, as the test of this name. `ODKIT_FUZZ_INPUT` names one input to run instead,
/// `ODKIT_FUZZ_SEEDS` a folder to write its seeds to.
///
/// # Panics
/// An input failed, or takes longer than a minute. It is in `tests/fuzz/found` then.
pub fn test(target: &'static Target) {
    let mut seeds = (target.seeds)();
    if let Some(folder) = env::var_os("ODKIT_FUZZ_SEEDS") {
        seeds.extend(target.make.map(|make| make(&mut Random::new(0))));
        for (number, seed) in seeds.iter().enumerate() {
            let path = Path::new(&folder).join(format!("seed-{number:04}"));
            std::fs::write(path, seed).expect("a folder for the seeds");
        }
        return;
    }
    if let Some(path) = env::var_os("ODKIT_FUZZ_INPUT") {
        let path = repository("").join(path);
        let input = std::fs::read(path).expect("ODKIT_FUZZ_INPUT names a file");
        return attempt(target, &input);
    }
    let kept = ["found", "corpus"].map(|folder| files::inputs(folder, target.name));
    let [found, corpus] = &kept;
    seeds.extend(corpus.iter().cloned());
    let number = seed();
    println!("ODKIT_FUZZ_SEED={number} makes the same inputs");
    let current = Mutex::new(None);
    let run = |input: Vec<u8>, is_new: bool| {
        set(&current, Some((Instant::now(), input.clone())));
        let result = catch_unwind(AssertUnwindSafe(|| attempt(target, &input)));
        set(&current, None);
        if let Err(panic) = result {
            if is_new {
                println!("{}", kept_as(target, &input));
            }
            resume_unwind(panic);
        }
    };
    thread::scope(|scope| {
        let work = scope.spawn(|| {
            found.iter().for_each(|input| run(input.clone(), false));
            corpus.iter().for_each(|input| run(input.clone(), false));
            let start = Instant::now();
            let mut count = 0;
            while start.elapsed() < time() {
                let mut random = Random::of(number, count);
                let input = match target.make {
                    Some(make) => make(&mut random),
                    None => mutate::input(target, &seeds, &mut random),
                };
                run(input, true);
                count += 1;
            }
            println!("{count} inputs");
        });
        while !work.is_finished() {
            thread::sleep(Duration::from_millis(20));
            let current = current.lock().unwrap_or_else(PoisonError::into_inner);
            if let Some((begun, input)) = &*current
                && begun.elapsed() > PATIENCE
            {
                // A thread cannot be stopped from outside; the process can.
                eprintln!("{} takes longer than {PATIENCE:?}", target.name);
                eprintln!("{}", kept_as(target, input));
                std::process::exit(101);
            }
        }
        if let Err(panic) = work.join() {
            resume_unwind(panic);
        }
    });
}

/// The running input, and its start time.
type Current = Mutex<Option<(Instant, Vec<u8>)>>;

fn set(current: &Current, input: Option<(Instant, Vec<u8>)>) {
    *current.lock().unwrap_or_else(PoisonError::into_inner) = input;
}

/// Runs one input.
///
/// # Panics
/// If a property does not hold.
pub fn attempt(target: &Target, input: &[u8]) {
    let result = catch_unwind(AssertUnwindSafe(|| (target.run)(input)));
    if let Err(panic) = result
        && !panic.is::<Enough>()
    {
        resume_unwind(panic);
    }
}

/// Stores an input that failed. Returns the advice for the user.
fn kept_as(target: &Target, input: &[u8]) -> String {
    match files::keep(target.name, input) {
        Ok(path) => format!(
            "kept, commit it and every run tries it first: {path}\n\
             again, with its steps: ODKIT_FUZZ_INPUT={path} cargo test -p od-tests --test fuzz -- --exact {} \
             --nocapture",
            target.name
        ),
        Err(error) => format!("{error}; the input is {}", input.escape_ascii()),
    }
}

/// Prints a step of the input that `ODKIT_FUZZ_INPUT` names.
pub fn trace(step: impl FnOnce() -> String) {
    if env::var_os("ODKIT_FUZZ_INPUT").is_some() {
        println!("{}", step());
    }
}
