//! Runs the commands on a bus on a folder of device files: `cargo xtask corpus DIR --nodes`.
//!
//! Each file is simulated, learned and tested in virtual time. For each file a line says how many values were learned
//! as in the file, followed by the cases that fail.
//!
//! ```text
//! slaves DIR            learn, check, compare, play the twin; then the conformance test
//! slaves DIR --learn    without the conformance test
//! ```

mod folder;

use std::path::Path;
use std::process::ExitCode;
use std::{env, fs};

use od_eds::{Description, Document, Tables};
use od_model::{Address, Entry, Refused};
use od_sim::bus::Bus;
use od_sim::{EdsOptions, VirtualDevice};
use od_tools::bench::OnBench;
use od_tools::compare::compare;
use od_tools::conform::case::built_in;
use od_tools::conform::eds::Eds;
use od_tools::conform::record::Verdict;
use od_tools::conform::session::{Permissions, Session};
use od_tools::learn::{Options, learn};
use od_tools::master::Master;
use od_wire::NodeId;

fn main() -> ExitCode {
    let args: Vec<String> = env::args().skip(1).collect();
    let (folder, tests) = match args.iter().map(String::as_str).collect::<Vec<_>>()[..] {
        [folder] => (folder, true),
        [folder, "--learn"] => (folder, false),
        _ => {
            eprintln!("usage: slaves DIR [--learn]");
            return ExitCode::from(2);
        }
    };
    let files = match folder::files(Path::new(folder), &["eds", "dcf", "xdd", "xdc", "xpd"]) {
        Ok(files) => files,
        Err(error) => {
            eprintln!("{folder}: {error}");
            return ExitCode::FAILURE;
        }
    };
    let mut sums = Learned::default();
    let (mut simulated, mut right, mut passed) = (0, 0, 0);
    for path in files {
        let name = path.strip_prefix(folder).unwrap_or(&path).display();
        let Ok(bytes) = fs::read(&path) else { continue };
        let document = Document::new(bytes).named(name.to_string());
        let learned = match learned(document.text()) {
            Ok(learned) if learned.values > 0 => learned,
            Ok(_) => continue,
            Err(why) => {
                println!("{name}: not simulated: {why}");
                continue;
            }
        };
        println!("{name}: {}", learned.words());
        for wrong in &learned.wrong {
            println!("    {wrong}");
        }
        simulated += 1;
        right += usize::from(learned.wrong.len() * 100 <= learned.values);
        sums.add(learned);
        if tests {
            let failed = failed(document.text());
            passed += usize::from(failed.is_empty());
            failed.iter().for_each(|line| println!("    FAIL {line}"));
        }
    }
    println!(
        "{simulated} files, {right} with at most 1 % of the values learned otherwise: {}",
        sums.words()
    );
    if tests {
        println!("{passed} files without a failed case");
    }
    ExitCode::SUCCESS
}

/// Differences between a learned file and the file that was simulated.
#[derive(Default)]
struct Learned {
    values: usize,
    /// Values that are missing, or have another access or length, or another type without
    /// a mark.
    wrong: Vec<String>,
    /// Values with another type of the same length that are marked as a guess.
    marked: usize,
    /// Errors that `odkit check` finds in the learned file.
    errors: usize,
    /// Differences between the learned file and its own node, by `odkit diff --link`.
    differences: usize,
    /// Whether a device can be made of the learned file.
    stands_in: usize,
}

impl Learned {
    fn add(&mut self, other: Self) {
        self.values += other.values;
        self.wrong.extend(other.wrong);
        self.marked += other.marked;
        self.errors += other.errors;
        self.differences += other.differences;
        self.stands_in += other.stands_in;
    }

    fn words(&self) -> String {
        format!(
            "{} values, {} wrong, {} marked as a guess, {} errors, {} differences, {} as a twin",
            self.values,
            self.wrong.len(),
            self.marked,
            self.errors,
            self.differences,
            self.stands_in
        )
    }
}

fn device(text: &str) -> Result<VirtualDevice, Refused> {
    let options = EdsOptions {
        node_id: Some(NodeId::ONE),
        lenient: true,
    };
    let (device, findings) = VirtualDevice::read_eds(text, options);
    device.ok_or_else(|| format!("{} findings", findings.len()).into())
}

fn bus(text: &str) -> Result<Bus, String> {
    let mut bus = Bus::new();
    let number = bus.add(device(text)?);
    bus.start(number);
    Ok(bus)
}

fn learned(text: &str) -> Result<Learned, String> {
    let mut bus = bus(text)?;
    let made = learn(OnBench(&mut bus), NodeId::ONE, Options::default(), |_| {})
        .map_err(|fault| fault.to_string())?
        .description;
    let file = od_eds::write(&made);
    let loaded = od_eds::load(&file);
    let tables = Tables::new(&loaded.description);
    let original = Eds::read(text);
    let mut learned = Learned {
        errors: loaded.findings.iter().filter(|one| one.is_error()).count(),
        stands_in: usize::from(device(&file).is_ok()),
        ..Learned::default()
    };
    let (right, all) = (original.dictionary(), tables.dictionary());
    let objects = right.entries();
    for entry in objects.filter(|one| (0x1000..=0x9FFF).contains(&one.address.index)) {
        learned.values += 1;
        match all.find(entry.address) {
            Err(_) => learned.wrong.push(format!("{} missing", entry.address)),
            Ok(got) => match differs(&entry, &got) {
                None => {}
                Some(_) if is_marked(&made, &entry, &got) => learned.marked += 1,
                Some(what) => learned.wrong.push(what),
            },
        }
    }
    let more = all
        .entries()
        .filter(|one| right.find(one.address).is_err())
        .map(|one| format!("{} is not there", one.address));
    learned.wrong.extend(more);
    let mut master = Master::new(OnBench(&mut bus), NodeId::ONE);
    let differences = compare(all, &mut master, false).map_err(|fault| fault.to_string())?;
    learned.differences = differences.len();
    Ok(learned)
}

/// Type or access, if they differ.
fn differs(right: &Entry, got: &Entry) -> Option<String> {
    let access = |entry: &Entry| (entry.access.readable(), entry.access.writable());
    let is_same = access(right) == access(got) && right.data_type == got.data_type;
    (!is_same).then(|| {
        let (was, is) = (right.data_type.name(), got.data_type.name());
        format!(
            "{} {was} {}: {is} {}",
            right.address, right.access, got.access
        )
    })
}

/// Whether only the type differs, has the same length, and is marked as a guess.
fn is_marked(made: &Description, right: &Entry, got: &Entry) -> bool {
    let access = |entry: &Entry| (entry.access.readable(), entry.access.writable());
    let Address { index, sub } = got.address;
    let object = made.objects.get(&index);
    let entry = object.and_then(|object| object.entries.get(&sub));
    let mark = |(key, text): &(String, String)| key == ";Learned" && text.contains("type");
    access(right) == access(got)
        && right.data_type.size() == got.data_type.size()
        && entry.is_some_and(|entry| entry.extra.iter().any(mark))
}

/// The cases that fail, with the reasons.
fn failed(text: &str) -> Vec<String> {
    let Ok(bus) = bus(text) else {
        return Vec::new();
    };
    let eds = Eds::read(text);
    let mut rig = OnBench(bus);
    let mut session = Session::new(&mut rig, &eds, NodeId::ONE, Permissions::ALL);
    let records = built_in().iter().map(|case| session.run(case));
    let failed = records.filter_map(|record| match record.verdict {
        Verdict::Fail { expected, got } => {
            Some(format!("{}: expected {expected}; {got}", record.id))
        }
        _ => None,
    });
    failed.collect()
}
