//! One thing that is fuzzed, as the harness sees it.

use crate::random::Random;

/// One thing that takes input from outside.
pub(crate) struct Target {
    pub(crate) name: &'static str,
    /// Panics where something does not hold.
    pub(crate) run: fn(&[u8]),
    /// Inputs to start from.
    pub(crate) seeds: fn() -> Vec<Vec<u8>>,
    /// Makes an input without a seed, where chance alone means something.
    pub(crate) make: Option<fn(&mut Random) -> Vec<u8>>,
    /// What the input's language knows.
    pub(crate) words: &'static [&'static str],
    /// Does it consist of lines?
    pub(crate) is_text: bool,
    /// Inputs are cut here.
    pub(crate) longest: usize,
    /// Inputs consist of pieces of so many bytes.
    pub(crate) unit: usize,
    /// Frames of an input. A target with this runs for a number of frames instead of a time.
    pub(crate) frames: Option<fn(&[u8]) -> u64>,
}

impl Target {
    /// Defaults for what a target does not set.
    pub(crate) const PLAIN: Self = Self {
        name: "",
        run: |_| {},
        seeds: Vec::new,
        make: None,
        words: &[],
        is_text: false,
        longest: 4096,
        unit: 1,
        frames: None,
    };

    /// Number of inputs, or of frames, that an input counts for.
    pub(crate) fn weight(&self, input: &[u8]) -> u64 {
        self.frames.map_or(1, |frames| frames(input))
    }
}

/// A run that a target gives up without a verdict: `panic_any(Enough)`.
pub(crate) struct Enough;
