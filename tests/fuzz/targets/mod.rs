//! What is fuzzed, one file a target.

mod bench;
mod candump;
mod console;
mod eds;
mod eeprom;
mod node;
mod script;
mod sdo;
mod slcan;
mod socketcand;

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
    /// Counts frames instead of inputs, and runs for so many of them instead of a time.
    pub(crate) frames: fn(u64) -> u64,
}

impl Target {
    /// The part of these defaults that a target does not care about.
    const PLAIN: Self = Self {
        name: "",
        run: |_| {},
        seeds: Vec::new,
        make: None,
        words: &[],
        is_text: false,
        longest: 4096,
        unit: 1,
        frames: |_| 0,
    };

    /// How many inputs it counts for.
    pub(crate) fn weight(&self, input: &[u8]) -> u64 {
        match (self.frames)(1) {
            0 => 1,
            _ => sdo::frames_of(input),
        }
    }
}

/// Every target.
pub(crate) const ALL: &[Target] = &[
    sdo::TARGET,
    node::TARGET,
    eeprom::TARGET,
    eds::TARGET,
    script::TARGET,
    console::TARGET,
    slcan::TARGET,
    socketcand::TARGET,
    candump::TARGET,
];

/// The text files of a folder with these endings, its own folders included, up to a length.
fn files(folder: &str, endings: &[&str], longest: usize) -> Vec<Vec<u8>> {
    let mut found = Vec::new();
    let mut folders = vec![crate::repository(folder)];
    while let Some(folder) = folders.pop() {
        let entries = std::fs::read_dir(&folder).expect("a folder of the repository");
        for path in entries.flatten().map(|entry| entry.path()) {
            let name = path.to_string_lossy().into_owned();
            if path.is_dir() {
                folders.push(path);
            } else if endings.iter().any(|ending| name.ends_with(ending)) {
                found.push((
                    name,
                    std::fs::read(&path).expect("a file of the repository"),
                ));
            }
        }
    }
    // The order of a folder is not the same everywhere.
    found.sort();
    let short = found.into_iter().map(|(_, bytes)| bytes);
    short.filter(|bytes| bytes.len() <= longest).collect()
}
