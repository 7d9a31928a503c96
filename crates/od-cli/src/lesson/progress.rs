//! `odkit lesson progress`: a table for a class, from the codes that learners export from the page.

use std::collections::BTreeMap;
use std::fmt::Write;
use std::path::{Path, PathBuf};

use super::builtin::LESSONS;
use crate::failure::{Failure, read_error};
use crate::files;
use crate::output::{self, note};
use crate::report;

/// Name of the final test in a code; it is not a lesson.
const FINAL: &str = "final-test";

/// First word of a code; the last one is `sum=`, the FNV-1a hash of the words before it.
const BEGIN: &str = "odkit-progress/1";

#[derive(clap::Args)]
pub(super) struct Args {
    /// Files with codes, several in a file if need be; `-` is standard input
    #[arg(required = true, value_name = "FILE")]
    files: Vec<PathBuf>,
}

/// Steps that are done, all steps, and how many of them the page showed, by lesson.
type Lessons = BTreeMap<String, (u32, u32, u32)>;

pub(super) fn run(args: &Args) -> Result<(), Failure> {
    let mut learners: BTreeMap<String, Lessons> = BTreeMap::new();
    let mut bad = 0;
    for path in &args.files {
        let shown = path.display();
        let text = read(path)?;
        let codes: Vec<_> = codes(&text).collect();
        if codes.is_empty() {
            note!("{shown}: the file contains no code; a code begins with {BEGIN}");
            bad += 1;
        }
        for code in codes {
            match parse(&code) {
                Some((learner, lessons)) => {
                    let known = learners.entry(learner).or_default();
                    for (name, steps) in lessons {
                        let best = known.entry(name).or_insert(steps);
                        // Of two codes the one with more steps counts, and of these the one with fewer shown.
                        let rank =
                            |(done, all, shown): (u32, u32, u32)| (done, all, u32::MAX - shown);
                        if rank(steps) > rank(*best) {
                            *best = steps;
                        }
                    }
                }
                None => {
                    let begin: String = code.chars().take(60).collect();
                    note!("{shown}: a code is cut or changed; export it again: {begin} …");
                    bad += 1;
                }
            }
        }
    }
    if !learners.is_empty() {
        output::print(&table(&learners))?;
    }
    match bad {
        0 => Ok(()),
        _ => Err(Failure::Reported(1)),
    }
}

fn read(path: &Path) -> Result<String, Failure> {
    let failed = |error| Failure::Usage(format!("{}: {}", path.display(), read_error(&error)));
    let bytes = files::read_or_stdin(path).map_err(failed)?;
    Ok(String::from_utf8_lossy(&bytes).into_owned())
}

/// The codes in a text, each as one line; a mail program may have wrapped them.
fn codes(text: &str) -> impl Iterator<Item = String> {
    text.split(BEGIN).skip(1).map(|rest| {
        let mut code = String::from(BEGIN);
        // The lines of an answered mail begin with `>`.
        let words = rest
            .split_whitespace()
            .map(|word| word.trim_start_matches('>'));
        let words = words.filter(|word| !word.is_empty());
        for word in words.take_while(|word| word.contains('=')) {
            code.push(' ');
            code.push_str(word);
            if word.starts_with("sum=") {
                break;
            }
        }
        code
    })
}

/// Learner and lessons; `None` if the code is truncated or changed.
fn parse(code: &str) -> Option<(String, Lessons)> {
    let (body, sum) = code.rsplit_once(" sum=")?;
    if u32::from_str_radix(sum, 16).ok()? != fnv(body.as_bytes()) {
        return None;
    }
    let mut words = body.strip_prefix(BEGIN)?.split_whitespace();
    let learner = decoded(words.next()?.strip_prefix("learner=")?)?;
    let mut lessons = Lessons::new();
    for word in words {
        let (name, steps) = word.split_once('=')?;
        let (steps, _day) = steps.split_once('@')?;
        let (done, all) = steps.split_once('/')?;
        let (all, shown) = all.split_once('~').unwrap_or((all, "0"));
        let steps = (done.parse().ok()?, all.parse().ok()?, shown.parse().ok()?);
        lessons.insert(decoded(name)?, steps);
    }
    Some((learner, lessons))
}

fn fnv(bytes: &[u8]) -> u32 {
    let step = |hash: u32, byte: &u8| (hash ^ u32::from(*byte)).wrapping_mul(0x0100_0193);
    bytes.iter().fold(0x811C_9DC5, step)
}

/// Decodes `%20` and others; control characters are left out, since a terminal would interpret them.
fn decoded(word: &str) -> Option<String> {
    let mut bytes = Vec::with_capacity(word.len());
    let mut rest = word.bytes();
    while let Some(byte) = rest.next() {
        bytes.push(match byte {
            b'%' => {
                let digits = [rest.next()?, rest.next()?];
                u8::from_str_radix(std::str::from_utf8(&digits).ok()?, 16).ok()?
            }
            _ => byte,
        });
    }
    let text = String::from_utf8(bytes).ok()?;
    Some(text.chars().filter(|one| !one.is_control()).collect())
}

/// A row for each learner, a column for each lesson, and a legend of the columns.
fn table(learners: &BTreeMap<String, Lessons>) -> String {
    let mut names: Vec<&str> = LESSONS.iter().map(|(name, _)| *name).collect();
    let builtin = names.len();
    let others = learners.values().flat_map(BTreeMap::keys);
    for name in others {
        if !names.contains(&name.as_str()) {
            names.push(name);
        }
    }
    let taken = |name: &&str| learners.values().any(|lessons| lessons.contains_key(*name));
    let columns: Vec<(usize, &str)> = (1..).zip(names).filter(|(_, name)| taken(name)).collect();
    let width = |name: &String| name.chars().count();
    let first = learners.keys().map(width).max().unwrap_or(0).max(7);
    let mut text = format!("{:first$}  lessons  steps", "learner");
    for (number, _) in &columns {
        let _ = write!(text, "  {number:>5}");
    }
    text.push('\n');
    for (learner, lessons) in learners {
        let taken = || lessons.iter().filter(|(name, _)| *name != FINAL);
        let done = taken().filter(|(_, (done, all, _))| done >= all).count();
        let steps: u32 = taken().map(|(_, (done, ..))| done).sum();
        let _ = write!(text, "{learner:first$}  {done:>7}  {steps:>5}");
        for (_, name) in &columns {
            let cell = match lessons.get(*name) {
                Some((done, all, 0)) if done >= all => String::from("done"),
                Some((done, all, shown)) if done >= all => format!("done~{shown}"),
                Some((done, all, 0)) => format!("{done}/{all}"),
                Some((done, all, shown)) => format!("{done}/{all}~{shown}"),
                None => String::from("-"),
            };
            let _ = write!(text, "  {cell:>5}");
        }
        text.push('\n');
    }
    let class = report::plural(learners.len(), "learner");
    let _ = writeln!(text, "\n{class}, {builtin} lessons come with odkit");
    if learners
        .values()
        .flat_map(BTreeMap::values)
        .any(|(_, _, shown)| *shown > 0)
    {
        text.push_str("  ~  steps that the page did for the learner\n");
    }
    for (number, name) in columns {
        let _ = writeln!(text, "{number:>3}  {name}");
    }
    text
}
