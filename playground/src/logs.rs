//! Logs of other tools, read and written.

use od_bench::logs::{Format, Record as Line, What, read};
use od_runtime::Instant;
use wasm_bindgen::prelude::*;

use crate::packed;
use crate::record::{Record, bytes};

/// Reads a log: candump, ASC, TRC, pcap or pcapng.
///
/// # Errors
/// Why it is not a log.
#[wasm_bindgen(js_name = readLog, unchecked_return_type = "Log")]
pub fn read_log(file: &[u8]) -> Result<JsValue, JsError> {
    let log = read(file).map_err(|why| JsError::new(&why))?;
    let mut batch = Vec::with_capacity(log.records.len() * packed::LEN);
    for line in &log.records {
        packed::push_line(&mut batch, line);
    }
    let first = log.skipped.first();
    Ok(Record::new()
        .with("frames", bytes(&batch))
        .with("count", log.records.len() as f64)
        .with("skipped", log.skipped.len() as f64)
        .with("line", first.map_or(0, |first| first.line))
        .with("why", first.map_or("", |first| first.why.as_str()))
        .done())
}

/// Writes packed frames as a log; `ending` is `log`, `asc`, `trc` or `pcapng`.
///
/// # Errors
/// The format does not exist.
#[wasm_bindgen(js_name = writeLog)]
pub fn write_log(ending: &str, frames: &[u8]) -> Result<Vec<u8>, JsError> {
    let format = Format::of_ending(ending)
        .ok_or_else(|| JsError::new(&format!("`{ending}` is not a format of logs")))?;
    let lines: Vec<Line> = frames.chunks_exact(packed::LEN).filter_map(line).collect();
    Ok(format.write(&lines))
}

fn line(bytes: &[u8]) -> Option<Line> {
    let what = match packed::is_disturbed(bytes) {
        true => What::Error,
        false => What::Frame(packed::frame(bytes)?),
    };
    Some(Line {
        at: Instant::from_micros(packed::micros(bytes)? as u64),
        sent: packed::is_own(bytes),
        what,
    })
}
