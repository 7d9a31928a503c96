//! The measured numbers, kept in a file so that two benches fill one table.

use std::collections::BTreeMap;
use std::fs;
use std::io;
use std::path::{Path, PathBuf};

use crate::discipline::Discipline;

/// Unit of a number.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Unit {
    /// Nanoseconds per operation; see [`stopwatch`](crate::stopwatch).
    Nanoseconds,
    /// Instructions per operation.
    Instructions,
}

/// Numbers by what they are of.
#[derive(Debug)]
pub struct Results {
    file: PathBuf,
    numbers: BTreeMap<String, f64>,
}

impl Results {
    /// Loads the results of earlier runs from `directory`.
    pub fn load(directory: &Path) -> Self {
        let file = directory.join("od-benches.tsv");
        let text = fs::read_to_string(&file).unwrap_or_default();
        let numbers = text
            .lines()
            .filter_map(|line| {
                let (key, number) = line.rsplit_once('\t')?;
                Some((key.to_owned(), number.parse().ok()?))
            })
            .collect();
        Self { file, numbers }
    }

    /// Writes them back.
    pub fn save(&self) -> io::Result<()> {
        let mut text = String::new();
        for (key, number) in &self.numbers {
            text.push_str(&format!("{key}\t{number}\n"));
        }
        fs::write(&self.file, text)
    }

    /// Replaces one number.
    pub fn set(&mut self, unit: Unit, discipline: Discipline, name: &str, number: f64) {
        self.numbers.insert(key(unit, discipline, name), number);
    }

    /// One number, if it was measured.
    pub fn get(&self, unit: Unit, discipline: Discipline, name: &str) -> Option<f64> {
        self.numbers.get(&key(unit, discipline, name)).copied()
    }
}

fn key(unit: Unit, discipline: Discipline, name: &str) -> String {
    format!("{unit:?}\t{discipline}\t{name}")
}
