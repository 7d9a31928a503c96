//! Runs inputs, notices those that fail or never end, and keeps them.

use std::cell::RefCell;
use std::panic::{self, AssertUnwindSafe};
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::sync::{Mutex, PoisonError};
use std::thread;
use std::time::{Duration, Instant};

use crate::files::repository;
use crate::mutate;
use crate::random::Random;
use crate::target::{Enough, Target};

/// How long an input may take before it counts as one that never ends.
const PATIENCE: Duration = Duration::from_secs(20);

/// How much is tried.
pub(crate) struct Plan {
    /// For each target.
    pub(crate) time: Duration,
    pub(crate) seed: u64,
    /// So many SDO frames, in inputs of their own size.
    pub(crate) frames: u64,
    workers: usize,
}

impl Plan {
    /// A second for each target; a minute, on all processors, for `cargo xtask test --long`.
    pub(crate) fn from_environment() -> Self {
        let number = |name: &str| std::env::var(name).ok()?.parse::<u64>().ok();
        let long = std::env::var_os("ODKIT_LONG").is_some();
        let seconds = number("ODKIT_FUZZ_SECONDS").unwrap_or(if long { 60 } else { 1 });
        let processors = thread::available_parallelism().map_or(1, usize::from);
        Self {
            time: Duration::from_secs(seconds),
            seed: number("ODKIT_FUZZ_SEED").unwrap_or(1),
            frames: number("ODKIT_FUZZ_FRAMES").unwrap_or(if long { 10_000_000 } else { 200_000 }),
            workers: processors.min(8),
        }
    }
}

/// An input that failed, as small as it could be made.
pub(crate) struct Failure {
    pub(crate) input: Vec<u8>,
    pub(crate) why: String,
}

thread_local! {
    /// What the last panic of this thread said.
    static SAID: RefCell<String> = const { RefCell::new(String::new()) };
}

/// Panics of inputs are reported once, when the input is small, and not as they come.
pub(crate) fn quiet_panics() {
    panic::set_hook(Box::new(|info| {
        let text = format!("{info}");
        SAID.with(|said| *said.borrow_mut() = text);
    }));
}

/// Runs one input: `Err` says how it failed.
pub(crate) fn attempt(target: &Target, input: &[u8]) -> Result<(), String> {
    match panic::catch_unwind(AssertUnwindSafe(|| (target.run)(input))) {
        Ok(()) => Ok(()),
        Err(payload) if payload.is::<Enough>() => Ok(()),
        Err(_) => Err(SAID.with(|said| said.borrow().clone())),
    }
}

/// What a worker is at, for the thread that watches the time.
#[derive(Default)]
struct Watch(Mutex<Option<(Instant, Vec<u8>)>>);

impl Watch {
    fn set(&self, now: Option<(Instant, Vec<u8>)>) {
        *self.0.lock().unwrap_or_else(PoisonError::into_inner) = now;
    }

    fn overdue(&self) -> Option<Vec<u8>> {
        let guard = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        let (since, input) = guard.as_ref()?;
        (since.elapsed() > PATIENCE).then(|| input.clone())
    }
}

/// Tries what was found before, then new inputs until the time is over. Answers how many.
pub(crate) fn run(target: &'static Target, plan: &Plan) -> Result<u64, Failure> {
    let seeds = (target.seeds)();
    let found = found(target.name);
    let done = AtomicBool::new(false);
    let count = AtomicU64::new(0);
    let failure: Mutex<Option<Failure>> = Mutex::new(None);
    let watches: Vec<Watch> = (0..plan.workers).map(|_| Watch::default()).collect();
    let end = Instant::now() + plan.time;
    thread::scope(|scope| {
        let mut workers = Vec::new();
        for (number, watch) in watches.iter().enumerate() {
            let (seeds, found, done, count, failure) = (&seeds, &found, &done, &count, &failure);
            workers.push(scope.spawn(move || {
                let mut random = Random::new(plan.seed ^ (number as u64) << 32);
                let mut known = if number == 0 { &found[..] } else { &[] }.iter();
                let frames = target.frames.map_or(0, |_| plan.frames);
                let budget = frames / plan.workers as u64;
                let mut spent = 0;
                while !done.load(Ordering::Relaxed) {
                    let input = match known.next() {
                        Some(input) => input.clone(),
                        None if budget > 0 && spent >= budget => break,
                        None if budget == 0 && Instant::now() >= end => break,
                        None => match target.make {
                            Some(make) => make(&mut random),
                            None => mutate::input(target, seeds, &mut random),
                        },
                    };
                    spent += target.weight(&input);
                    watch.set(Some((Instant::now(), input.clone())));
                    let result = attempt(target, &input);
                    watch.set(None);
                    count.fetch_add(target.weight(&input), Ordering::Relaxed);
                    if let Err(why) = result {
                        done.store(true, Ordering::Relaxed);
                        let mut first = failure.lock().unwrap_or_else(PoisonError::into_inner);
                        first.get_or_insert_with(|| smaller(target, input, why));
                    }
                }
            }));
        }
        while !workers.iter().all(thread::ScopedJoinHandle::is_finished) {
            thread::sleep(Duration::from_millis(10));
            if let Some(input) = watches.iter().find_map(Watch::overdue) {
                // A thread cannot be stopped from outside; the program can.
                never_ends(target, &input);
            }
        }
    });
    match failure.into_inner().unwrap_or_else(PoisonError::into_inner) {
        Some(failure) => Err(failure),
        None => Ok(count.into_inner()),
    }
}

fn never_ends(target: &Target, input: &[u8]) -> ! {
    let seconds = PATIENCE.as_secs();
    println!(
        "fuzz {} ... FAILED: an input takes more than {seconds} s",
        target.name
    );
    println!("  input: {}", mutate::shown(input));
    match keep(target.name, input) {
        Ok(path) => println!(
            "  again: cargo test -p od-tests --test fuzz -- --replay {}",
            path.display()
        ),
        Err(error) => println!("  it could not be written to a file: {error}"),
    }
    println!("test result: FAILED. 0 passed; 1 failed; 0 ignored; 0 measured; 0 filtered out");
    std::process::exit(101)
}

/// Shrinks for a few seconds; an input that fails in another way counts, too.
fn smaller(target: &Target, input: Vec<u8>, why: String) -> Failure {
    let end = Instant::now() + Duration::from_secs(5);
    let small = mutate::shrink(&input, target.unit, |input| {
        Instant::now() < end && attempt(target, input).is_err()
    });
    let why = attempt(target, &small).err().unwrap_or(why);
    Failure { input: small, why }
}

/// Writes an input where a person finds it.
pub(crate) fn keep(target: &str, input: &[u8]) -> std::io::Result<PathBuf> {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("fuzz");
    std::fs::create_dir_all(&folder)?;
    let sum = input.iter().fold(0xCBF2_9CE4_8422_2325_u64, |sum, byte| {
        (sum ^ u64::from(*byte)).wrapping_mul(0x0100_0000_01B3)
    });
    let path = folder.join(format!("{target}-{sum:016x}.input"));
    std::fs::write(&path, input)?;
    Ok(path)
}

/// Inputs that failed once.
fn found(target: &str) -> Vec<Vec<u8>> {
    let folder = repository("tests/fuzz/found").join(target);
    let Ok(files) = std::fs::read_dir(folder) else {
        return Vec::new();
    };
    let mut paths: Vec<PathBuf> = files.flatten().map(|file| file.path()).collect();
    paths.sort();
    paths
        .iter()
        .filter_map(|path| std::fs::read(path).ok())
        .collect()
}
