//! The stage that makes and builds a firmware for each board.

use std::fs;
use std::io::{BufRead, BufReader, Write};
use std::path::{Path, PathBuf};
use std::process::{Child, ChildStdout, Command, Stdio};
use std::sync::mpsc;
use std::thread;
use std::time::Duration;

use super::rust::odkit;
use crate::console::{cargo, which};
use crate::error::{Error, Result};
use crate::packages::CLI;
use crate::repo::program;
use crate::setup::{apt, target};
use crate::test::context::Context;

/// Device that the boards are tried with.
const DEVICE: &str = "devices/eds/GXMM.eds";
/// Files of the corpus that are built for each board with `--long`: one that saves nothing and has values of every type,
/// one that saves, and one with more PDOs than usual.
const FILES: [&str; 3] = [
    "tests/corpus/types-all.eds",
    "tests/corpus/storage.eds",
    "tests/corpus/pdos-32.eds",
];
const EMULATOR: &str = "qemu-system-arm";
/// The board that an ordinary run builds. The crates of manufacturers that the others need take minutes, and what
/// odkit writes for these boards seldom changes.
const GENERIC: &str = "generic";
/// Boards and their targets.
const BOARDS: [(&str, &[&str]); 5] = [
    (GENERIC, &[target::BARE, target::SMALLEST]),
    ("rp2040+mcp2515", &[target::SMALLEST]),
    ("stm32g0", &[target::SMALLEST]),
    ("stm32f4", &[target::FLOAT]),
    ("esp32c3", &[target::RISC_V]),
];
/// First letters of the names of functions for doubles and atomics.
const HELP: [&str; 8] = [
    "__aeabi_dadd",
    "__aeabi_dsub",
    "__aeabi_dmul",
    "__aeabi_ddiv",
    "__aeabi_dcmp",
    "__aeabi_d2",
    "__atomic_",
    "__sync_",
];
/// Frames to the firmware of gxmm in the emulator, and the response to each, as slcan text.
const DIALOGUE: [(&str, &str); 4] = [
    ("", "t701100"),
    // An SDO upload of 1000h, and of an object that does not exist.
    ("t60184000100000000000\r", "t58184300100096010200"),
    ("t601840FF5F0000000000\r", "t581880FF5F0000000206"),
    // A heartbeat every 100 ms shows that time passes.
    ("t60182B17100064000000\r", "t58186017100000000000"),
];

/// Makes the workspace of `odkit new` for each board. The firmware of `generic` is built for a Cortex-M0, and for a
/// Cortex-M3 that runs in an emulator and responds; with `--long`, clippy checks each board, and each is built, also of
/// files of the corpus.
pub(super) fn boards(context: &Context<'_>) -> Result<()> {
    let (repo, console) = (context.repo, context.console);
    let odkit = odkit(context)?.join(program(CLI.1));
    let folder = repo.cache().join("boards");
    let _ = fs::remove_dir_all(&folder);
    fs::create_dir_all(&folder).map_err(|e| Error::io("create", &folder, &e))?;
    for (board, targets) in BOARDS {
        let workspace = make(context, &odkit, &folder, DEVICE, board)?;
        let mut fmt = cargo(&workspace, &["fmt", "--check"]);
        console.run("formatting", &mut fmt)?;
        if !context.long && board != GENERIC {
            continue;
        }
        for name in targets {
            target::add(repo, console, name)?;
            let firmware = workspace.join("firmware");
            if context.long {
                // Warnings that a firmware engineer would see.
                let mut check = cargo(&firmware, &["clippy", "--release", "--target"]);
                check.arg(name).arg("--target-dir").arg(&repo.target);
                check.args(["--", "-D", "warnings"]);
                console.run(&format!("{board} for {name}, checked"), &mut check)?;
            }
            build(context, &workspace, name, board)?;
            // Calls for doubles and atomics on a Cortex-M0 are visible only in the linked program.
            if *name == target::SMALLEST {
                let program = repo.target.join(name).join("release/encoder-firmware");
                needs_no_help(&program)?;
            }
        }
        if let (true, [target, ..]) = (context.long, targets) {
            for file in FILES {
                let workspace = make(context, &odkit, &folder.join("corpus"), file, board)?;
                build(context, &workspace, target, &format!("{board} with {file}"))?;
                fs::remove_dir_all(&workspace).map_err(|e| Error::io("remove", &workspace, &e))?;
            }
        }
    }
    let generic = folder.join(GENERIC).join("firmware");
    emulate(context, &generic)?;
    refuses_panics(context, &generic)
}

/// The firmware of `generic` with a function that can panic does not link, and the linker names the function.
fn refuses_panics(context: &Context<'_>, firmware: &Path) -> Result<()> {
    const FUNCTION: &str = "third_of_two";
    let main = firmware.join("src/main.rs");
    let text = fs::read_to_string(&main).map_err(|e| Error::io("read", &main, &e))?;
    let text = text.replacen(
        "board::start();",
        "board::start();\n    third_of_two(NODE_ID.raw());",
        1,
    ) + "\n#[inline(never)]\nfn third_of_two(at: u8) {\n    let two = [1u8, 2];\n    \
           core::hint::black_box(two[usize::from(core::hint::black_box(at))]);\n}\n";
    fs::write(&main, text).map_err(|e| Error::io("write", &main, &e))?;
    let mut build = cargo(firmware, &["build", "--quiet", "--release", "--target-dir"]);
    let output = build.arg(&context.repo.target).output();
    let output = output.map_err(|e| Error::Missing(format!("cargo: {e}")))?;
    let said = String::from_utf8_lossy(&output.stderr);
    if output.status.success() || !said.contains("discarded section") || !said.contains(FUNCTION) {
        return Err(Error::Failed(format!(
            "a firmware with a path to a panic links, or nothing names its function:\n{said}"
        )));
    }
    Ok(())
}

/// Makes a workspace for a board in a folder, with the versions of tests/boards.
fn make(
    context: &Context<'_>,
    odkit: &Path,
    folder: &Path,
    file: &str,
    board: &str,
) -> Result<PathBuf> {
    let (repo, workspace) = (context.repo, folder.join(board));
    let mut new = Command::new(odkit);
    new.args(["new", file, "--name", "encoder"]);
    new.args(["--firmware", board, "--odkit", ".", "--path"]);
    new.arg(&workspace).current_dir(&repo.root);
    context
        .console
        .run(&format!("a firmware of {file} for {board}"), &mut new)?;
    let (from, to) = (
        repo.root.join("tests/boards/Cargo.lock"),
        workspace.join("Cargo.lock"),
    );
    fs::copy(from, &to).map_err(|e| Error::io("write", &to, &e))?;
    Ok(workspace)
}

/// Builds the firmware of a workspace for a target.
fn build(context: &Context<'_>, workspace: &Path, target: &str, what: &str) -> Result<()> {
    let firmware = workspace.join("firmware");
    let mut build = cargo(&firmware, &["build", "--release", "--target"]);
    build
        .arg(target)
        .arg("--target-dir")
        .arg(&context.repo.target);
    context
        .console
        .run(&format!("{what} for {target}"), &mut build)
}

/// A firmware for a Cortex-M0 calls no functions for doubles and atomics: gxmm has no REAL64.
fn needs_no_help(program: &Path) -> Result<()> {
    let bytes = fs::read(program).map_err(|e| Error::io("read", program, &e))?;
    // A program without symbols would hide these functions.
    if !has(&bytes, b"__aeabi_") {
        return Err(Error::Failed(format!(
            "{} has no symbols",
            program.display()
        )));
    }
    match HELP.iter().find(|name| has(&bytes, name.as_bytes())) {
        Some(name) => Err(Error::Failed(format!(
            "{} calls {name}...",
            program.display()
        ))),
        None => Ok(()),
    }
}

fn has(bytes: &[u8], name: &[u8]) -> bool {
    bytes.windows(name.len()).any(|part| part == name)
}

/// Runs the firmware of the board `generic`.
fn emulate(context: &Context<'_>, firmware: &Path) -> Result<()> {
    let (repo, console) = (context.repo, context.console);
    if which(EMULATOR).is_none() {
        let why = "the emulator of the Cortex-M3 is missing";
        apt::install(console, &[EMULATOR], why)?;
    }
    let mut build = cargo(firmware, &["build", "--release", "--target-dir"]);
    console.run("the firmware for the emulator", build.arg(&repo.target))?;
    let program = repo
        .target
        .join(target::BARE)
        .join("release/encoder-firmware");
    let mut command = Command::new(EMULATOR);
    command.args(["-M", "lm3s6965evb", "-display", "none", "-monitor", "none"]);
    command.args(["-serial", "stdio", "-kernel"]).arg(program);
    command.stdin(Stdio::piped()).stdout(Stdio::piped());
    let child = command.stderr(Stdio::null()).spawn();
    let mut child = child.map_err(|e| Error::Missing(format!("{EMULATOR}: {e}")))?;
    let result = talk(&mut child);
    let _ = child.kill();
    let _ = child.wait();
    result
}

/// The dialogue, then a heartbeat.
fn talk(child: &mut Child) -> Result<()> {
    let (Some(mut input), Some(output)) = (child.stdin.take(), child.stdout.take()) else {
        return Err(Error::Failed(String::from(
            "the emulator has no serial port",
        )));
    };
    let frames = frames(output);
    let next = |wanted: &str| match frames.recv_timeout(Duration::from_secs(30)) {
        Ok(frame) if frame == wanted => Ok(()),
        Ok(frame) => Err(Error::Failed(format!(
            "the firmware sent {frame}, not {wanted}"
        ))),
        Err(_) => Err(Error::Failed(format!("the firmware did not send {wanted}"))),
    };
    for (request, response) in DIALOGUE {
        let sent = input.write_all(request.as_bytes());
        sent.and_then(|()| input.flush())
            .map_err(|e| Error::Failed(format!("{EMULATOR}: {e}")))?;
        next(response)?;
    }
    next("t70117F")
}

/// The output of the serial port, by a thread that ends with the emulator.
fn frames(output: ChildStdout) -> mpsc::Receiver<String> {
    let (sender, frames) = mpsc::channel();
    thread::spawn(move || {
        let lines = BufReader::new(output).split(b'\r');
        for line in lines.map_while(std::result::Result::ok) {
            let line = String::from_utf8_lossy(&line).into_owned();
            if sender.send(line).is_err() {
                break;
            }
        }
    });
    frames
}
