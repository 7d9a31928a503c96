//! Reads and writes logs of other tools.

use od_runtime::Instant;
use od_sim::logs::{Format, Record, What, read};
use wasm_bindgen::prelude::*;

use crate::crossing::{Bytes, Crosses, record};
use crate::packed;

record! {
    /// A parsed log.
    Log {
        /// Packed frames.
        frames: Bytes,
        count: usize,
        /// Number of lines that could not be read.
        skipped: usize,
        /// The first of these lines; 0 if there is none.
        line: u32,
        /// Reason why it could not be read.
        why: String,
    }
}

/// Reads a log: candump, ASC, TRC, pcap or pcapng.
///
/// # Errors
/// Reason why it is not a log.
#[wasm_bindgen(js_name = readLog, unchecked_return_type = "Log")]
pub fn read_log(file: &[u8]) -> Result<JsValue, JsError> {
    let log = read(file)?;
    let mut batch = Vec::with_capacity(log.records.len() * packed::LEN);
    for line in &log.records {
        packed::push_line(&mut batch, line);
    }
    let (count, skipped) = (log.records.len(), log.skipped.len());
    let first = log.skipped.into_iter().next();
    let (line, why) = first.map_or((0, String::new()), |first| (first.line, first.why));
    let frames = Bytes(batch);
    let log = Log {
        frames,
        count,
        skipped,
        line,
        why,
    };
    Ok(log.value())
}

/// Writes packed frames as a log; `ending` is `log`, `asc`, `trc` or `pcapng`.
///
/// # Errors
/// The format does not exist.
#[wasm_bindgen(js_name = writeLog)]
pub fn write_log(ending: &str, frames: &[u8]) -> Result<Vec<u8>, JsError> {
    let format = Format::of_ending(ending)
        .ok_or_else(|| JsError::new(&format!("`{ending}` is not a format of logs")))?;
    let lines: Vec<Record> = frames.chunks_exact(packed::LEN).filter_map(line).collect();
    Ok(format.write(&lines))
}

fn line(bytes: &[u8]) -> Option<Record> {
    let what = if packed::is_disturbed(bytes) {
        What::Error
    } else {
        What::Frame(packed::frame(bytes)?)
    };
    Some(Record {
        at: Instant::from_micros(packed::micros(bytes)? as u64),
        sent: packed::is_own(bytes),
        what,
    })
}
