//! ASC logs of CANoe and CANalyzer: text with one event in a line.

use std::prelude::v1::*;

use od_wire::Instant;

use super::record::{BusError, Entry, FD, Reader, Record, frame, id};
use super::stamp;

/// Returns whether this line shows that the text is an ASC log.
pub(super) fn is_one(line: &str) -> bool {
    let mut words = line.split_whitespace();
    match words.next().map(str::to_ascii_lowercase).as_deref() {
        Some("date") => words.next().is_some(),
        Some("base") => words
            .next()
            .is_some_and(|base| ["hex", "dec"].contains(&base.to_ascii_lowercase().as_str())),
        Some(time) => time.contains(POINTS) && stamp::seconds(time).is_some() && is_frame(words),
        None => false,
    }
}

/// Returns whether the words after the time are those of a frame, as in a log without its first lines.
fn is_frame<'t>(words: impl Iterator<Item = &'t str>) -> bool {
    let words: Vec<String> = words.take(4).map(str::to_ascii_lowercase).collect();
    let words: Vec<&str> = words.iter().map(String::as_str).collect();
    match words[..] {
        ["canfd", channel, "rx" | "tx", _] | [channel, _, "rx" | "tx", "d" | "r"] => {
            channel.parse::<u8>().is_ok()
        }
        _ => false,
    }
}

/// Decimal points: a program on a computer with another language writes a comma.
const POINTS: [char; 2] = ['.', ','];

/// Words that begin a line about the log itself.
const HEADS: [&str; 6] = ["date", "base", "internal", "no", "begin", "end"];

/// Words after a time stamp that begin a note about the log.
const NOTES: [&str; 4] = ["log", "start", "trigger", "comment"];

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
            return Ok(Entry::Nothing);
        }
        let time = stamp::seconds(first).filter(|_| first.contains(POINTS));
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

/// States of the controller in an event, after `CAN 1 Status:`.
const STATES: [(&str, BusError); 3] = [
    ("chip status warning level", BusError::Warning),
    ("chip status error passive", BusError::Passive),
    ("chip status busoff", BusError::BusOff),
];

/// The words for a state of the controller; `None`: an error frame.
pub(super) fn status(error: BusError) -> Option<&'static str> {
    let mut all = STATES.iter();
    all.find_map(|(words, state)| (*state == error).then_some(*words))
}

/// `1  601  Rx  d 8 40 04 …`, `1  64x  Rx  r 2`, `1  ErrorFrame`; all others are events.
fn record(at: Instant, words: &[&str], radix: u32) -> Result<Entry, String> {
    let lower = |at: usize| words.get(at).map(|word| word.to_ascii_lowercase());
    let (channel, second) = (lower(0).unwrap_or_default(), lower(1).unwrap_or_default());
    if NOTES.contains(&channel.as_str()) {
        return Ok(Entry::Nothing);
    }
    if channel == "canfd" {
        return fd_channel(at, &words[1..], radix);
    }
    if second.starts_with("errorframe") {
        return Ok(Entry::Record(Record::error(at)));
    }
    if channel == "can" {
        let event = words
            .join(" ")
            .to_ascii_lowercase()
            .replace("bus off", "busoff");
        let mut states = STATES.iter();
        let state = states.find_map(|(words, state)| event.contains(words).then_some(*state));
        return Ok(state.map_or(Entry::Other, |state| Entry::Record(Record::of(at, state))));
    }
    let is_channel = channel.parse::<u8>().is_ok();
    let (sent, kind) = match (lower(2).as_deref(), lower(3)) {
        (Some("rx"), Some(kind)) if is_channel => (false, kind),
        (Some("tx"), Some(kind)) if is_channel => (true, kind),
        (Some("rx" | "tx"), None) if is_channel => {
            return Err("a frame such as `1  601  Rx  d 8 40 04 …` is cut".into());
        }
        // TxRq, Status, SV, OverloadFrame and all other events of the format.
        _ => return Ok(Entry::Other),
    };
    let dlc = words
        .get(4)
        .and_then(|word| u8::from_str_radix(word, 16).ok());
    let (remote, dlc) = match (kind.as_str(), dlc) {
        ("r", dlc) => (true, dlc.unwrap_or(0).min(8)),
        ("d", Some(dlc)) => (false, dlc.min(8)),
        ("d", None) => return Err("the length of the data is missing".into()),
        // An event of another protocol, such as J1939.
        _ => return Ok(Entry::Other),
    };
    let id = asc_id(&second, radix)?;
    let data = words.iter().skip(5).copied();
    let frame = frame(id, dlc, remote, data, radix)?;
    Ok(Entry::Record(Record::received(at, frame).sent(sent)))
}

fn asc_id(word: &str, radix: u32) -> Result<od_wire::CanId, String> {
    let digits = word.strip_suffix('x').unwrap_or(word);
    if !digits.chars().all(|digit| digit.is_digit(radix)) {
        return Err(format!(
            "`{word}` is the name of a message; write the log without a database, so that it has CAN-IDs"
        ));
    }
    id(word.trim_end_matches('x'), radix, word.ends_with('x'))
}

/// Bit 4 of the flags of a `CANFD` line: a remote frame.
const FLAG_REMOTE: u32 = 1 << 4;
/// Bit 12: a frame in the format of CAN FD (FDF). Without it the frame is a classic one.
const FLAG_FD: u32 = 1 << 12;

/// Reads the words after `CANFD`, which interfaces with CAN FD write for each frame: channel, direction,
/// CAN-ID, a name or none, BRS, ESI, DLC, length, data, duration, length of the message in bits, flags.
fn fd_channel(at: Instant, words: &[&str], radix: u32) -> Result<Entry, String> {
    let lower = |at: usize| words.get(at).map(|word| word.to_ascii_lowercase());
    let sent = match lower(1).as_deref() {
        Some("rx") => false,
        Some("tx") => true,
        _ => return Ok(Entry::Other),
    };
    let second = lower(2).ok_or("the CAN-ID is missing")?;
    if second.starts_with("errorframe") {
        return Ok(Entry::Record(Record::error(at)));
    }
    // The name of the message is optional.
    let is_bit = |at: usize| matches!(words.get(at), Some(&"0" | &"1"));
    let first = if is_bit(3) && is_bit(4) { 3 } else { 4 };
    let rest = words.get(first..).unwrap_or_default();
    let [brs, _, dlc, length, data @ ..] = rest else {
        return Err("a frame such as `CANFD 1 Rx 601 0 0 8 8 40 04 …` is cut".into());
    };
    let length: usize = length
        .parse()
        .ok()
        .filter(|length| *length <= 64)
        .ok_or_else(|| format!("`{length}` is not a valid length"))?;
    // Duration and length of the message come before the flags.
    let flags = data.get(length + 2);
    let flags = flags.map_or(Ok(0), |word| {
        u32::from_str_radix(word, 16).map_err(|_| format!("the flags `{word}` are not valid"))
    })?;
    if flags & FLAG_FD != 0 || *brs == "1" || length > 8 {
        return Err(FD.into());
    }
    let remote = flags & FLAG_REMOTE != 0;
    let dlc = if remote {
        u8::from_str_radix(dlc, 16).unwrap_or(0).min(8)
    } else {
        length as u8
    };
    let id = asc_id(&second, radix)?;
    let frame = frame(id, dlc, remote, data.iter().copied(), radix)?;
    Ok(Entry::Record(Record::received(at, frame).sent(sent)))
}
