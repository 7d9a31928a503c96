//! Plays every conformance script of three devices against their firmware on an emulated
//! Cortex-M3 (`firmware/twin`). Every response must equal that of the bench, byte for byte: frames, their
//! times, states, deadlines, events; at the end of a script also all values and the EEPROM.
//!
//! With `--long` it also plays the whole of `odkit conform`. Inputs that the fuzz target `node` makes are the same in every run. docs/PERFORMANCE.md has the
//! maximum number of instructions for a frame.
//!
//! The bench plays the scripts first, and logs calls and answers of each device. The firmware then
//! receives the same calls. `lacking.txt` lists the scripts whose responses cannot be equal.
//!
//! ```text
//! cargo xtask test --only firmware                        builds the firmware and plays all
//! ODKIT_FIRMWARE=target/thumbv7m-none-eabi/release cargo test -p od-tests --test firmware -- sdo
//! ```

mod emulator;
mod log;
mod record;
mod table;

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::thread;
use std::time::Instant;

use od_tests::scripts;

use crate::log::{Answer, Log, shown};
use crate::table::Worst;

/// The devices with a program, which is named `twin_` and the device.
const DEVICES: [&str; 3] = ["gxmm", "eam_mt", "en580c"];

/// Inputs of the fuzz target `node` for each device, and with `--long`.
const MADE: u64 = 200;
const LONG: u64 = 2000;

/// Result of a script on a device.
struct Played {
    script: String,
    /// The first difference.
    fault: Option<String>,
}

/// Plays all scripts of a device whose names contain one of the words.
fn play(name: &str, programs: &Path, words: &[String]) -> Result<(Vec<Played>, Worst), String> {
    let mut logs = Vec::new();
    for file in scripts::all() {
        let text = std::fs::read_to_string(&file.path).map_err(|e| e.to_string())?;
        let is_meant = words.is_empty() || words.iter().any(|word| file.name.contains(word));
        if is_meant && record::is_of(&text, name) {
            let recorded = record::record(&file.path, &text, name);
            let recorded = recorded.map_err(|why| format!("{}: {why}", file.name))?;
            logs.extend(recorded.into_iter().map(|log| (file.name.clone(), log)));
        }
    }
    let is_long_run = std::env::var_os("ODKIT_LONG").is_some();
    if is_long_run && (words.is_empty() || words.iter().any(|word| CONFORM.contains(word.as_str())))
    {
        logs.push((CONFORM.into(), record::conform(name)?));
    }
    let made = if is_long_run { LONG } else { MADE };
    for number in 0..made {
        let script = format!("{MADE_INPUT}{number}");
        if words.is_empty() || words.iter().any(|word| script.contains(word)) {
            logs.push((script, record::made(number, name)));
        }
    }
    let program = format!("twin_{name}");
    let folder = programs.join(format!("{program}.files"));
    let all: Vec<&Log> = logs.iter().map(|(_, log)| log).collect();
    let answers = emulator::play(&programs.join(program), &folder, &all)?;
    let mut worst = Worst::default();
    let mut played: Vec<Played> = Vec::new();
    for ((script, log), answers) in logs.iter().zip(&answers) {
        if !is_long(script) {
            worst.look(script, log, answers);
        }
        let pairs = log.answers.iter().zip(answers);
        let differs = pairs
            .enumerate()
            .find(|(_, (own, (its, _)))| !log.agrees(own, its));
        let fault = differs.map(|(call, (own, (its, _)))| {
            let call = log.describe(call);
            format!(
                "  {call}\n  bench    {}\n  firmware {}",
                words_of(own),
                words_of(its)
            )
        });
        match played.last_mut().filter(|last| last.script == *script) {
            Some(last) => last.fault = last.fault.take().or(fault),
            None => played.push(Played {
                script: script.clone(),
                fault,
            }),
        }
    }
    Ok((played, worst))
}

/// The conformance test; only `--long` plays it.
const CONFORM: &str = "odkit conform";
const MADE_INPUT: &str = "made input ";

/// Returns whether only `--long` plays this input; it does not count for the table in docs/PERFORMANCE.md.
fn is_long(script: &str) -> bool {
    let number = script.strip_prefix(MADE_INPUT).map(str::parse);
    script == CONFORM || matches!(number, Some(Ok(MADE..)))
}

/// A response, to display.
fn words_of(answer: &Answer) -> String {
    let head = &answer.head;
    let hex = |bytes: &[u8]| bytes.iter().map(|b| format!("{b:02X}")).collect::<String>();
    let due = head[6..].try_into().map_or(0, u64::from_le_bytes);
    let frames: Vec<String> = answer.frames.iter().map(shown).collect();
    format!(
        "state {:02X} node {} events {} due {due} frames [{}] {}",
        head[0],
        head[1],
        hex(&head[2..6]),
        frames.join(" "),
        hex(&answer.rest)
    )
}

/// The scripts that are listed, by device and script, with the reason.
fn listed() -> BTreeMap<(String, String), String> {
    let lines = include_str!("lacking.txt").lines();
    let entry = |line: &str| {
        let (device, rest) = line.split_once(' ')?;
        let (script, reason) = rest.split_once(": ")?;
        let key = (String::from(device), String::from(script));
        Some((key, String::from(reason)))
    };
    let lines = lines.filter(|line| !line.starts_with('#'));
    lines
        .map(|line| entry(line).expect("`device script: reason`"))
        .collect()
}

fn main() -> ExitCode {
    let Some(programs) = std::env::var_os("ODKIT_FIRMWARE").map(PathBuf::from) else {
        println!("`cargo xtask test --only firmware` builds the firmware and plays the scripts");
        return ExitCode::SUCCESS;
    };
    let arguments = std::env::args().skip(1);
    let words: Vec<String> = arguments.filter(|word| !word.starts_with('-')).collect();
    let start = Instant::now();
    let results = thread::scope(|scope| {
        let played = DEVICES.map(|name| scope.spawn(|| play(name, &programs, &words)));
        played.map(|thread| thread.join().expect("a thread does not panic"))
    });
    let mut listed = listed();
    let (mut passed, mut faults) = (0, Vec::new());
    let mut rows = Vec::new();
    for (device, result) in DEVICES.iter().zip(results) {
        let (played, worst) = match result {
            Ok(result) => result,
            Err(why) => {
                faults.push(format!("{device}: {why}"));
                continue;
            }
        };
        let made = played
            .iter()
            .filter(|one| one.script.starts_with(MADE_INPUT))
            .count();
        let scripts = played.len() - made;
        println!(
            "{device}: {scripts} scripts, {made} made inputs; {}",
            worst.summary()
        );
        for Played { script, fault } in played {
            let reason = listed.remove(&(String::from(*device), script.clone()));
            match (fault, reason) {
                (None, None) | (Some(_), Some(_)) => passed += 1,
                (Some(fault), None) => faults.push(format!("{device} {script}\n{fault}")),
                (None, Some(_)) => faults.push(format!(
                    "{device} {script} is the same; take it out of tests/firmware/lacking.txt"
                )),
            }
        }
        rows.push((*device, worst));
    }
    if words.is_empty() && faults.is_empty() {
        let unknown = listed.into_keys();
        faults.extend(unknown.map(|(device, script)| format!("{device} {script}: no such script")));
        faults.extend(table::check(&rows).err());
    }
    for fault in &faults {
        println!("{fault}\n");
    }
    let verdict = if faults.is_empty() { "ok" } else { "FAILED" };
    println!(
        "test result: {verdict}. {passed} passed; {} failed; 0 ignored; 0 measured; \
         0 filtered out; finished in {:.2}s",
        faults.len(),
        start.elapsed().as_secs_f64()
    );
    if faults.is_empty() {
        ExitCode::SUCCESS
    } else {
        ExitCode::FAILURE
    }
}
