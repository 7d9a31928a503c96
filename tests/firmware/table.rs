//! The maximum number of instructions for a frame, and its table in docs/PERFORMANCE.md.

use std::path::Path;

use crate::emulator::Answers;
use crate::log::Log;

/// The lines of docs/PERFORMANCE.md around the table.
const MARKS: (&str, &str) = ("<!-- frames -->\n", "<!-- /frames -->");

/// Kinds of input.
const KINDS: [&str; 4] = [
    "NMT or LSS command",
    "SDO request",
    "any other frame",
    "time that passes",
];

/// The longest calls, by kind: instructions until all frames are sent, and a description.
#[derive(Default)]
pub(crate) struct Worst {
    kinds: [(u32, String); KINDS.len()],
    calls: usize,
}

impl Worst {
    /// Adds the calls of a script.
    pub(crate) fn look(&mut self, script: &str, log: &Log, answers: &Answers) {
        self.calls += answers.len();
        for (call, ((_, took), start)) in answers.iter().zip(&log.calls).enumerate() {
            let bytes = &log.bytes[*start..];
            let id = bytes.get(9..13).and_then(|id| id.try_into().ok());
            let kind = match (bytes[0], id.map(u32::from_le_bytes)) {
                (b'F', Some(0 | 0x7E5)) => 0,
                (b'F', Some(0x600..0x680)) => 1,
                (b'F', _) => 2,
                (b'T', _) => 3,
                _ => continue,
            };
            if *took > self.kinds[kind].0 {
                self.kinds[kind] = (*took, format!("{} in {script}", log.describe(call)));
            }
        }
    }

    /// For the log of the test.
    pub(crate) fn summary(&self) -> String {
        let mut text = format!("{} calls; instructions at most:", self.calls);
        for ((took, what), kind) in self.kinds.iter().zip(KINDS) {
            text += &format!("\n  {kind}: {took}, {what}");
        }
        text
    }

    fn row(&self, device: &str) -> String {
        let cells = self
            .kinds
            .iter()
            .map(|(took, _)| format!(" {} |", grouped(*took)));
        format!("| `{device}` |{}\n", cells.collect::<String>())
    }
}

/// A number with a comma before each three digits.
fn grouped(number: u32) -> String {
    match number {
        0..1000 => number.to_string(),
        _ => format!("{},{:03}", grouped(number / 1000), number % 1000),
    }
}

/// Compares with the table in docs/PERFORMANCE.md: no number may be more than 5 % above it. With
/// `ODKIT_ACCEPT` the table is written again.
///
/// # Errors
/// A sentence.
pub(crate) fn check(rows: &[(&str, Worst)]) -> Result<(), String> {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../docs/PERFORMANCE.md");
    let text = std::fs::read_to_string(&path).map_err(|e| format!("docs/PERFORMANCE.md: {e}"))?;
    let parts = text.split_once(MARKS.0).and_then(|(before, rest)| {
        let (listed, after) = rest.split_once(MARKS.1)?;
        Some((before, listed, after))
    });
    let Some((before, listed, after)) = parts else {
        return Err(format!("docs/PERFORMANCE.md lacks {}", MARKS.0.trim_end()));
    };
    let mut table = format!(
        "| | {} |\n|---|{}\n",
        KINDS.join(" | "),
        "--:|".repeat(KINDS.len())
    );
    for (device, worst) in rows {
        table += &worst.row(device);
    }
    if std::env::var_os("ODKIT_ACCEPT").is_some() {
        let text = [before, MARKS.0, &table, MARKS.1, after].concat();
        return std::fs::write(&path, text).map_err(|e| format!("docs/PERFORMANCE.md: {e}"));
    }
    let numbers = |text: &str| -> Vec<u64> {
        let cells = text.split('|').map(|cell| cell.trim().replace(',', ""));
        cells.filter_map(|cell| cell.parse().ok()).collect()
    };
    let (was, now) = (numbers(listed), numbers(&table));
    let mut pairs = was.iter().zip(&now);
    if was.len() != now.len() || pairs.any(|(was, now)| now * 20 > was * 21) {
        Err(format!(
            "more instructions than docs/PERFORMANCE.md says; with ODKIT_ACCEPT=1 this test renews the \
             table:\n{table}"
        ))
    } else {
        Ok(())
    }
}
