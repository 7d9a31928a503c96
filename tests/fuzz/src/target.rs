//! One thing that is fuzzed, as the harness sees it.

use std::panic::resume_unwind;

use crate::random::Random;

/// One thing that takes input from outside.
#[derive(Clone, Copy)]
pub struct Target {
    /// Its name in commands and folders.
    pub name: &'static str,
    /// Panics where something does not hold.
    pub run: fn(&[u8]),
    /// Inputs to start from.
    pub seeds: fn() -> Vec<Vec<u8>>,
    /// Makes an input without a seed, if random bytes are meaningful.
    pub make: Option<fn(&mut Random) -> Vec<u8>>,
    /// Words of the input's language.
    pub words: &'static [&'static str],
    /// Does it consist of lines?
    pub is_text: bool,
    /// Inputs are cut here.
    pub longest: usize,
}

impl Target {
    /// Defaults for what a target does not set.
    pub const PLAIN: Self = Self {
        name: "",
        run: |_| {},
        seeds: Vec::new,
        make: None,
        words: &[],
        is_text: false,
        longest: 4096,
    };
}

/// A run that a target gives up without a verdict.
pub struct Enough;

impl Enough {
    /// Gives up the run. No panic hook hears of it.
    pub fn give_up() -> ! {
        resume_unwind(Box::new(Self))
    }
}
