//! A firmware in C (`crates/od-capi/examples/c`) receives the calls that a device of the bench receives while
//! a script runs, and must respond equally: frames, their times, bit rates, all values, the EEPROM.
//!
//! It runs on this computer with sanitizers, and on an emulated Cortex-M3.
//!
//! ```text
//! cargo xtask test --only c                                     builds the programs and plays all
//! ODKIT_C=target/capi cargo test -p od-tests --test capi -- sdo plays some of the scripts
//! ```

mod log;
mod play;

use od_model::Refused;
use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::sync::{Arc, Mutex};
use std::time::Instant;

use od_runtime::NodeId;
use od_sim::script::{Bench, Host, Script, run_on};
use od_sim::{EdsOptions, VirtualDevice};
use od_tests::scripts;

use crate::log::{Log, Writer};
use crate::play::{Answers, Program};

/// The programs, and the file in the `device` line of their scripts.
const PROGRAMS: [(Program, &str); 3] = [
    (Program::Host("host"), "ds301.eds+all.overlay"),
    (Program::Emulated("ds301.elf"), "ds301.eds+all.overlay"),
    (Program::Emulated("strings.elf"), "strings.eds"),
];

/// Scripts for which a compiled device responds differently from a file, with the reason.
const LACKING: [(&str, &str); 1] = [(
    "cia301/domain-size.script",
    "a DOMAIN of a file has the size that the script gives it, a compiled one its own",
)];

/// The devices of a script.
struct Logged {
    folder: PathBuf,
    logs: Vec<Arc<Mutex<Log>>>,
}

impl Host for Logged {
    fn device(
        &mut self,
        name: Option<&str>,
        node_id: Option<NodeId>,
    ) -> Result<VirtualDevice, Refused> {
        let read = |file: &str| {
            let path = self.folder.join(file);
            let bytes = std::fs::read(&path).map_err(|e| format!("{}: {e}", path.display()))?;
            Ok::<_, String>(od_eds::decode(&bytes).into_owned())
        };
        let name = name.ok_or("the script has a `device` line")?;
        let text = match name.split_once('+') {
            Some((base, over)) => {
                let made = od_eds::overlay(&read(base)?, &read(over)?);
                made.map_err(|faults| format!("{faults:?}"))?.text
            }
            None => read(name)?,
        };
        let options = EdsOptions {
            node_id,
            ..EdsOptions::default()
        };
        let device = VirtualDevice::from_eds(&text, options);
        let device = device.map_err(|findings| format!("{name}: {findings:?}"))?;
        let log = Arc::default();
        self.logs.push(Arc::clone(&log));
        Ok(device.with_twin(Box::new(Writer(log))))
    }
}

/// Plays a script on the bench; returns a log of each device.
fn record(path: &Path, text: &str) -> Result<Vec<Log>, String> {
    let script = Script::parse(text).map_err(|problems| format!("{problems:?}"))?;
    let folder = path.parent().map(Path::to_path_buf).unwrap_or_default();
    let logs = Vec::new();
    let mut host = Logged { folder, logs };
    let mut bench = Bench::default();
    run_on(&script, &mut bench, &mut host).map_err(|stop| stop.to_string())?;
    for (at, log) in host.logs.iter().enumerate() {
        let mut log = log.lock().expect("nobody panicked");
        bench.bus.with(at, |device, now| log.end(device, now));
    }
    drop(bench);
    Ok(host
        .logs
        .iter()
        .map(|log| std::mem::take(&mut *log.lock().expect("nobody panicked")))
        .collect())
}

/// Plays all scripts of a program whose names contain one of the words; returns their number and
/// the differences.
fn play(
    program: Program,
    eds: &str,
    folder: &Path,
    words: &[String],
) -> Result<(usize, Vec<String>), String> {
    let mut files = scripts::all();
    let own = Path::new(env!("CARGO_MANIFEST_DIR")).join("capi");
    files.extend(scripts::all_in(&own));
    let mut logs: Vec<(String, Log)> = Vec::new();
    for file in files {
        let text = std::fs::read_to_string(&file.path).map_err(|e| e.to_string())?;
        let is_named = words.is_empty() || words.iter().any(|word| file.name.contains(word));
        let device = text.lines().find_map(|line| line.strip_prefix("device "));
        let device = device.and_then(|line| line.split(' ').next());
        if is_named && device.is_some_and(|name| name.ends_with(&format!("/{eds}"))) {
            let recorded = record(&file.path, &text);
            let recorded = recorded.map_err(|why| format!("{}: {why}", file.name))?;
            logs.extend(recorded.into_iter().map(|log| (file.name.clone(), log)));
        }
    }
    let told: Vec<u8> = logs.iter().flat_map(|(_, log)| log.told()).collect();
    let answers = play::play(program, folder, &told)?;
    let mut answers = Answers::read(&answers);
    let mut faults = Vec::new();
    for (name, log) in &logs {
        let fault = answers.next(log)?;
        let reason = LACKING.iter().find(|(script, _)| script == name);
        match (fault, reason) {
            (Some(fault), None) => faults.push(format!("{program:?} {name}: {fault}")),
            (None, Some(_)) => faults.push(format!("{program:?} {name}: take it out of LACKING")),
            _ => {}
        }
    }
    if !answers.is_empty() {
        faults.push(format!("{program:?}: more answers than scripts"));
    }
    Ok((logs.len(), faults))
}

fn main() -> ExitCode {
    let Some(folder) = std::env::var_os("ODKIT_C").map(PathBuf::from) else {
        println!("`cargo xtask test --only c` builds the programs and plays the scripts");
        return ExitCode::SUCCESS;
    };
    let arguments = std::env::args().skip(1);
    let words: Vec<String> = arguments.filter(|word| !word.starts_with('-')).collect();
    let start = Instant::now();
    let (mut played, mut faults) = (0, Vec::new());
    for (program, eds) in PROGRAMS {
        match play(program, eds, &folder, &words) {
            Ok((0, _)) if words.is_empty() => faults.push(format!("{program:?} has no script")),
            Ok((count, found)) => {
                println!("{program:?}: {count} scripts");
                played += count;
                faults.extend(found);
            }
            Err(why) => faults.push(format!("{program:?}: {why}")),
        }
    }
    for fault in &faults {
        println!("{fault}\n");
    }
    let verdict = if faults.is_empty() { "ok" } else { "FAILED" };
    println!(
        "test result: {verdict}. {} passed; {} failed; 0 ignored; 0 measured; 0 filtered out; \
         finished in {:.2}s",
        played.saturating_sub(faults.len()),
        faults.len(),
        start.elapsed().as_secs_f64()
    );
    if faults.is_empty() {
        ExitCode::SUCCESS
    } else {
        ExitCode::FAILURE
    }
}
