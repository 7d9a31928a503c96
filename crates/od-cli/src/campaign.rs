//! `odkit campaign`: a script with draws, once for each seed.

use std::collections::{BTreeMap, HashMap};
use std::fmt::Write;
use std::path::{Path, PathBuf};
use std::sync::{Mutex, PoisonError};
use std::time::Instant as Clock;

use od_model::Refused;
use od_runtime::NodeId;
use od_sim::VirtualDevice;
use od_sim::script::campaign::Failure as Fails;
use od_sim::script::{Campaign, Host, Reason, Script};
use od_tools::junit::{Case, Outcome, Run, Suite};

use crate::failure::Failure;
use crate::output::{self, note};
use crate::run::{read, script_of};
use crate::terminal::Terminal;
use crate::workers::at_once;
use crate::{files, report};

/// Least number of seeds that a thread takes at a time.
const CHUNK: u64 = 200;
/// Highest number of parts that the seeds are divided into.
const CHUNKS: u64 = 100_000;
/// Number of seeds of a failure that are printed.
const SHOWN: usize = 1000;

/// Run a script with `random` lines once for each seed, in virtual time
///
/// `random shaft rpm -3000..3000`, `random fault`, `random power cut` and `random 10 times A | B` draw
/// what happens; `expect` lines say what must hold. A failure is shown with its first seed and with a
/// script that fails at the same line and has only those draws that the failure needs; `odkit run`
/// plays it. `odkit run FILE --seed N` plays the whole run of a seed. All processors are used.
///
/// Exit code 0: all seeds passed; 1: an expectation failed; 2: the script cannot be read or carried out.
#[derive(clap::Args)]
pub(crate) struct Args {
    /// The script, or `-` for standard input
    script: String,
    /// The seeds: from A to below B, or one
    #[arg(long, value_name = "A..B", default_value = "0..1000", value_parser = seeds)]
    seeds: (u64, u64),
    /// Run part I of N of the seeds: I, I + N, I + 2 N and so on
    #[arg(long, value_name = "I/N", default_value = "1/1", value_parser = shard)]
    shard: (u64, u64),
    /// Write a report as JUnit XML
    #[arg(long, value_name = "FILE")]
    junit: Option<PathBuf>,
    /// Write the script of each failure into this folder
    #[arg(long, value_name = "DIR")]
    save: Option<PathBuf>,
}

/// Reads `0..1000`, or one seed.
fn seeds(text: &str) -> Result<(u64, u64), String> {
    let number = |text: &str| text.parse::<u64>().ok();
    let range = match text.split_once("..") {
        Some((first, end)) => number(first).zip(number(end)),
        None => number(text).and_then(|seed| Some((seed, seed.checked_add(1)?))),
    };
    range
        .filter(|(first, end)| first < end)
        .ok_or_else(|| "write `0..1000`, the first seed and the one after the last".into())
}

/// Reads `3/16`.
fn shard(text: &str) -> Result<(u64, u64), String> {
    let parts = text.split_once('/');
    let parts = parts.and_then(|(part, parts)| part.parse().ok().zip(parts.parse().ok()));
    parts
        .filter(|(part, parts)| (1..=*parts).contains(part))
        .ok_or_else(|| "write `3/16` for the third of 16 parts".into())
}

/// Makes each device of a script once.
struct Workshop<'a> {
    terminal: Terminal<'a>,
    made: HashMap<(Option<String>, Option<NodeId>), VirtualDevice>,
}

impl<'a> Workshop<'a> {
    fn beside(script: &Path) -> Self {
        Self {
            terminal: Terminal::beside(script, ("gxmm", None)),
            made: HashMap::new(),
        }
    }
}

impl Host for Workshop<'_> {
    fn inner(&mut self) -> Option<&mut dyn Host> {
        Some(&mut self.terminal)
    }

    fn device(
        &mut self,
        name: Option<&str>,
        node_id: Option<NodeId>,
    ) -> Result<VirtualDevice, Refused> {
        let key = (name.map(str::to_owned), node_id);
        if let Some(device) = self.made.get(&key) {
            return Ok(device.clone());
        }
        let device = self.terminal.device(name, node_id)?;
        self.made.insert(key, device.clone());
        Ok(device)
    }
}

/// The failures at one line.
struct Kind {
    /// Those of the lowest seed.
    first: Fails,
    seeds: Vec<u64>,
}

/// Failures by their lines.
type Kinds = BTreeMap<u32, Kind>;

pub(crate) fn run(args: &Args) -> Result<(), Failure> {
    let began = Clock::now();
    let script = script_of(&args.script, &read(&args.script)?)?;
    if let Some(path) = &args.junit {
        files::claim(path)?;
    }
    let path = Path::new(&args.script);
    let campaign = Campaign::new(&script, &mut Workshop::beside(path));
    let campaign = campaign.map_err(|stop| {
        output::error(&format!("{}: {stop}", args.script));
        Failure::Reported(code_of(&stop.reason))
    })?;
    if !campaign.draws() {
        return Err(Failure::Usage(format!(
            "{}: the script has no `random` line, so each run is the same; add one, or use `odkit run`",
            args.script
        )));
    }
    let (first, end) = args.seeds;
    let (part, step) = args.shard;
    // The number of seeds of this part.
    let count = (end - first).saturating_sub(part - 1).div_ceil(step);
    let size = CHUNK.max(count.div_ceil(CHUNKS));
    let chunks: Vec<u64> = (0..count.div_ceil(size))
        .map(|chunk| chunk * size)
        .collect();
    // A bench can go to another thread, but only one thread at a time can look at it.
    let campaign = Mutex::new(campaign);
    let failed = at_once(&chunks, |chunk| {
        let campaign = campaign
            .lock()
            .unwrap_or_else(PoisonError::into_inner)
            .clone();
        let mut host = Workshop::beside(path);
        let mut kinds = Kinds::new();
        for place in *chunk..count.min(chunk + size) {
            let seed = first + (part - 1) + place * step;
            if let Err(failure) = campaign.run(seed, &mut host) {
                add(&mut kinds, *failure, &[seed]);
            }
        }
        kinds
    });
    let mut kinds = Kinds::new();
    for kind in failed.into_iter().flat_map(Kinds::into_values) {
        add(&mut kinds, kind.first, &kind.seeds);
    }
    let told: Vec<FailureText> = kinds
        .into_values()
        .map(|kind| FailureText::of(kind, path))
        .collect();
    report(args, &told, count, began.elapsed().as_secs_f64())
}

fn add(kinds: &mut Kinds, first: Fails, seeds: &[u64]) {
    let kind = kinds.entry(first.stop.line).or_insert_with(|| Kind {
        first,
        seeds: Vec::new(),
    });
    kind.seeds.extend(seeds);
}

struct FailureText {
    seeds: Vec<u64>,
    reason: Reason,
    /// The line with its number, time and draw, and the reason.
    text: String,
    script: String,
}

impl FailureText {
    fn of(kind: Kind, path: &Path) -> Self {
        let script = kind.first.shrunk(&mut Workshop::beside(path));
        let stop = kind.first.stop;
        Self {
            seeds: kind.seeds,
            text: stop.to_string(),
            reason: stop.reason,
            script: with_paths(&script, path),
        }
    }

    fn name(&self) -> String {
        format!("seed {}", self.seeds[0])
    }
}

fn code_of(reason: &Reason) -> u8 {
    match reason {
        Reason::Failed { .. } => 1,
        Reason::Impossible(_) => 2,
    }
}

/// The script with absolute paths of its files, so that it can be played in another folder.
fn with_paths(script: &str, path: &Path) -> String {
    let folder = path.parent().unwrap_or(Path::new(""));
    let line = |line: &str| {
        let parsed = Script::parse(line).ok()?;
        let name = parsed.statements().first()?.device()?;
        if od_devices::find(name).is_some() {
            return None;
        }
        let whole = |part: &str| std::path::absolute(folder.join(part)).ok();
        let parts: Option<Vec<PathBuf>> = if folder.join(name).exists() {
            Some(vec![whole(name)?])
        } else {
            name.split('+').map(whole).collect()
        };
        let parts: Vec<String> = parts?
            .iter()
            .map(|part| part.display().to_string())
            .collect();
        let quoted = format!("\"{name}\"");
        let written = if line.contains(&quoted) {
            &quoted
        } else {
            name
        };
        Some(line.replacen(written, &format!("\"{}\"", parts.join("+")), 1))
    };
    script
        .lines()
        .map(|text| format!("{}\n", line(text).as_deref().unwrap_or(text)))
        .collect()
}

fn report(args: &Args, told: &[FailureText], count: u64, seconds: f64) -> Result<(), Failure> {
    let failed: usize = told.iter().map(|one| one.seeds.len()).sum();
    let passed = count - failed as u64;
    if let Some(path) = &args.junit {
        let xml = junit(&args.script, told, passed, seconds);
        output::write(path, xml.as_bytes())?;
    }
    if let Some(folder) = &args.save {
        std::fs::create_dir_all(folder).map_err(|error| {
            Failure::Failed(format!("{} cannot be created: {error}", folder.display()))
        })?;
        for one in told {
            let name = format!("{}.script", one.name().replace(' ', "-"));
            let text = format!("# {} of {}\n{}", one.name(), args.script, one.script);
            output::write(&folder.join(name), text.as_bytes())?;
        }
    }
    let mut text = String::new();
    for one in told {
        text.push_str(&format!("{}: {}\n", one.name(), one.text));
        if one.seeds.len() > 1 {
            let others = &one.seeds[1..];
            let shown: Vec<String> = others.iter().take(SHOWN).map(u64::to_string).collect();
            let more = match others.len() - shown.len() {
                0 => String::new(),
                more => format!(" and {more} more"),
            };
            text.push_str(&format!(
                "  the same line fails with {}: {}{more}\n",
                report::plural(others.len(), "other seed"),
                shown.join(", ")
            ));
        }
        text.push_str("  script:\n");
        for line in one.script.lines() {
            let _ = writeln!(text, "    {line}");
        }
    }
    if !text.is_empty() {
        output::print(&text)?;
    }
    note!("{passed} of {count} seeds passed in {seconds:.1} s");
    match told.iter().map(|one| code_of(&one.reason)).max() {
        None => Ok(()),
        Some(code) => Err(Failure::Reported(code)),
    }
}

/// The report as JUnit XML: a case for each seed that failed, and one for all others.
fn junit(script: &str, told: &[FailureText], passed: u64, seconds: f64) -> String {
    let case = |name: String, outcome: Outcome| Case {
        name,
        micros: None,
        outcome,
        output: Vec::new(),
    };
    let mut cases = vec![case(format!("{passed} seeds that pass"), Outcome::Passed)];
    for one in told {
        for (place, seed) in one.seeds.iter().enumerate() {
            let text = match place {
                0 => format!("{}\nscript:\n{}", one.text, one.script),
                _ => format!("as {}: odkit run {script} --seed {seed}", one.name()),
            };
            let message = one.text.lines().next().unwrap_or_default().to_owned();
            cases.push(case(
                format!("seed {seed}"),
                Outcome::Failed { message, text },
            ));
        }
    }
    let suite = Suite {
        name: script.to_owned(),
        micros: (seconds * 1e6) as u64,
        cases,
    };
    let run = Run {
        name: String::from("odkit campaign"),
        properties: Vec::new(),
        suites: vec![suite],
    };
    run.render()
}
