//! Vector ASC.

use std::prelude::v1::*;

use od_wire::Instant;

use super::record::{Reader, Record, frame, id};
use super::stamp;

/// Returns whether this line shows that the text is an ASC log.
pub(super) fn is_one(line: &str) -> bool {
    let mut words = line.split_whitespace();
    match words.next().map(str::to_ascii_lowercase).as_deref() {
        Some("date") => words.next().is_some(),
        Some("base") => words
            .next()
            .is_some_and(|base| ["hex", "dec"].contains(&base.to_ascii_lowercase().as_str())),
        _ => false,
    }
}

/// Words that begin a line about the log itself.
const HEADS: [&str; 6] = ["date", "base", "internal", "no", "begin", "end"];

/// Words after a time stamp for events that are not frames.
const OTHERS: [&str; 5] = ["canfd", "log", "start", "trigger", "comment"];

pub(super) fn reader<'t>(lines: &[&'t str]) -> Reader<'t> {
    let base = lines
        .iter()
        .map(|line| line.trim_start().to_ascii_lowercase())
        .find(|line| line.starts_with("base"))
        .unwrap_or_default();
    let radix = if base.contains(" dec") { 10 } else { 16 };
    let is_relative = base.contains("relative");
    let mut last = 0;
    Box::new(move |line| {
        let mut words = line.split_whitespace();
        let first = words.next().unwrap_or_default();
        if first.starts_with("//") || HEADS.contains(&first.to_ascii_lowercase().as_str()) {
            return Ok(None);
        }
        let time = stamp::seconds(first).filter(|_| first.contains('.'));
        let time = time.ok_or("the time stamp is missing")?;
        last = if is_relative {
            time.saturating_add(last)
        } else {
            time
        };
        record(
            Instant::from_micros(last),
            &words.collect::<Vec<_>>(),
            radix,
        )
    })
}

/// `1  601  Rx  d 8 40 04 …`, `1  64x  Rx  r 2`, `1  ErrorFrame`.
fn record(at: Instant, words: &[&str], radix: u32) -> Result<Option<Record>, String> {
    let lower = |at: usize| words.get(at).map(|word| word.to_ascii_lowercase());
    let (channel, second) = (lower(0).unwrap_or_default(), lower(1).unwrap_or_default());
    let is_other = OTHERS.contains(&channel.as_str())
        || second == "statistic:"
        || second.starts_with("statistic")
        || second.starts_with("j1939")
        || channel == "can" && lower(2).as_deref() == Some("status");
    if is_other {
        return Ok(None);
    }
    if second.starts_with("errorframe") {
        return Ok(Some(Record::error(at)));
    }
    let (sent, kind) = match (lower(2).as_deref(), lower(3).as_deref()) {
        (Some("rx"), Some(kind)) => (false, kind.to_owned()),
        (Some("tx"), Some(kind)) => (true, kind.to_owned()),
        _ => return Err("a frame such as `1  601  Rx  d 8 40 04 …` is missing".into()),
    };
    let extended = second.ends_with('x');
    let id = id(second.trim_end_matches('x'), radix, extended)?;
    let dlc = words
        .get(4)
        .and_then(|word| u8::from_str_radix(word, 16).ok());
    let (remote, dlc) = match (kind.as_str(), dlc) {
        ("r", dlc) => (true, dlc.unwrap_or(0).min(8)),
        ("d", Some(dlc)) => (false, dlc.min(8)),
        _ => return Err("the length of the data is missing".into()),
    };
    let data = words.iter().skip(5).copied();
    let frame = frame(id, dlc, remote, data, radix)?;
    Ok(Some(Record::received(at, frame).sent(sent)))
}
