//! Reads and writes logs of other tools, and finds the faults in them.

use od_runtime::Instant;
use od_sim::diagnose::{self, BusFacts};
use od_sim::logs::{BusError, Format, Record, What, read};
use wasm_bindgen::prelude::*;

use crate::crossing::{Bytes, Crosses, record};
use crate::packed;

record! {
    /// A parsed log.
    Log {
        /// The buses whose frames it has; a log of one bus has one without a name.
        channels: Vec<Channel>,
        count: usize,
        /// Number of lines that could not be read.
        skipped: usize,
        /// The first of these lines; 0 if there is none.
        line: u32,
        /// Reason why it could not be read.
        why: String,
    }

    /// The frames of a bus in a log.
    Channel {
        /// Its name in the log, such as `can0`.
        name: String,
        /// Packed frames.
        frames: Bytes,
        count: usize,
    }
}

/// Reads a log: candump, ASC, BLF, TRC, pcap or pcapng.
///
/// # Errors
/// Reason why it is not a log.
#[wasm_bindgen(js_name = readLog, unchecked_return_type = "Log")]
pub fn read_log(file: &[u8]) -> Result<JsValue, JsError> {
    let mut log = read(file)?;
    let (count, skipped) = (log.records.len(), log.skipped.len());
    let channels = log.take_channels().into_iter();
    let channels = channels.map(|(name, records)| {
        let mut batch = Vec::with_capacity(records.len() * packed::LEN);
        for line in &records {
            packed::push_line(&mut batch, line);
        }
        Channel {
            name,
            frames: Bytes(batch),
            count: records.len(),
        }
    });
    let channels = channels.collect();
    let first = log.skipped.into_iter().next();
    let (line, why) = first.map_or((0, String::new()), |first| (first.line, first.why));
    let log = Log {
        channels,
        count,
        skipped,
        line,
        why,
    };
    Ok(log.value())
}

record! {
    /// The faults in a log.
    Diagnosis {
        /// The faults, in the order of their beginning.
        incidents: Vec<Incident>,
        /// Why the frames are not CANopen, in one sentence; empty: they are, or may be.
        other: &'static str,
    }

    /// A fault in a log.
    Incident {
        /// The incident in one sentence.
        text: String,
        /// Begin, end, and whether the bus recovered.
        span: String,
        causes: Vec<Cause>,
        /// Places in the log of the frames that show it.
        frames: Vec<usize>,
    }

    /// A likely cause of a fault.
    Cause {
        text: String,
        /// First things to check.
        check: String,
    }
}

/// Finds the faults in packed frames, in the order of their beginning; `rate` is the bit rate in kbit/s, if it is known.
#[wasm_bindgen(unchecked_return_type = "Diagnosis")]
pub fn diagnose(frames: &[u8], rate: Option<u16>) -> JsValue {
    let known = BusFacts {
        bit_rate: rate,
        dictionary: None,
    };
    let records = records(frames);
    let found = diagnose::diagnose(&records, known).into_iter();
    let diagnosis = Diagnosis {
        incidents: found.map(incident).collect(),
        other: diagnose::other_protocol(&records).unwrap_or_default(),
    };
    diagnosis.value()
}

fn incident(found: diagnose::Incident) -> Incident {
    let cause = |one: diagnose::Cause| Cause {
        text: one.text,
        check: one.check,
    };
    Incident {
        span: found.span(),
        text: found.text,
        causes: found.causes.into_iter().map(cause).collect(),
        frames: found.records,
    }
}

/// Writes packed frames as a log; `ending` is `log`, `asc`, `trc` or `pcapng`.
///
/// # Errors
/// The format does not exist.
#[wasm_bindgen(js_name = writeLog)]
pub fn write_log(ending: &str, frames: &[u8]) -> Result<Vec<u8>, JsError> {
    let format = Format::of_ending(ending)
        .ok_or_else(|| JsError::new(&format!("`{ending}` is not a format of logs")))?;
    Ok(format.write(&records(frames)))
}

fn records(frames: &[u8]) -> Vec<Record> {
    frames.chunks_exact(packed::LEN).filter_map(line).collect()
}

fn line(bytes: &[u8]) -> Option<Record> {
    let what = if packed::is_disturbed(bytes) {
        What::Error(BusError::Frame)
    } else {
        What::Frame(packed::frame(bytes)?)
    };
    Some(Record {
        at: Instant::from_micros(packed::micros(bytes)? as u64),
        sent: packed::is_own(bytes),
        what,
    })
}
