//! Corrupted device files: no panic, no hang, no wrong value without a finding.
//!
//! Made from the project's cases and devices, and from the corpus (`tests/corpus`, or the folder that
//! `ODKIT_CORPUS` names). `ODKIT_ROUNDS` sets the number of variants; 60 without it, 10,000 in
//! `cargo xtask test --long`.

use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};
use std::{env, fs};

use od_eds::Document;
use od_fuzz::mutate;
use od_fuzz::random::Random;
use od_fuzz::target::Target;
use od_fuzz::targets::eds;
use od_tests::corpus;

/// Time limit for a file. In a build without optimisation, a device file of half a megabyte takes
/// a tenth of it.
const PATIENCE: Duration = Duration::from_secs(20);

#[test]
fn corrupted_files_of_the_corpus_are_read_to_the_end() {
    let seeds: Vec<Vec<u8>> = files().into_iter().map(|(_, bytes)| bytes).collect();
    let target = Target {
        longest: usize::MAX,
        ..eds::TARGET
    };
    for round in 0..rounds(60) {
        let input = mutate::input(&target, &seeds, &mut Random::new(round as u64));
        println!("round {round}");
        let start = Instant::now();
        eds::read_again(&Document::new(input));
        let taken = start.elapsed();
        assert!(taken < PATIENCE, "{taken:?}");
    }
}

#[test]
fn an_invalid_value_in_the_corpus_is_always_reported() {
    let files: Vec<_> = files()
        .into_iter()
        .map(|(name, bytes)| (name, Document::new(bytes).text().to_string()))
        .filter(|(_, text)| !od_eds::is_xml(text))
        .collect();
    let mut random = Random::new(1);
    let (mut made, mut tried) = (0, 0);
    let rounds = rounds(60);
    while made < rounds {
        tried += 1;
        assert!(tried < rounds * 100, "hardly a value to change was found");
        let (name, text) = &files[random.below(files.len())];
        let lines: Vec<&str> = text.lines().collect();
        let at = random.below(lines.len().max(1));
        let Some(illegal) = lines.get(at).and_then(|_| illegal(&lines, at, &mut random)) else {
            continue;
        };
        made += 1;
        let mut changed = lines.clone();
        changed[at] = &illegal;
        let loaded = od_eds::load(&changed.join("\n"));
        let line = at as u32 + 1;
        let named = loaded.findings.iter().any(|finding| {
            finding.span().is_some_and(|span| span.line == line)
                || finding.related.iter().any(|other| other.span.line == line)
        });
        assert!(named, "{name}:{line}: `{}` became `{illegal}`", lines[at]);
    }
}

/// The line with a value that is not valid for its key; `None` if it has no such key, or
/// if no finding is reported because nothing reads the value.
fn illegal(lines: &[&str], at: usize, random: &mut Random) -> Option<String> {
    let (key, value) = lines[at].split_once('=')?;
    let section = section(lines, at)?;
    let keys = || section.clone().filter_map(|n| lines[n].split_once('='));
    let is_object = {
        let header = lines[section.start - 1].trim();
        let name = header.strip_prefix('[')?.split(']').next()?;
        let digits = name.bytes().take_while(u8::is_ascii_hexdigit).count();
        digits == 4 && (name.len() == 4 || name[4..].to_ascii_lowercase().starts_with("sub"))
    };
    let data_type = || {
        let (_, code) = keys().find(|(key, _)| key.trim().eq_ignore_ascii_case("DataType"))?;
        let code = code.split([';', '#']).next()?.trim();
        let code = match code.strip_prefix("0x").or_else(|| code.strip_prefix("0X")) {
            Some(digits) => u16::from_str_radix(digits, 16).ok()?,
            None => code.parse().ok()?,
        };
        Some(code)
    };
    let pick = |random: &mut Random, from: &[&str]| from[random.below(from.len())].to_string();
    let key = key.trim();
    let lower = key.to_ascii_lowercase();
    let wrong = match lower.as_str() {
        _ if key.starts_with([';', '#']) => return None,
        "datatype" if is_object => pick(random, &["0x99", "0x0000", "0xZZ", "-1", "U_8"]),
        "accesstype" if is_object => pick(random, &["rx", "0", "row", "readable"]),
        "objecttype" if is_object => pick(random, &["0x3", "99", "VARIABLE", "-7"]),
        "pdomapping" if is_object => pick(random, &["2", "0x10", "maybe", "-1"]),
        "subnumber" if is_object => pick(random, &["x", "0x1G", "-1", "70000000000"]),
        "objflags" if is_object => pick(random, &["x", "0x1FFFFFFFF", "-1"]),
        "defaultvalue" | "parametervalue" | "lowlimit" | "highlimit" if is_object => {
            // Only if the type defines the valid values, and the section has no sub-objects.
            match data_type()? {
                0x05 => pick(
                    random,
                    &["256", "0x1FF", "-1", "zz", "1 2", "0x1G", "$NODEID-1"],
                ),
                0x06 => pick(random, &["65536", "0x1FFFF", "-1", "zz", "1.5"]),
                0x07 => pick(random, &["4294967296", "0x1FFFFFFFF", "-1", "zz", "0x"]),
                0x02 => pick(random, &["128", "-129", "zz", "0x1FF", "$NODEID"]),
                0x03 => pick(random, &["32768", "-32769", "zz", "1,5"]),
                0x04 => pick(random, &["2147483648", "-2147483649", "zz"]),
                0x01 => pick(random, &["2", "-1", "zz"]),
                0x08 | 0x11 => pick(random, &["zz", "1.2.3", "nan", "1e999"]),
                _ => return None,
            }
        }
        "supportedobjects" => pick(random, &["many", "-1", "9999"]),
        "nrofrxpdo" | "nroftxpdo" => pick(random, &["many", "-1", "600", "0x1000"]),
        "granularity" => pick(random, &["eight", "-1", "65"]),
        "vendornumber" | "productnumber" | "revisionnumber" => {
            pick(random, &["zz", "-1", "0x1FFFFFFFF"])
        }
        "nodeid" => pick(random, &["zz", "-1", "256"]),
        "lss_supported" | "simplebootupmaster" | "simplebootupslave" | "groupmessaging" => {
            pick(random, &["2", "yes", "-1"])
        }
        _ if lower.starts_with("baudrate_") || lower.starts_with("dummy0") => {
            pick(random, &["2", "on", "-1"])
        }
        _ => return None,
    };
    // Sub-objects of an object with another object code may be ignored.
    let own = lines[section.start - 1].trim();
    let is_whole = is_object && !own.to_ascii_lowercase().contains("sub");
    let has_members = keys().any(|(key, value)| {
        let key = key.trim();
        (key.eq_ignore_ascii_case("SubNumber") || key.eq_ignore_ascii_case("CompactSubObj"))
            && !matches!(value.trim(), "" | "0")
    }) || keys().any(|(key, value)| {
        // An ARRAY or a RECORD has no value itself, with or without sub-objects.
        let code = value.split([';', '#']).next().unwrap_or("").trim();
        key.trim().eq_ignore_ascii_case("ObjectType")
            && ["6", "8", "9"]
                .iter()
                .any(|known| code.trim_start_matches("0x0").trim_start_matches("0x") == *known)
    });
    let of_a_value = !matches!(lower.as_str(), "objecttype" | "subnumber" | "objflags");
    if is_whole && has_members && of_a_value && is_object {
        return None;
    }
    (value.trim() != wrong).then(|| format!("{key}={wrong}"))
}

/// The lines of the section that a line is in, without its header.
fn section(lines: &[&str], at: usize) -> Option<std::ops::Range<usize>> {
    let is_header = |line: &&str| line.trim_start().starts_with('[');
    let start = lines[..at].iter().rposition(is_header)? + 1;
    let end = lines[at..].iter().position(is_header);
    Some(start..end.map_or(lines.len(), |end| at + end))
}

fn rounds(few: usize) -> usize {
    let asked = env::var("ODKIT_ROUNDS").ok().and_then(|n| n.parse().ok());
    let long = env::var_os("ODKIT_LONG").map(|_| 10_000);
    asked.or(long).unwrap_or(few)
}

/// Cases, devices and the corpus, by name.
fn files() -> Vec<(String, Vec<u8>)> {
    let here = Path::new(env!("CARGO_MANIFEST_DIR"));
    let folders = [
        here.join("cases"),
        here.join("../devices/eds"),
        corpus::folder(),
    ];
    let paths = folders
        .iter()
        .flat_map(|folder| corpus::files(folder, corpus::ALL));
    let read = |path: PathBuf| Some((path.display().to_string(), fs::read(path).ok()?));
    let mut files: Vec<_> = paths.filter_map(read).collect();
    files.sort();
    assert!(!files.is_empty());
    files
}
