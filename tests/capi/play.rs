//! Runs a program, and compares its responses.

use std::path::Path;
use std::process::{Command, Stdio};

use crate::log::{Bytes, Log, shown};

/// A program and its platform.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Program {
    /// On this computer.
    Host(&'static str),
    /// On an emulated Cortex-M3.
    Emulated(&'static str),
}

/// Runs a program.
///
/// # Errors
/// Reason, and the output of the program.
pub(crate) fn play(program: Program, folder: &Path, told: &[u8]) -> Result<Vec<u8>, String> {
    let folder = std::path::absolute(folder).map_err(|e| e.to_string())?;
    let (name, mut command) = match program {
        Program::Host(name) => (name, Command::new(folder.join(name))),
        Program::Emulated(name) => {
            let mut command = Command::new("qemu-system-arm");
            let options = "-M lm3s6965evb -nographic -monitor none -serial none \
                           -semihosting-config enable=on,target=native -kernel";
            command.args(options.split_whitespace());
            command.arg(folder.join(name));
            (name, command)
        }
    };
    let files = folder.join(format!("{name}.files"));
    let io = |what: &str, error: std::io::Error| format!("{what}: {error}");
    std::fs::create_dir_all(&files).map_err(|e| io("a folder for the files", e))?;
    std::fs::write(files.join("told"), told).map_err(|e| io("told", e))?;
    let answers = files.join("answers");
    let _ = std::fs::remove_file(&answers);
    let output = command.current_dir(&files).stdin(Stdio::null()).output();
    let output = output.map_err(|e| io(name, e))?;
    let bytes = std::fs::read(&answers).unwrap_or_default();
    if output.status.success() {
        Ok(bytes)
    } else {
        Err(format!(
            "{} after {} bytes of answers: {}",
            output.status,
            bytes.len(),
            String::from_utf8_lossy(&output.stderr)
        ))
    }
}

/// Returns whether two frames with their times are equal, except for the block size that an SDO server
/// requests: it depends on the buffer, and that of the bench is larger.
fn alike(a: Option<&(u64, Bytes)>, b: Option<&(u64, Bytes)>) -> bool {
    let [a, b] = [a, b].map(|frame| {
        let (at, mut bytes) = *frame?;
        let id = u16::from_le_bytes([bytes[0], bytes[1]]);
        match bytes[5] {
            0xA0 | 0xA4 if id & 0x780 == 0x580 => bytes[9] = 0,
            0xA2 if id & 0x780 == 0x580 => bytes[7] = 0,
            _ => {}
        }
        Some((at, bytes))
    });
    a == b
}

/// Responses that have not been compared yet.
pub(crate) struct Answers<'b> {
    rest: &'b [u8],
}

impl<'b> Answers<'b> {
    /// All responses of a program.
    pub(crate) const fn read(bytes: &'b [u8]) -> Self {
        Self { rest: bytes }
    }

    /// Returns whether all are compared.
    pub(crate) const fn is_empty(&self) -> bool {
        self.rest.is_empty()
    }

    fn take(&mut self, len: usize) -> Result<&'b [u8], String> {
        let part = self.rest.split_off(..len);
        part.ok_or_else(|| String::from("the answers end too early"))
    }

    fn number(&mut self, len: usize) -> Result<u64, String> {
        let bytes = self.take(len)?.iter().rev();
        Ok(bytes.fold(0, |number, byte| number << 8 | u64::from(*byte)))
    }

    /// Compares the responses with a log; returns the first difference.
    ///
    /// # Errors
    /// Reason why the responses are not valid.
    pub(crate) fn next(&mut self, log: &Log) -> Result<Option<String>, String> {
        let mut frames: Vec<(u64, Bytes)> = Vec::new();
        let (mut rates, mut values) = (Vec::new(), Vec::new());
        let eeprom = loop {
            match self.number(1)? as u8 {
                b'f' => {
                    let at = self.number(8)?;
                    let frame = self.take(13)?.try_into().map_err(|_| "a frame")?;
                    frames.push((at, frame));
                }
                b'r' => rates.push(self.number(4)? as u32),
                b'g' => {
                    let result = self.number(4)? as u32;
                    let len = self.number(2)? as usize;
                    values.push((result, self.take(len)?));
                }
                b'd' => break self.take(log.eeprom.len())?,
                other => return Err(format!("`{}` is not an answer", char::from(other))),
            }
        };
        let longest = frames.len().max(log.frames.len());
        let differs = (0..longest).find(|at| !alike(frames.get(*at), log.frames.get(*at)));
        if let Some(at) = differs {
            let (own, its) = (shown(log.frames.get(at)), shown(frames.get(at)));
            return Ok(Some(format!("frame {at}\n  bench {own}\n  in C  {its}")));
        }
        if rates != log.rates {
            return Ok(Some(format!("bit rates {:?}, in C {rates:?}", log.rates)));
        }
        for ((address, own), (result, its)) in log.values.iter().zip(&values) {
            if own != its || *result != 0 {
                return Ok(Some(format!(
                    "{address}: {own:02X?}, in C {its:02X?} ({result:X}h)"
                )));
            }
        }
        if values.len() != log.values.len() {
            return Ok(Some(String::from("not all values were answered")));
        }
        let at = (0..eeprom.len()).find(|at| eeprom.get(*at) != log.eeprom.get(*at));
        Ok(at.map(|at| format!("the EEPROM differs at {at}")))
    }
}
