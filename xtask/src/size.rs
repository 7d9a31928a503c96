//! `cargo xtask size`: what a node costs on a microcontroller, measured on an emulated Cortex-M3.

use std::fmt::Write as _;
use std::fs;
use std::path::Path;

use crate::console::{Console, cargo, clean, say, which};
use crate::error::{Error, Result};
use crate::repo::Repo;
use crate::setup::{apt, target};

/// The programs in `firmware/src/bin`, and what each is.
const PROGRAMS: [(&str, &str); 3] = [
    (
        "minimal",
        "NMT, boot-up, heartbeat, expedited SDO, EMCY, two TPDOs, 16 objects",
    ),
    ("ds301", "every service of CiA 301 but LSS, 170 values"),
    ("gxmm", "an encoder of the bus-cover family, complete"),
];
/// The lines of README.md around the table.
const MARKS: (&str, &str) = ("<!-- size -->\n", "<!-- /size -->");
const HEAD: &str = "| | flash, `s` | flash, `z` | static RAM | stack | power-on | SDO upload | SYNC → TPDO | frame for another | idle timeout |
|---|--:|--:|--:|--:|--:|--:|--:|--:|--:|
";
/// The optimisation at which a program with a path to a panic does not link.
const LINKED: &str = "s";
const EMULATOR: &str = "qemu-system-arm";

/// What a program reports: bytes, and instructions from an input until its last frame is out.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
struct Cost {
    flash: u64,
    /// Flash with the optimisation `z`.
    flash_z: u64,
    ram: u64,
    stack: u64,
    instructions: [u64; 5],
}

/// What is measured in instructions.
const COUNTS: [&str; 5] = ["power_on", "upload", "sync", "foreign", "idle"];

/// Measures, and prints a table or JSON; `--accept` renews the table in README.md.
pub(crate) fn run(repo: &Repo, args: &[String]) -> Result<()> {
    let args: Vec<&str> = args.iter().flat_map(|arg| arg.split('=')).collect();
    let console = Console::terminal();
    match args[..] {
        [] => say(table(&measure(repo, &console)?).trim_end()),
        ["--format", "table"] => say(table(&measure(repo, &console)?).trim_end()),
        ["--format", "json"] => say(&json(&measure(repo, &console)?)),
        ["--accept"] => {
            let table = table(&measure(repo, &console)?);
            let (path, text) = readme(repo)?;
            let (before, _, after) = split(&text)?;
            fs::write(&path, [before, &table, after].concat())
                .map_err(|e| Error::io("write", &path, &e))?;
        }
        _ => {
            let text = "size accepts `--format table`, `--format json` and `--accept`";
            return Err(Error::Usage(String::from(text)));
        }
    }
    Ok(())
}

/// Fails where something has grown by more than 2 % since the table in README.md was made.
pub(crate) fn check(repo: &Repo, console: &Console) -> Result<()> {
    let (_, text) = readme(repo)?;
    let (_, listed, _) = split(&text)?;
    let costs = measure(repo, console)?;
    let grown = grown(listed, &table(&costs));
    if grown.is_empty() {
        return Ok(());
    }
    let list = grown.join("\n");
    Err(Error::Failed(format!(
        "larger than the table in README.md says; `cargo xtask size --accept` renews it:\n{list}"
    )))
}

/// The rows of which a number is more than 2 % above the listed one, or that are not listed.
fn grown(listed: &str, now: &str) -> Vec<String> {
    let numbers = |row: &str| -> Vec<u64> {
        let cells = row
            .split('|')
            .skip(2)
            .map(|cell| cell.trim().replace(',', ""));
        cells.filter_map(|cell| cell.parse().ok()).collect()
    };
    let name = |row: &str| row.split('`').nth(1).map(String::from);
    let is_grown = |row: &&str| {
        let mut lines = listed.lines();
        let known = lines.find(|line| name(line) == name(row));
        let (now, before) = (numbers(row), numbers(known.unwrap_or_default()));
        let pairs = now.iter().zip(&before);
        now.len() != before.len()
            || pairs
                .into_iter()
                .any(|(now, before)| now * 50 > before * 51)
    };
    let rows = now.lines().filter(|row| row.starts_with("| `"));
    rows.filter(is_grown).map(String::from).collect()
}

fn readme(repo: &Repo) -> Result<(std::path::PathBuf, String)> {
    let path = repo.root.join("README.md");
    let text = fs::read_to_string(&path).map_err(|e| Error::io("read", &path, &e))?;
    Ok((path, text))
}

/// Text before the table, the table, and text after it.
fn split(text: &str) -> Result<(&str, &str, &str)> {
    let missing = || Error::Failed(format!("README.md lacks {}", MARKS.0.trim_end()));
    let start = text.find(MARKS.0).ok_or_else(missing)? + MARKS.0.len();
    let end = text[start..].find(MARKS.1).ok_or_else(missing)? + start;
    Ok((&text[..start], &text[start..end], &text[end..]))
}

fn table(costs: &[Cost]) -> String {
    let mut text = String::from(HEAD);
    for ((name, about), cost) in PROGRAMS.iter().zip(costs) {
        let _ = write!(text, "| `{name}`: {about} |");
        let bytes = [cost.flash, cost.flash_z, cost.ram, cost.stack];
        for number in bytes.iter().chain(&cost.instructions) {
            let _ = write!(text, " {} |", grouped(*number));
        }
        text.push('\n');
    }
    text
}

/// A number with a comma before each three digits.
fn grouped(number: u64) -> String {
    match number {
        0..1000 => number.to_string(),
        _ => format!("{},{:03}", grouped(number / 1000), number % 1000),
    }
}

fn json(costs: &[Cost]) -> String {
    let programs = PROGRAMS.iter().zip(costs).map(|((name, _), cost)| {
        let Cost {
            flash,
            flash_z,
            ram,
            stack,
            instructions,
        } = cost;
        let counts = COUNTS.iter().zip(instructions);
        let counts: String = counts
            .map(|(what, count)| format!(", \"{what}\": {count}"))
            .collect();
        format!(
            "\"{name}\": {{\"flash\": {flash}, \"ram\": {ram}, \"stack\": {stack}, \
             \"flash_z\": {flash_z}{counts}}}"
        )
    });
    format!("{{{}}}", programs.collect::<Vec<_>>().join(", "))
}

/// Installs the target and the emulator, if they are missing.
pub(crate) fn prepare(repo: &Repo, console: &Console) -> Result<()> {
    target::add(repo, console, target::BARE)?;
    let why = "the emulator of the Cortex-M3 is missing";
    match which(EMULATOR) {
        Some(_) => Ok(()),
        None => apt::install(console, &[EMULATOR], why),
    }
}

/// Builds and runs every program.
fn measure(repo: &Repo, console: &Console) -> Result<Vec<Cost>> {
    prepare(repo, console)?;
    let built = |level: &str| -> Result<Vec<Cost>> {
        let folder = repo.root.join("firmware");
        let mut build = cargo(&folder, &["build", "--quiet", "--release", "--bins"]);
        build
            .args(["--target", target::BARE, "--target-dir"])
            .arg(&repo.target);
        build
            .arg("--config")
            .arg(format!("profile.release.opt-level=\"{level}\""));
        if level != LINKED {
            // What the linker sees of panics depends on the level; the programs are made for one.
            build.args(["--features", "may-panic"]);
        }
        let output = build
            .output()
            .map_err(|e| Error::Missing(format!("cargo: {e}")))?;
        if !output.status.success() {
            let text = String::from_utf8_lossy(&output.stderr).into_owned();
            return Err(Error::Failed(format!(
                "the firmware does not compile:\n{text}"
            )));
        }
        let binaries = repo.target.join(target::BARE).join("release");
        boot(&binaries.join("boot_loader"))?;
        let programs = PROGRAMS.iter();
        programs
            .map(|(name, _)| play(&binaries.join(name)))
            .collect()
    };
    let (small, smaller) = (built(LINKED)?, built("z")?);
    let both = small.into_iter().zip(smaller);
    Ok(both
        .map(|(s, z)| Cost {
            flash_z: z.flash,
            ..s
        })
        .collect())
}

/// Has the boot loader receive a program and start it.
fn boot(program: &Path) -> Result<()> {
    let text = emulate(program)?;
    match text.lines().any(|line| line == "the program runs") {
        true => Ok(()),
        false => Err(failed(program, &text)),
    }
}

fn failed(program: &Path, text: &str) -> Error {
    Error::Failed(format!("{} has failed:\n{text}", program.display()))
}

fn play(program: &Path) -> Result<Cost> {
    let text = emulate(program)?;
    read(&text).ok_or_else(|| failed(program, &text))
}

/// Runs a program on the emulator, with a clock that counts its instructions. Returns what it
/// prints.
fn emulate(program: &Path) -> Result<String> {
    let folder = program.parent().unwrap_or(Path::new("."));
    let mut command = clean(
        Path::new(EMULATOR),
        folder,
        &["-M", "lm3s6965evb", "-nographic"],
    );
    command.args([
        "-monitor",
        "none",
        "-serial",
        "none",
        "-icount",
        "shift=10,sleep=off",
    ]);
    command
        .args(["-semihosting-config", "enable=on,target=native", "-kernel"])
        .arg(program);
    let output = command.stdin(std::process::Stdio::null()).output();
    let output = output.map_err(|e| Error::Missing(format!("{EMULATOR}: {e}")))?;
    let text = String::from_utf8_lossy(&output.stderr).into_owned();
    match output.status.success() {
        true => Ok(text),
        false => Err(failed(program, &text)),
    }
}

/// The lines of a report: a name, and a number in hex.
fn read(text: &str) -> Option<Cost> {
    let number = |wanted: &str| {
        let mut pairs = text.lines().filter_map(|line| line.split_once(' '));
        let (_, number) = pairs.find(|(name, _)| *name == wanted)?;
        u64::from_str_radix(number, 16).ok()
    };
    // 12.8 ticks of the clock are an instruction.
    let overhead = number("overhead")?;
    let count = |name| Some(((number(name)?.saturating_sub(overhead)) * 10 + 64) / 128);
    let mut instructions = [0; COUNTS.len()];
    for (to, name) in instructions.iter_mut().zip(COUNTS) {
        *to = count(name)?;
    }
    let (flash, ram, stack) = (number("flash")?, number("ram")?, number("stack")?);
    Some(Cost {
        flash,
        flash_z: flash,
        ram,
        stack,
        instructions,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_growth_past_two_percent_is_told() {
        let instructions = [60_000, 300, 500, 200, 200];
        let cost = Cost {
            flash: 46_316,
            flash_z: 40_000,
            ram: 2_624,
            stack: 2_376,
            instructions,
        };
        let listed = table(&[cost]);
        let with = |flash| table(&[Cost { flash, ..cost }]);
        assert!(listed.contains("| 46,316 | 40,000 | 2,624 |"), "{listed}");
        assert!(grown(&listed, &with(46_316 / 50 * 51)).is_empty());
        assert_eq!(grown(&listed, &with(47_250)).len(), 1);
        assert_eq!(grown("", &listed).len(), 1);
    }

    #[test]
    fn a_report_is_read_in_instructions() {
        let text = "Timer\nflash 0000b9f8\nram 10\nstack 20\noverhead 1a\npower_on 2c480\n\
                    upload 1f8d\nsync 2d74\nforeign 190d\nidle 188d\n";
        let cost = read(text).unwrap();
        assert_eq!((cost.flash, cost.ram, cost.stack), (0xB9F8, 16, 32));
        assert_eq!(cost.instructions[1], 629);
        assert_eq!(read("flash 1\n"), None);
    }
}
