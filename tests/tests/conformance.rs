//! Runs every script under `tests/conformance`; all its expectations must hold.
//!
//! A new case is a new file. `odkit run --echo tests/conformance/…/x.script` shows its frames.
//! A script with a line `# Devices: a b` and no `device` line is run on each of them.

use od_model::Refused;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::time::Instant;

use od_runtime::{Frame, NodeId};
use od_sim::logs::candump::format_line;
use od_sim::script::{Bare, Host, Origin, Script, run};
use od_sim::{EdsOptions, VirtualDevice};
use od_tests::scripts::{self, Header};

/// The built-in devices, and EDS files beside the script.
struct Bench<'a> {
    folder: PathBuf,
    /// The device of a script without a `device` line.
    device: Option<&'a str>,
    trace: String,
}

impl Host for Bench<'_> {
    fn device(
        &mut self,
        name: Option<&str>,
        node_id: Option<NodeId>,
    ) -> Result<VirtualDevice, Refused> {
        let Some(file) = name.filter(|name| name.contains('.')) else {
            return Bare(od_devices::DEVICES).device(name.or(self.device), node_id);
        };
        let path = self.folder.join(file);
        let bytes = fs::read(&path).map_err(|error| format!("{}: {error}", path.display()))?;
        let options = EdsOptions {
            node_id,
            ..EdsOptions::default()
        };
        VirtualDevice::from_eds(&od_eds::decode(&bytes), options)
            .map_err(|found| format!("{}: {:?}", path.display(), found.first()).into())
    }

    fn frame(&mut self, at: od_runtime::Instant, origin: Origin, frame: &Frame) {
        let mark = if origin == Origin::Script { "<" } else { ">" };
        self.trace
            .push_str(&format!("{mark} {}\n", format_line(at, "can0", frame)));
    }
}

/// Runs a script on each of its devices; returns its trace, or its errors.
fn check(path: &Path, text: &str) -> Result<String, String> {
    let script = Script::parse(text).map_err(|problems| {
        problems
            .iter()
            .map(ToString::to_string)
            .collect::<Vec<_>>()
            .join("\n")
    })?;
    if script.expectations() == 0 {
        return Err("the script expects nothing".into());
    }
    let header = Header::parse(text)?;
    let names_device = text.lines().any(|line| line.starts_with("device "));
    match (names_device, header.devices.is_empty()) {
        (true, true) => play(path, &script, None),
        (false, false) => {
            let mut traces = String::new();
            for device in &header.devices {
                traces += &play(path, &script, Some(device))
                    .map_err(|what| format!("on {device}: {what}"))?;
            }
            Ok(traces)
        }
        _ => Err("the script needs a `device` line or a `# Devices:` line, not both".into()),
    }
}

fn play(path: &Path, script: &Script, device: Option<&str>) -> Result<String, String> {
    let mut bench = Bench {
        folder: path.parent().map(Path::to_path_buf).unwrap_or_default(),
        device,
        trace: String::new(),
    };
    match run(script, &mut bench) {
        Ok(_) => Ok(bench.trace),
        Err(stop) => {
            let tail: Vec<_> = bench.trace.lines().rev().take(6).collect();
            let tail: Vec<_> = tail
                .into_iter()
                .rev()
                .map(|line| format!("  {line}"))
                .collect();
            Err(format!("{stop}\n{}", tail.join("\n")))
        }
    }
}

/// Runs the scripts whose path contains one of the words on the command line, each twice.
fn main() -> ExitCode {
    let words: Vec<String> = std::env::args()
        .skip(1)
        .filter(|arg| !arg.starts_with('-'))
        .collect();
    let files = scripts::all();
    let all = files.len();
    assert!(all >= 250, "{all} scripts are left of more than 500");
    let start = Instant::now();
    let (mut passed, mut failed) = (0, 0);
    for scripts::File { name, path } in &files {
        if !words.is_empty() && !words.iter().any(|word| name.contains(word)) {
            continue;
        }
        let text = fs::read_to_string(path).expect("a script is UTF-8");
        let result = check(path, &text);
        let again = check(path, &text);
        match result {
            Ok(trace) if again.as_ref() == Ok(&trace) => passed += 1,
            Ok(_) => {
                failed += 1;
                println!("tests/conformance/{name}: two runs differ\n");
            }
            Err(what) => {
                failed += 1;
                println!("tests/conformance/{name}: {what}\n");
            }
        }
    }
    let verdict = if failed == 0 { "ok" } else { "FAILED" };
    println!(
        "test result: {verdict}. {passed} passed; {failed} failed; 0 ignored; 0 measured; \
         {} filtered out; finished in {:.2}s",
        all - passed - failed,
        start.elapsed().as_secs_f64()
    );
    if failed == 0 {
        ExitCode::SUCCESS
    } else {
        ExitCode::FAILURE
    }
}
