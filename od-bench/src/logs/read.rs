//! From the bytes of a file to records, whatever wrote it.

use std::fmt;
use std::prelude::v1::*;

use od_wire::Instant;

use super::record::{ERROR, Reader, Record};
use super::{asc, candump, pcap, pcapng, trc};

/// A log that was read.
#[derive(Clone, PartialEq, Eq, Debug, Default)]
pub struct Log {
    /// Records, in the order of their times.
    pub records: Vec<Record>,
    /// Lines that could not be read.
    pub skipped: Vec<Problem>,
}

/// A line that could not be read.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct Problem {
    /// Counted from 1.
    pub line: u32,
    /// The problem of the line.
    pub why: String,
}

impl fmt::Display for Problem {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "line {}: {}", self.line, self.why)
    }
}

/// Clocks of the wall are taken off; a log that starts near 0 keeps its times. In microseconds.
const WALL_CLOCK: u64 = 1_000_000_000_000;

/// Lines in which a text has to show what it is.
const HEAD: usize = 200;

/// A file of Vector's binary logging format begins with it.
const BLF: &[u8] = b"LOGG";

/// Reads a log: candump, ASC, TRC (1.0 to 2.1), pcap or pcapng.
///
/// # Errors
/// Why it is not a log, or the first line if no line can be read.
pub fn read(bytes: &[u8]) -> Result<Log, String> {
    if let Some(records) = pcapng::read(bytes).or_else(|| pcap::read(bytes)) {
        return records.map(|records| finish(records, Vec::new()));
    }
    if bytes.starts_with(BLF) {
        return Err(
            "it is a BLF log, which odkit does not read; `can_logconvert` of python-can turns it \
             into a candump log (`can_logconvert FILE.blf FILE.log`)"
                .into(),
        );
    }
    let text = String::from_utf8_lossy(bytes);
    let lines: Vec<&str> = lines(text.trim_start_matches('\u{feff}')).collect();
    let Some(mut reader) = choose(&lines) else {
        return Err("it is not a candump log, ASC, TRC, pcap or pcapng".into());
    };
    let mut records = Vec::new();
    let mut skipped = Vec::new();
    for (line, text) in (1..).zip(&lines) {
        if text.trim().is_empty() {
            continue;
        }
        match reader(text) {
            Ok(Some(record)) => records.push(record),
            Ok(None) => {}
            Err(why) => skipped.push(Problem { line, why }),
        }
    }
    match skipped.first() {
        Some(first) if records.is_empty() => Err(first.to_string()),
        _ => Ok(finish(records, skipped)),
    }
}

/// Lines that end with `\n`, `\r\n` or `\r`.
fn lines(text: &str) -> impl Iterator<Item = &str> {
    text.split('\n')
        .flat_map(|line| line.strip_suffix('\r').unwrap_or(line).split('\r'))
}

fn finish(mut records: Vec<Record>, skipped: Vec<Problem>) -> Log {
    records.sort_by_key(|record| record.at);
    let start = records.first().map_or(0, |record| record.at.as_micros());
    if start > WALL_CLOCK {
        for record in &mut records {
            record.at = Instant::from_micros(record.at.as_micros() - start);
        }
    }
    Log { records, skipped }
}

fn choose<'t>(lines: &[&'t str]) -> Option<Reader<'t>> {
    let head = || lines.iter().take(HEAD).map(|line| line.trim_start());
    if head().any(trc::is_one) {
        return Some(trc::reader(lines));
    }
    if head().any(asc::is_one) {
        return Some(asc::reader(lines));
    }
    let is_candump = |line: &str| {
        let mut words = line.split_whitespace();
        let stamp = words.next().and_then(stamp);
        stamp.is_some() && words.count() > 1
    };
    head().any(is_candump).then(|| Box::new(line) as Reader<'t>)
}

/// The moment in `(0.100000)`.
fn stamp(word: &str) -> Option<Instant> {
    let inner = word.strip_prefix('(')?.strip_suffix(')')?;
    candump::seconds(inner).map(Instant::from_micros)
}

/// `(1.0) can0 601#4004…`, `(1.0) can0 701#R T`, and the screen: `(1.0) can0 601 [8] 40 04`.
fn line(text: &str) -> Result<Option<Record>, String> {
    if text.trim_start().starts_with(['#', ';']) {
        return Ok(None);
    }
    let mut words = text.split_whitespace().peekable();
    let at = words.next().and_then(stamp);
    let at = at.ok_or("the time stamp in parentheses is missing")?;
    words.next();
    // `candump -x` writes the direction and flags before the CAN-ID.
    while words
        .next_if(|word| matches!(*word, "RX" | "TX") || word.bytes().all(|byte| byte == b'-'))
        .is_some()
    {}
    let frame = words.next().unwrap_or_default();
    if is_error(frame) {
        return Ok(Some(Record::error(at)));
    }
    if frame.contains('#') {
        let frame = candump::parse_frame(frame).map_err(|error| error.message)?;
        let sent = words
            .next()
            .is_some_and(|word| word.eq_ignore_ascii_case("T"));
        return Ok(Some(Record::received(at, frame).sent(sent)));
    }
    // Characters may follow the bytes: `candump -a`.
    let rest = words.take_while(|word| !word.starts_with('\''));
    let screen = rest.fold(format!("can0 {frame}"), |text, word| text + " " + word);
    let line = candump::parse_line(&screen).map_err(|error| error.message)?;
    Ok(Some(Record::received(at, line.frame)))
}

/// An error frame of SocketCAN has a flag in its identifier.
fn is_error(frame: &str) -> bool {
    let id = frame.split('#').next().unwrap_or_default();
    let raw = u32::from_str_radix(id, 16).ok().filter(|_| id.len() == 8);
    raw.is_some_and(|raw| raw & ERROR != 0)
}
