//! Files that are larger than any device file: each command ends soon, and needs little memory.

use std::path::Path;
use std::process::Command;

use crate::support::file;

/// Address space for a command in kB: what it needs at most, and the program itself.
const MEMORY: u32 = 300_000 + 150_000;
/// Processor time in seconds. A build without optimisation needs ten times as long.
const TIME: u32 = if cfg!(debug_assertions) { 20 } else { 2 };

/// Runs `odkit` with these limits, which the system enforces: it ends the process that exceeds one.
#[track_caller]
fn limited(args: &[&str]) -> (i32, String) {
    let limits = format!("ulimit -v {MEMORY}; ulimit -t {TIME}; exec \"$0\" \"$@\"");
    let mut shell = Command::new("sh");
    let run = shell
        .args(["-c", &limits, env!("CARGO_BIN_EXE_odkit")])
        .args(args)
        .env("NO_COLOR", "1")
        .output();
    let run = run.expect("a shell");
    let text = [run.stdout, run.stderr].concat();
    let text = String::from_utf8_lossy(&text).into_owned();
    let code = run.status.code();
    let code = code.unwrap_or_else(|| panic!("{args:?} exceeds a limit: {}\n{text}", run.status));
    assert!(code < 100, "{args:?}: {code}\n{text}");
    assert!(text.len() < 50_000_000, "{args:?}: {} bytes", text.len());
    (code, text)
}

#[test]
fn a_file_that_is_too_large_has_a_finding_and_an_end() {
    let head = "[2000]\nParameterName=a\nDataType=7\nAccessType=rw\n";
    let lines = |count: usize, line: &dyn Fn(usize) -> String| -> String {
        (0..count).map(|n| line(n) + "\n").collect()
    };
    let noise: Vec<u8> = (0..300_000_u32)
        .map(|n| (n.wrapping_mul(2_654_435_761) >> 23) as u8)
        .collect();
    let attributes: String = (0..300_000).map(|n| format!(" a{n} = \"1\"")).collect();
    for (name, content, code) in [
        (
            "value.eds",
            format!("{head}DefaultValue={}\n", "z".repeat(50_000_000)).into_bytes(),
            "E0119",
        ),
        (
            "name.eds",
            format!("{head}[2001]\nParameterName={}\n", "n".repeat(20_000_000)).into_bytes(),
            "E0119",
        ),
        ("noise.eds", noise, "no section of an EDS"),
        (
            "sections.eds",
            lines(300_000, &|n| format!("[{:04X}sub{:X}]", 0x2000 + n / 250, n % 250)).into_bytes(),
            "E0119",
        ),
        (
            "compact.eds",
            lines(16_384, &|n| {
                let index = 0x2000 + n;
                format!("[{index:04X}]\nParameterName=a\nObjectType=8\nDataType=5\nAccessType=ro\nCompactSubObj=254")
            })
            .into_bytes(),
            "E0353",
        ),
        (
            "attributes.xdd",
            format!("<ISO15745ProfileContainer><a{attributes}/></ISO15745ProfileContainer>").into_bytes(),
            "E0119",
        ),
    ] {
        let path = file(&format!("limits-{name}"), "");
        std::fs::write(&path, content).expect("a folder for test files");
        let own = path.display().to_string();
        let (exit, text) = limited(&["check", &own]);
        assert_eq!(exit, 1, "{name}");
        assert!(text.contains(code), "{name}: {code} is missing");
        limited(&["convert", &own, "--to", "eds"]);
        limited(&["diff", &own, &own]);
        std::fs::remove_file(Path::new(&path)).expect("the file of this test");
    }
}

/// Projects and node lists with more keys, deeper lists and longer lines than any network has.
#[test]
fn a_project_that_is_too_large_has_an_end() {
    let lines = |count: usize, line: &dyn Fn(usize) -> String| -> String {
        (0..count).map(|n| line(n) + "\n").collect()
    };
    let repeated = lines(60, &|n| {
        let before = n.saturating_sub(1);
        match n {
            0 => "a0: &a0 [x, x]".into(),
            _ => format!("a{n}: &a{n} [*a{before}, *a{before}]"),
        }
    });
    for (name, content, exit) in [
        ("keys.yml", lines(49_000, &|n| format!("key{n}: {n}")), 1),
        ("values.yml", lines(60_000, &|n| format!("key{n}: {n}")), 1),
        ("deep.yml", "[".repeat(200_000), 1),
        ("dashes.yml", "- ".repeat(20_000) + "a", 1),
        ("line.yml", format!("a: {}", "z".repeat(2_000_000)), 1),
        ("aliases.yml", repeated, 1),
        (
            "list.cpj",
            String::from("[Topology]\n") + &lines(300_000, &|n| format!("Node{n}Name=a")),
            1,
        ),
        ("lists.cpj", "[Topology]\n".repeat(30_000), 0),
    ] {
        let path = file(&format!("limits-{name}"), &content);
        let (code, text) = limited(&["network", &path.display().to_string()]);
        assert_eq!(code, exit, "{name}: {text}");
        std::fs::remove_file(path).expect("the file of this test");
    }
}
