//! Extent and seed of a run.

use std::env;
use std::fmt;
use std::hash::{BuildHasher, RandomState};
use std::path::PathBuf;
use std::thread;
use std::time::Duration;

use crate::files::repository;

/// Names the inputs of a run: `7` is all of seed 7, `7:1200` those from number 1200 on.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct Seed {
    /// Start of the random numbers.
    pub number: u64,
    /// The first input; those before it are left out.
    pub first: u64,
}

impl Seed {
    /// A seed that no run had before.
    pub fn new() -> Self {
        // Short enough to be typed: 2^40 runs differ.
        Self {
            number: RandomState::new().hash_one(0) >> 24,
            first: 0,
        }
    }

    /// Reads `7` or `7:1200`.
    pub fn parse(text: &str) -> Option<Self> {
        let (number, first) = text.split_once(':').unwrap_or((text, "0"));
        Some(Self {
            number: number.parse().ok()?,
            first: first.parse().ok()?,
        })
    }
}

impl Default for Seed {
    fn default() -> Self {
        Self::new()
    }
}

impl fmt::Display for Seed {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.first {
            0 => write!(f, "{}", self.number),
            first => write!(f, "{}:{first}", self.number),
        }
    }
}

/// Extent of a run.
#[derive(Clone, Debug)]
pub struct Plan {
    /// For each target.
    pub time: Duration,
    /// The inputs.
    pub seed: Seed,
    /// Number of frames, instead of a time, for a target that counts them.
    pub frames: Option<u64>,
    /// Threads.
    pub workers: usize,
    /// Processor time that one input may take before it counts as one that never ends.
    pub patience: Duration,
    /// Folder of the inputs that failed once, a folder per target.
    pub found: PathBuf,
    /// A run of `cargo xtask test --long`.
    pub is_long: bool,
}

impl Plan {
    /// A second for each target, with a new seed; a minute, and 1,000 million frames, for
    /// `cargo xtask test --long`. `ODKIT_FUZZ_SECONDS`, `_FRAMES` and `_SEED` say otherwise.
    ///
    /// # Errors
    /// The variable whose value is not valid.
    pub fn from_environment() -> Result<Self, String> {
        let is_long = env::var_os("ODKIT_LONG").is_some();
        let number = |name| match env::var(name) {
            Ok(text) => match text.parse::<u64>() {
                Ok(number) => Ok(Some(number)),
                Err(_) => Err(format!("{name}=`{text}` is not a number")),
            },
            Err(_) => Ok(None),
        };
        let seed = match env::var("ODKIT_FUZZ_SEED") {
            Ok(text) => Seed::parse(&text).ok_or(format!(
                "ODKIT_FUZZ_SEED=`{text}` is not a seed: write 7, or 7:1200 for input 1200 on"
            ))?,
            Err(_) => Seed::new(),
        };
        let seconds = number("ODKIT_FUZZ_SECONDS")?;
        let frames = number("ODKIT_FUZZ_FRAMES")?;
        let processors = thread::available_parallelism().map_or(1, usize::from);
        Ok(Self {
            time: Duration::from_secs(seconds.unwrap_or(if is_long { 60 } else { 1 })),
            seed,
            frames: frames.or(is_long.then_some(1_000_000_000)),
            workers: processors.min(8),
            patience: Duration::from_secs(20),
            found: repository("tests/fuzz/found"),
            is_long,
        })
    }
}
