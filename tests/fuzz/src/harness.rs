//! Runs inputs, notices those that fail or never end, and keeps them.

use std::any::Any;
use std::cell::{Cell, RefCell};
use std::panic::{self, AssertUnwindSafe};
use std::path::PathBuf;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::sync::{Mutex, PoisonError};
use std::thread;
use std::time::{Duration, Instant};

use crate::found;
use crate::mutate;
use crate::plan::{Plan, Seed};
use crate::random::Random;
use crate::target::{Enough, Target};
use crate::watch::{Watch, Watcher};

/// An input that failed, as small as it could be made.
#[derive(Debug)]
pub struct Failure {
    /// The input.
    pub input: Vec<u8>,
    /// The message of the panic.
    pub why: String,
    /// Makes the input again, before it was made small; `None` for one that is kept.
    pub seed: Option<Seed>,
    /// The file that has it now, or why none has.
    pub kept: Result<PathBuf, String>,
}

/// Count and duration of a run.
#[derive(Clone, Copy, Debug)]
pub struct Done {
    /// Number of inputs, or of frames for a target that counts them.
    pub count: u64,
    /// Its duration.
    pub time: Duration,
}

thread_local! {
    /// The message of this thread's last panic.
    static SAID: RefCell<String> = const { RefCell::new(String::new()) };
    /// This thread runs an input.
    static IS_ATTEMPT: Cell<bool> = const { Cell::new(false) };
}

/// Panics of inputs are reported once, when the input is small, and not as they come.
pub fn quiet_panics() {
    let usual = panic::take_hook();
    panic::set_hook(Box::new(move |info| {
        if IS_ATTEMPT.get() {
            SAID.set(info.to_string())
        } else {
            usual(info)
        }
    }));
}

/// Runs one input.
///
/// # Errors
/// The message of the panic.
pub fn attempt(target: &Target, input: &[u8]) -> Result<(), String> {
    IS_ATTEMPT.set(true);
    let result = panic::catch_unwind(AssertUnwindSafe(|| (target.run)(input)));
    IS_ATTEMPT.set(false);
    match result {
        Ok(()) => Ok(()),
        Err(payload) if payload.is::<Enough>() => Ok(()),
        Err(payload) => Err(said(&*payload)),
    }
}

/// The message that the hook kept, or else the one that the panic carries.
fn said(payload: &(dyn Any + Send)) -> String {
    let heard = SAID.take();
    let text = || payload.downcast_ref::<String>().cloned();
    let word = || {
        payload
            .downcast_ref::<&str>()
            .map(|text| (*text).to_string())
    };
    if heard.is_empty() {
        text().or_else(word).unwrap_or_default()
    } else {
        heard
    }
}

/// Inputs by number: first those that failed once, then new ones.
struct Inputs<'a> {
    target: &'a Target,
    found: Vec<Vec<u8>>,
    seeds: Vec<Vec<u8>>,
    seed: Seed,
}

impl Inputs<'_> {
    fn get(&self, number: u64) -> (Vec<u8>, Option<Seed>) {
        if let Some(input) = self.found.get(number as usize) {
            return (input.clone(), None);
        }
        let seed = Seed {
            first: self.seed.first + number - self.found.len() as u64,
            ..self.seed
        };
        let mut random = Random::of(seed.number, seed.first);
        let input = match self.target.make {
            Some(make) => make(&mut random),
            None => mutate::input(self.target, &self.seeds, &mut random),
        };
        (input, Some(seed))
    }
}

/// Tries what was found before, then new inputs until the time is over.
///
/// # Errors
/// The first input that failed.
pub fn run(target: &Target, plan: &Plan) -> Result<Done, Box<Failure>> {
    let inputs = Inputs {
        target,
        found: found::load(&plan.found, target.name),
        seeds: target.all_seeds(),
        seed: plan.seed,
    };
    let state = State::default();
    let watches: Vec<Watch> = (0..plan.workers).map(|_| Watch::default()).collect();
    let start = Instant::now();
    let main = thread::current();
    thread::scope(|scope| {
        let workers: Vec<_> = watches
            .iter()
            .map(|watch| {
                let (inputs, state, main) = (&inputs, &state, &main);
                scope.spawn(move || {
                    watch.begin();
                    state.work(inputs, plan, watch, start);
                    main.unpark();
                })
            })
            .collect();
        let mut watchers: Vec<Watcher> = watches.iter().map(|_| Watcher::default()).collect();
        let mut told = Instant::now();
        while !workers.iter().all(thread::ScopedJoinHandle::is_finished) {
            thread::park_timeout(Duration::from_millis(20));
            for (watcher, watch) in watchers.iter_mut().zip(&watches) {
                if let Some(input) = watcher.overdue(watch, plan.patience) {
                    never_ends(target, plan, input);
                }
            }
            if told.elapsed() > Duration::from_secs(60) {
                told = Instant::now();
                println!("fuzz {}: {}", target.name, state.done(start).shown(target));
            }
        }
    });
    let failure = state.failure.lock();
    match failure.unwrap_or_else(PoisonError::into_inner).take() {
        Some(failure) => Err(failure),
        None => Ok(state.done(start)),
    }
}

/// Shared by the workers.
#[derive(Default)]
struct State {
    /// The number of the next input.
    next: AtomicU64,
    count: AtomicU64,
    is_over: AtomicBool,
    failure: Mutex<Option<Box<Failure>>>,
}

impl State {
    fn done(&self, start: Instant) -> Done {
        Done {
            count: self.count.load(Ordering::Relaxed),
            time: start.elapsed(),
        }
    }

    fn work(&self, inputs: &Inputs<'_>, plan: &Plan, watch: &Watch, start: Instant) {
        let target = inputs.target;
        while !self.is_over.load(Ordering::Relaxed) {
            let number = self.next.fetch_add(1, Ordering::Relaxed);
            let is_enough = match (target.frames, plan.frames) {
                (Some(_), Some(frames)) => self.count.load(Ordering::Relaxed) >= frames,
                _ => start.elapsed() >= plan.time,
            };
            if is_enough && number >= inputs.found.len() as u64 {
                return;
            }
            let (input, seed) = inputs.get(number);
            watch.set(Some((number, input.clone())));
            let result = attempt(target, &input);
            watch.set(None);
            self.count
                .fetch_add(target.weight(&input), Ordering::Relaxed);
            if let Err(why) = result {
                self.is_over.store(true, Ordering::Relaxed);
                let mut first = self.failure.lock().unwrap_or_else(PoisonError::into_inner);
                first.get_or_insert_with(|| Box::new(smaller(target, plan, input, why, seed)));
            }
        }
    }
}

impl Done {
    /// `12,345 frames in 1.2 s, 10,288 per second`.
    pub fn shown(&self, target: &Target) -> String {
        let seconds = self.time.as_secs_f64();
        let rate = self.count as f64 / seconds.max(0.001);
        format!(
            "{} {} in {seconds:.1} s, {} per second",
            grouped(self.count),
            target.unit_name(),
            grouped(rate as u64)
        )
    }
}

/// A number with a comma before each three digits.
fn grouped(number: u64) -> String {
    let digits = number.to_string();
    let mut text = String::new();
    for (at, digit) in digits.chars().enumerate() {
        if at > 0 && (digits.len() - at).is_multiple_of(3) {
            text.push(',');
        }
        text.push(digit);
    }
    text
}

/// A thread cannot be stopped from outside; the program can.
fn never_ends(target: &Target, plan: &Plan, input: Vec<u8>) -> ! {
    let failure = Failure {
        kept: kept(target, plan, &input),
        why: format!(
            "it computes for more than {} s",
            plan.patience.as_secs_f64()
        ),
        input,
        seed: None,
    };
    println!("{}", failure.shown(target));
    println!("test result: FAILED. 0 passed; 1 failed; 0 ignored; 0 measured; 0 filtered out");
    std::process::exit(101)
}

/// Shrinks for a few seconds; an input that fails in another way counts, too.
fn smaller(
    target: &Target,
    plan: &Plan,
    input: Vec<u8>,
    why: String,
    seed: Option<Seed>,
) -> Failure {
    let end = Instant::now() + Duration::from_secs(10);
    let small = match seed {
        Some(_) => mutate::shrink(&input, target.unit, |input| {
            Instant::now() < end && attempt(target, input).is_err()
        }),
        // It has a file already.
        None => input,
    };
    Failure {
        why: attempt(target, &small).err().unwrap_or(why),
        kept: kept(target, plan, &small),
        input: small,
        seed,
    }
}

fn kept(target: &Target, plan: &Plan, input: &[u8]) -> Result<PathBuf, String> {
    found::keep(&plan.found, target.name, input).map_err(|error| error.to_string())
}

impl Failure {
    /// The failure as text, with the commands that run the input again.
    pub fn shown(&self, target: &Target) -> String {
        let command = "cargo test -p od-tests --test fuzz --";
        let mut text = format!("fuzz {} ... FAILED\n  ", target.name);
        text += &self.why.replace('\n', "\n  ");
        text += &format!("\n  input: {}\n", mutate::shown(&self.input));
        text += &match &self.kept {
            Ok(path) => format!(
                "  kept, commit it and every run tries it first: {path}\n  \
                 again: {command} --replay {path}\n",
                path = crate::files::short(path).display()
            ),
            Err(error) => format!("  it could not be written to a file: {error}\n"),
        };
        if let Some(seed) = self.seed {
            text += &format!(
                "  from chance: ODKIT_FUZZ_SEED={seed} {command} {}\n",
                target.name
            );
        }
        text
    }
}
