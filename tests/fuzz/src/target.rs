//! A fuzz target, as the harness uses it.

use std::panic::resume_unwind;

use crate::random::Random;

/// Code that accepts untrusted input.
#[derive(Clone, Copy)]
pub struct Target {
    /// Its name in commands and folders.
    pub name: &'static str,
    /// Panics if a property does not hold.
    pub run: fn(&[u8]),
    /// Inputs to start from.
    pub seeds: fn() -> Vec<Vec<u8>>,
    /// Makes an input without a seed, if random bytes are useful.
    pub make: Option<fn(&mut Random) -> Vec<u8>>,
    /// Words of the input's language.
    pub words: &'static [&'static str],
    /// Whether the input consists of lines.
    pub is_text: bool,
    /// Maximum length of an input.
    pub longest: usize,
}

impl Target {
    /// Default values of the other fields.
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

/// A run that a target ends without a result.
pub struct Enough;

impl Enough {
    /// Ends the run without a result. The panic hook is not called.
    pub fn give_up() -> ! {
        resume_unwind(Box::new(Self))
    }
}
