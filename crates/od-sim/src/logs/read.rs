//! Reads the records of a log in any supported format.

use od_model::Refused;
use std::prelude::v1::*;

use od_wire::Instant;

use super::channel::{Channels, Form, apart};
use super::joined::joined;
use super::pcap::Capture;
use super::record::{Entry, Reader, Record, Unread, What};
use super::{adapters, asc, blf, candump, columns, csv, foreign, pcap, pcapng, stamp, trc, typed};
use crate::cursor::Cursor;

/// A log that was read.
#[derive(Clone, PartialEq, Eq, Debug, Default)]
pub struct Log {
    /// Records, in the order of their times.
    pub records: Vec<Record>,
    /// Lines or frames that could not be read.
    pub skipped: Vec<Unread>,
    /// Number of the entries that are not frames: events of an ASC or a TRC, packets of other protocols.
    pub others: usize,
    /// Whether the log has no times, as `candump` prints it without `-t`, or an adapter of slcan sends it. All records then
    /// have time 0.
    pub lacks_times: bool,
    /// Names of the channels if there are two and more: interfaces, or numbers of buses.
    pub channels: Vec<String>,
    /// The number of the channel of each record.
    pub(super) numbers: Vec<u8>,
}

impl Log {
    /// Takes the records of each channel with its name; of a log with one channel, all without a name.
    pub fn take_channels(&mut self) -> Vec<(String, Vec<Record>)> {
        let numbers = core::mem::take(&mut self.numbers);
        apart(core::mem::take(&mut self.records), numbers, &self.channels)
    }
}

/// Converts times of day to times from the start, in microseconds; a log that starts near 0 keeps its times.
const WALL_CLOCK: u64 = 1_000_000_000_000;

/// The format of a text must show within this number of lines.
const HEAD: usize = 200;

/// Reads a log: candump, ASC, BLF, TRC (1.0 to 2.1), pcap or pcapng; CSV of SavvyCAN, CL2000, CANedge, Kvaser, IXXAT or python-can;
/// what python-can prints, Kvaser CanKing, Kvaser Memorator (text), or BUSMASTER; lines of slcan or socketcand; commands of `cansend`;
/// frames as people type them, such as `0x601: 40 00 10 00 00 00 00 00`.
///
/// # Errors
/// The reason why it is not a log, or the first line if no line can be read.
pub fn read(bytes: &[u8]) -> Result<Log, Refused> {
    let capture = pcapng::read(bytes).or_else(|| pcap::read(bytes));
    if let Some(capture) = capture.or_else(|| blf::read(bytes)) {
        let Capture {
            records,
            skipped,
            others,
            channels,
            ..
        } = capture?;
        return Ok(Log {
            others,
            channels: channels.names(),
            ..finish(records, skipped)
        });
    }
    let text = plain(&decoded(bytes));
    let lines = joined(lines(text.trim_start_matches('\u{feff}')).collect());
    let lines: Vec<&str> = lines.iter().map(String::as_str).collect();
    let mut lacks_times = is_untimed(&lines);
    let mut is_typed = false;
    let (mut reader, form) = match choose(&lines, lacks_times) {
        Some(chosen) => chosen,
        None if text.trim().is_empty() => return Err("it is empty: no frame was recorded".into()),
        None => {
            if let Some(known) = foreign::name(bytes) {
                return Err(known.into());
            }
            if !typed::is_one(lines.iter().take(HEAD).copied()) {
                return Err("it is not a candump log, ASC, BLF, TRC, CSV, slcan, pcap or pcapng; SavvyCAN opens many other \
                            logs and saves them as a candump log"
                    .into());
            }
            lacks_times = typed::is_untimed(&lines);
            is_typed = true;
            (typed::reader(), Form::Other)
        }
    };
    let mut records = Vec::new();
    let mut skipped = Vec::new();
    let mut others = 0;
    let may_be_deltas = form == Form::Candump || is_typed;
    let mut channels = Channels::default();
    for (line, text) in (1..).zip(&lines) {
        // A log in an issue is often between two fences of Markdown, or below the command that wrote it.
        if text.trim().is_empty() || text.starts_with("```") || is_command(text) {
            continue;
        }
        let read = if is_gap(text) {
            Err("frames are left out here".into())
        } else {
            reader(text)
        };
        match read {
            Ok(Entry::Record(record)) => records.push((record, channels.number(form.name(text)))),
            Ok(Entry::Other) => others += 1,
            Ok(Entry::Nothing) => {}
            Err(why) => skipped.push(Unread {
                line,
                is_frame: false,
                why,
            }),
        }
    }
    if may_be_deltas && are_deltas(&records) {
        let mut at = Instant::ZERO;
        for (record, _) in &mut records {
            at = at.plus_micros(record.at.as_micros());
            record.at = at;
        }
    }
    match skipped.first() {
        Some(first) if records.is_empty() => Err(first.to_string().into()),
        _ => Ok(Log {
            lacks_times,
            others,
            channels: channels.names(),
            ..finish(records, skipped)
        }),
    }
}

/// Returns whether a line is a prompt of a shell, with or without the command that wrote the log: `root@host:~# candump can0`.
fn is_command(line: &str) -> bool {
    let line = line.trim();
    let after = line
        .split_once(['$', '#'])
        .filter(|(prompt, _)| prompt.contains('@'));
    after.is_some_and(|(_, rest)| {
        rest.is_empty() || rest.starts_with(' ') && rest.contains("candump")
    })
}

/// Returns whether a line of points stands for frames that were left out.
fn is_gap(line: &str) -> bool {
    let line = line.trim().trim_matches(['[', ']', '(', ')']);
    line == "…" || line.len() > 1 && line.bytes().all(|c| c == b'.')
}

/// The text of a file in UTF-8, or in UTF-16 with a byte order mark, as PowerShell writes the output of a command.
fn decoded(bytes: &[u8]) -> String {
    let unit: fn([u8; 2]) -> u16 = match bytes {
        [0xFF, 0xFE, ..] => u16::from_le_bytes,
        [0xFE, 0xFF, ..] => u16::from_be_bytes,
        _ => return String::from_utf8_lossy(bytes).into_owned(),
    };
    let pairs = bytes.chunks_exact(2).map(|pair| unit([pair[0], pair[1]]));
    char::decode_utf16(pairs)
        .map(|one| one.unwrap_or(char::REPLACEMENT_CHARACTER))
        .collect()
}

/// The text without the colours of a terminal (`candump -c`): ESC, `[`, digits, `m`.
fn plain(text: &str) -> String {
    let mut parts = text.split("\u{1b}[");
    let mut plain: String = parts.next().unwrap_or_default().into();
    for part in parts {
        let rest = part.trim_start_matches(|c: char| c.is_ascii_digit() || c == ';');
        plain.push_str(rest.strip_prefix('m').unwrap_or(part));
    }
    plain
}

/// Lines that end with `\n`, `\r\n` or `\r`, without the `> ` before a quotation in a mail.
fn lines(text: &str) -> impl Iterator<Item = &str> {
    text.split('\n')
        .flat_map(|line| line.strip_suffix('\r').unwrap_or(line).split('\r'))
        .map(|line| line.trim_start_matches("> "))
}

fn finish(mut records: Vec<(Record, u8)>, skipped: Vec<Unread>) -> Log {
    records.sort_by_key(|(record, _)| record.at);
    let start = records
        .first()
        .map_or(0, |(record, _)| record.at.as_micros());
    let (mut records, numbers): (Vec<Record>, Vec<u8>) = records.into_iter().unzip();
    if start > WALL_CLOCK {
        for record in &mut records {
            record.at = Instant::from_micros(record.at.as_micros() - start);
        }
    }
    Log {
        records,
        skipped,
        lacks_times: false,
        others: 0,
        channels: Vec::new(),
        numbers,
    }
}

/// Returns whether the times are those since the frame before, as `candump -td` prints them: the first is 0, and at
/// least one of four is less than the one before it.
fn are_deltas(records: &[(Record, u8)]) -> bool {
    let falls = records.windows(2);
    let falls = falls.filter(|pair| pair[1].0.at < pair[0].0.at);
    records
        .first()
        .is_some_and(|(first, _)| first.at == Instant::ZERO)
        && falls.count() * 4 >= records.len().max(4) - 1
}

/// Returns whether no line has a time stamp, and a line is a frame: what `candump` prints without `-t`, or an adapter sends.
fn is_untimed(lines: &[&str]) -> bool {
    let head = || lines.iter().take(HEAD).map(|line| line.trim_start());
    let is_untimed = |line: &str| candump::is_untimed(command(line)) || adapters::is_untimed(line);
    let is_timed =
        |line: &str| line.starts_with('(') || adapters::is_one(line) && !adapters::is_untimed(line);
    !head().any(is_timed) && head().any(is_untimed)
}

/// The arguments of a command of `cansend`; any other line is itself.
fn command(line: &str) -> &str {
    let line = line.trim_start();
    line.strip_prefix("cansend ").unwrap_or(line)
}

/// The reader of the format that a line of the head shows, and its form.
fn choose<'t>(lines: &[&'t str], lacks_times: bool) -> Option<(Reader<'t>, Form)> {
    let head = || lines.iter().take(HEAD).map(|line| line.trim_start());
    // The rows of some of them look like those of an ASC log.
    if head().any(columns::is_one) {
        return Some((columns::reader(lines), columns::form(lines)));
    }
    if head().any(trc::is_one) {
        return Some((trc::reader(lines), trc::form(lines)));
    }
    if head().any(asc::is_one) {
        return Some((asc::reader(lines), Form::Asc));
    }
    if head().any(csv::is_one) {
        return Some((csv::reader(lines), csv::form(lines)));
    }
    if head().any(adapters::is_one) {
        return Some((adapters::reader(), Form::Other));
    }
    let is_candump = |line: &str| {
        let mut rest = Cursor::new(line);
        stamp::take(&mut rest).is_some() && rest.text.contains(char::is_whitespace)
    };
    let is_one = lacks_times || head().any(is_candump);
    let mut is_error = false;
    is_one.then(|| {
        let reader = Box::new(move |text: &'t str| {
            // `candump -e` explains an error frame in lines that begin with a tabulator.
            if is_error && text.starts_with('\t') {
                return Ok(Entry::Nothing);
            }
            let read = line(text, lacks_times);
            is_error =
                matches!(&read, Ok(Entry::Record(record)) if matches!(record.what, What::Error(_)));
            read
        });
        (reader as Reader<'t>, Form::Candump)
    })
}

/// Reads a line of candump, in the log or the screen form.
fn line(text: &str, lacks_times: bool) -> Result<Entry, String> {
    if text.trim_start().starts_with(['#', ';']) {
        return Ok(Entry::Nothing);
    }
    if let Some(lost) = text.trim_start().strip_prefix("DROPCOUNT: dropped ") {
        let count = lost.split(' ').next().unwrap_or_default();
        return Err(format!("candump lost frames here: {count}"));
    }
    let missing = "the time stamp in parentheses is missing";
    if !text.trim_start().starts_with('(') && !lacks_times {
        return Err(missing.into());
    }
    let logged = candump::logged(command(text)).map_err(|error| error.message)?;
    let at = match logged.at {
        None if lacks_times => Instant::ZERO,
        at => at.ok_or(missing)?,
    };
    Ok(match logged.what() {
        Some(what) => Entry::Record(Record {
            at,
            sent: logged.sent,
            what,
        }),
        None => Entry::Other,
    })
}
