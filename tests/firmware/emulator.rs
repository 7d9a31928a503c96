//! Runs a program on an emulated Cortex-M3, and reads its answers.

use std::path::Path;
use std::process::{Command, Stdio};

use crate::log::{Answer, HEAD, Log};

/// Answers of the program, each with the instructions that it took.
pub(crate) type Answers = Vec<(Answer, u32)>;

/// Runs a program on the logs, in a folder for its files.
///
/// # Errors
/// A sentence, and the output of the emulator.
pub(crate) fn play(program: &Path, folder: &Path, logs: &[&Log]) -> Result<Vec<Answers>, String> {
    let io = |what: &str, error: std::io::Error| format!("{what}: {error}");
    std::fs::create_dir_all(folder).map_err(|e| io("a folder for the files", e))?;
    let calls: Vec<u8> = logs
        .iter()
        .flat_map(|log| log.bytes.iter().copied())
        .collect();
    std::fs::write(folder.join("calls"), calls).map_err(|e| io("calls", e))?;
    let answers = folder.join("answers");
    let _ = std::fs::remove_file(&answers);
    // The clock of the program counts instructions: 12.8 ticks are one.
    let arguments = [
        "-M lm3s6965evb -nographic -monitor none -serial none",
        "-icount shift=10,sleep=off -semihosting-config enable=on,target=native -kernel",
    ];
    let output = Command::new("qemu-system-arm")
        .args(arguments.iter().flat_map(|line| line.split(' ')))
        .arg(program)
        .current_dir(folder)
        .stdin(Stdio::null())
        .output()
        .map_err(|e| io("qemu-system-arm", e))?;
    let bytes = std::fs::read(&answers).unwrap_or_default();
    if !output.status.success() {
        let said = String::from_utf8_lossy(&output.stderr).into_owned();
        let len = bytes.len();
        return Err(format!("it stopped after {len} bytes of answers: {said}"));
    }
    let mut rest = &bytes[..];
    let all = logs.iter().map(|log| {
        let answers = log.answers.iter();
        answers
            .map(|expected| read(&mut rest, expected.rest.len()))
            .collect()
    });
    let all: Option<Vec<Answers>> = all.collect();
    all.filter(|_| rest.is_empty())
        .ok_or_else(|| String::from("it gave more or fewer answers than there are calls"))
}

/// Reads an answer.
fn read(bytes: &mut &[u8], rest: usize) -> Option<(Answer, u32)> {
    let head = bytes.split_off(..HEAD)?.try_into().ok()?;
    let ticks = u32::from_le_bytes(bytes.split_off(..4)?.try_into().ok()?);
    let count = *bytes.split_off_first()?;
    let frames = (0..count).map(|_| bytes.split_off(..13)?.try_into().ok());
    let answer = Answer {
        head,
        frames: frames.collect::<Option<_>>()?,
        rest: bytes.split_off(..rest)?.to_vec(),
    };
    Some((answer, ticks.saturating_mul(10).saturating_add(64) / 128))
}
