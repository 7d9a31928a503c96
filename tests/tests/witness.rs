//! A safe fix changes nothing that a tool reads: every safe fix of our corpus, of the cases and of
//! mutants of them is applied, and other tools read the file before and after.
//!
//! The witnesses are readers of `od_eds::tools` (each is held against the tool itself in `tests/interop`), and rust-ini, with which a reader of lists and modules counts here as
//! CiA 306 says it. `tests/interop/test_fixes.py` asks python-canopen itself. `ODKIT_ROUNDS` sets the number of
//! mutants; 1,000 without it, 5,000 in `cargo xtask test --long` (half a minute of processor time).

use std::collections::BTreeSet;
use std::path::Path;
use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::{env, fs, thread};

use ini::{Ini, ParseOption};
use od_eds::Document;
use od_eds::fix::{Applicability, fix};
use od_eds::tools::{self, ReadEntry};
use od_eds::{Description, EntryDescription, Key};
use od_fuzz::mutate;
use od_fuzz::random::Random;
use od_fuzz::target::Target;
use od_fuzz::targets::ALL;
use od_model::Address;
use od_tests::corpus;

/// The tools whose readers are asked.
const WITNESSES: [&str; 2] = ["python-canopen", "dcf-tools"];

/// Findings about lines that are not plain INI.
const NOT_PLAIN: [&str; 8] = [
    "W0101", "W0102", "W0103", "E0118", "W0104", "W0105", "W0108", "W0110",
];

/// Number of files that safe fixes changed, and number of compared readings.
#[derive(Default)]
struct Sums {
    changed: AtomicUsize,
    readings: AtomicUsize,
}

#[test]
fn a_safe_fix_changes_no_value_that_other_programs_read() {
    let here = Path::new(env!("CARGO_MANIFEST_DIR"));
    let mut files = corpus::files(&corpus::folder(), corpus::TEXTS);
    for folder in ["../crates/od-eds/cases", "cases", "../devices/eds"] {
        files.extend(corpus::files(&here.join(folder), corpus::TEXTS));
    }
    let files: Vec<(String, Vec<u8>)> = files
        .iter()
        .map(|file| {
            (
                file.display().to_string(),
                fs::read(file).expect("a file of the project"),
            )
        })
        .collect();
    let seeds: Vec<Vec<u8>> = files.iter().map(|(_, bytes)| bytes.clone()).collect();
    let eds = ALL.iter().find(|target| target.name == "eds");
    let target = Target {
        longest: 60_000,
        ..*eds.expect("the target of device files")
    };
    let rounds = env::var("ODKIT_ROUNDS")
        .ok()
        .and_then(|rounds| rounds.parse().ok());
    let is_long = env::var_os("ODKIT_LONG").is_some();
    let rounds: usize = rounds.unwrap_or(if is_long { 5_000 } else { 1_000 });
    let (next, sums, wrong) = (AtomicUsize::new(0), Sums::default(), Mutex::new(Vec::new()));
    let work = || {
        loop {
            let at = next.fetch_add(1, Ordering::Relaxed);
            let (name, bytes) = match files.get(at) {
                Some((name, bytes)) => (name.clone(), bytes.clone()),
                None if at - files.len() < rounds => {
                    let number = (at - files.len()) as u64;
                    let mut random = Random::of(32, number);
                    // Every fifth file has changes of any kind, which few tools can read.
                    let bytes = match number % 5 {
                        0 => mutate::input(&target, &seeds, &mut random),
                        _ => slipped(&seeds, &mut random),
                    };
                    (format!("mutant {number}"), bytes)
                }
                None => return,
            };
            if let Err(why) = compare(&bytes, &sums) {
                wrong
                    .lock()
                    .expect("no thread panics here")
                    .push(format!("{name}: {why}"));
            }
        }
    };
    thread::scope(|scope| {
        for _ in 0..thread::available_parallelism().map_or(1, usize::from) {
            scope.spawn(work);
        }
    });
    let wrong = wrong.into_inner().expect("no thread panics here");
    assert!(
        wrong.is_empty(),
        "{} wrong\n{}",
        wrong.len(),
        wrong.join("\n")
    );
    let (changed, readings) = (sums.changed.into_inner(), sums.readings.into_inner());
    println!("{changed} files were changed, {readings} readings compared");
    assert!(
        changed * 8 > files.len() + rounds,
        "{changed} files were changed"
    );
    // Both tools reject most mutants, before the fix and after it.
    assert!(
        readings * 10 > changed,
        "{readings} of {changed} files were compared"
    );
}

/// A file with up to three errors in its lines, as people and programs make them; most tools can
/// still read it.
fn slipped(seeds: &[Vec<u8>], random: &mut Random) -> Vec<u8> {
    let text = String::from_utf8_lossy(&seeds[random.below(seeds.len())]).into_owned();
    let mut lines: Vec<String> = text.lines().map(str::to_owned).collect();
    for _ in 0..=random.below(3) {
        let at = random.below(lines.len());
        let Some(line) = lines.get(at).cloned() else {
            break;
        };
        let pair = line.split_once('=');
        match (random.below(12), pair) {
            (0, Some((key, value))) => lines[at] = format!("{}={value}", key.to_lowercase()),
            (1, Some((key, value))) => lines[at] = format!("{key} = {value} "),
            (2, Some((key, value))) => lines[at] = format!("{key}=0{value}"),
            (3, Some((key, _))) => lines[at] = format!("{key}="),
            (4, Some((key, value))) if value.parse::<u32>().is_ok() => {
                lines[at] = format!("{key}={}", random.below(40));
            }
            (5, Some((key, value))) => {
                let number = value.parse::<u32>();
                lines[at] = format!(
                    "{key}={}",
                    number.map_or(value.into(), |n| format!("0x{n:x}"))
                );
            }
            (6, Some(_)) => lines.insert(at, line),
            (7, Some(_)) => drop(lines.remove(at)),
            (8, Some(_)) => {
                let other = random.below(lines.len());
                lines.swap(at, other);
            }
            (9, Some(_)) => lines[at] = format!("{line} ; note"),
            (10, None) if line.starts_with('[') => lines[at] = line.replace("sub", "Sub0"),
            (_, None) if line.starts_with('[') => lines[at] = line.to_lowercase(),
            _ => lines[at] = line.to_uppercase(),
        }
    }
    lines.join("\n").into_bytes()
}

/// Compares all readings of a file before and after its safe fixes.
fn compare(bytes: &[u8], sums: &Sums) -> Result<(), String> {
    let before = Document::new(bytes);
    let fixed = fix(&before, Applicability::Safe, |document| {
        document.load().findings
    });
    if fixed.edits == 0 {
        return Ok(());
    }
    sums.changed.fetch_add(1, Ordering::Relaxed);
    let after = fixed.document;
    let description = after.parse().description;
    let (was, is) = (values(&before.parse().description), values(&description));
    if let Some((was, is)) = was.iter().zip(&is).find(|(was, is)| was != is) {
        return Err(format!("odkit read {was:?}, now {is:?}"));
    }
    if was.len() != is.len() {
        return Err(format!("odkit read {} values, now {}", was.len(), is.len()));
    }
    for tool in WITNESSES.iter().filter_map(|name| tools::tool(name)) {
        let (was, is) = (tools::reading(&before, tool), tools::reading(&after, tool));
        if was.is_rejected() {
            continue;
        }
        if is.is_rejected() {
            return Err(format!("{} rejects the fixed file", tool.name));
        }
        sums.readings.fetch_add(1, Ordering::Relaxed);
        let left = tools::check(&after, &description, &[tool]);
        let agrees = |(index, sub): (u32, u32), keys: &[Key]| {
            !left.iter().any(|finding| {
                let at = finding
                    .object
                    .map(|at| (u32::from(at.index), u32::from(at.sub)));
                at == Some((index, sub)) && finding.key.is_none_or(|key| keys.contains(&key))
            })
        };
        for (at, entry) in &was.entries {
            let now = is.entries.get(at);
            // A tool that read another value than odkit now reads the same value.
            if now != Some(entry) && !now.is_some_and(|now| agrees(*at, &changed(entry, now))) {
                let (index, sub) = at;
                return Err(format!(
                    "{}: {index:04X}h:{sub:02X} was {entry:?}, is {now:?}",
                    tool.name
                ));
            }
        }
    }
    // rust-ini makes keys over several lines from lines that are not plain INI.
    let findings = before.parse().findings;
    if findings
        .iter()
        .any(|finding| NOT_PLAIN.contains(&finding.code()))
    {
        return Ok(());
    }
    for (name, read) in [("lists", lists as Count), ("modules", modules)] {
        if let (Some(was), Some(is)) = (by_rust_ini(before.text()), by_rust_ini(after.text())) {
            let lost: Vec<String> = read(&was).difference(&read(&is)).cloned().collect();
            if !lost.is_empty() {
                return Err(format!("a reader that counts {name} loses {lost:?}"));
            }
        }
    }
    Ok(())
}

/// The keys that a tool reads differently now.
fn changed(was: &ReadEntry, is: &ReadEntry) -> Vec<Key> {
    let keys = [
        (Key::ParameterName, was.name != is.name),
        (Key::DataType, was.data_type != is.data_type),
        (Key::AccessType, was.access != is.access),
        (Key::PdoMapping, was.mappable != is.mappable),
        (Key::DefaultValue, was.default != is.default),
        (Key::ParameterValue, was.parameter != is.parameter),
        (Key::LowLimit, was.low != is.low),
        (Key::HighLimit, was.high != is.high),
    ];
    keys.into_iter()
        .filter(|(_, differs)| *differs)
        .map(|(key, _)| key)
        .collect()
}

/// The values of a description; of the texts that odkit could not read, only the keys.
fn values(description: &Description) -> Vec<(Address, EntryDescription)> {
    let entries = description.entries().map(|(address, entry)| {
        let mut entry = entry.clone();
        entry.extra.iter_mut().for_each(|(_, text)| text.clear());
        (address, entry)
    });
    entries.collect()
}

/// The items that a reader finds when it counts from 1 to the number that a section gives.
type Count = fn(&Ini) -> BTreeSet<String>;

fn by_rust_ini(text: &str) -> Option<Ini> {
    let options = ParseOption {
        enabled_quote: false,
        enabled_escape: false,
        ..ParseOption::default()
    };
    Ini::load_from_str_opt(text, options).ok()
}

/// A section and its keys; upper and lower case are equal.
fn get<'a>(ini: &'a Ini, section: &str, key: &str) -> Option<&'a str> {
    let is_it = |name: &Option<&str>| name.is_some_and(|name| name.eq_ignore_ascii_case(section));
    let (_, properties) = ini.iter().find(|(name, _)| is_it(name))?;
    let mut pairs = properties.iter();
    let pair = pairs.find(|(name, _)| name.eq_ignore_ascii_case(key));
    pair.map(|(_, value)| value.trim())
}

fn number(text: &str) -> Option<u32> {
    let hex = text.strip_prefix("0x").or_else(|| text.strip_prefix("0X"));
    hex.map_or_else(
        || text.parse().ok(),
        |digits| u32::from_str_radix(digits, 16).ok(),
    )
}

/// The objects that the lists name and that have a section.
fn lists(ini: &Ini) -> BTreeSet<String> {
    let mut found = BTreeSet::new();
    for list in ["MandatoryObjects", "OptionalObjects", "ManufacturerObjects"] {
        let count = get(ini, list, "SupportedObjects")
            .and_then(number)
            .unwrap_or(0);
        for entry in 1..=count.min(0x1_0000) {
            let index = get(ini, list, &entry.to_string()).and_then(number);
            let name = index.map(|index| format!("{index:04X}"));
            found.extend(name.filter(|name| get(ini, name, "ParameterName").is_some()));
        }
    }
    found
}

/// The modules within the count of `[SupportedModules]` that have a section, and their objects.
fn modules(ini: &Ini) -> BTreeSet<String> {
    let count = get(ini, "SupportedModules", "NrOfEntries")
        .and_then(number)
        .unwrap_or(0);
    let mut found = BTreeSet::new();
    for module in 1..=count.min(0x1_0000) {
        let info = format!("M{module}ModuleInfo");
        found.extend(get(ini, &info, "ProductName").map(|_| info.clone()));
        for list in ["FixedObjects", "SubExtends"] {
            let list = format!("M{module}{list}");
            let count = get(ini, &list, "NrOfEntries").and_then(number).unwrap_or(0);
            let entries =
                (1..=count.min(0x1_0000)).filter_map(|entry| get(ini, &list, &entry.to_string()));
            found.extend(entries.map(|entry| format!("{list} {entry}")));
        }
    }
    found
}
