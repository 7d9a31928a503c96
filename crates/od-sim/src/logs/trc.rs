//! PEAK TRC, versions 1.0 to 1.3, 2.0 and 2.1; also without its first lines.

use std::prelude::v1::*;

use od_wire::Instant;

use super::channel::Form;
use super::record::{BusError, Entry, FD, Reader, Record, frame, id};

/// Returns whether this line shows that the text is a TRC log.
pub(super) fn is_one(line: &str) -> bool {
    header(line, "FILEVERSION").is_some()
        || header(line, "STARTTIME").is_some()
        || numbered(line).is_some()
        || is_second(line)
}

/// States of the controller in the four bytes of a status: warning limit (`BUSHEAVY`), error passive, bus-off.
const STATES: [(u32, BusError); 3] = [
    (0x8, BusError::Warning),
    (0x4_0000, BusError::Passive),
    (0x10, BusError::BusOff),
];

/// The number of a state of the controller; `None`: an error frame.
pub(super) fn status(error: BusError) -> Option<u32> {
    let mut all = STATES.iter();
    all.find_map(|(bits, state)| (*state == error).then_some(*bits))
}

/// A status whose four bytes end a line, perhaps with a name after them: `… 00 00 00 08 BUSHEAVY`.
fn of_status(at: Instant, line: &str) -> Entry {
    let byte = |word: &str| {
        u8::from_str_radix(word, 16)
            .ok()
            .filter(|_| word.len() == 2)
    };
    let words: Vec<&str> = line.split_whitespace().collect();
    let mut fours = words.windows(4).rev();
    let bits = fours.find_map(|four| {
        let [a, b, c, d] = [
            byte(four[0])?,
            byte(four[1])?,
            byte(four[2])?,
            byte(four[3])?,
        ];
        Some(u32::from_be_bytes([a, b, c, d]))
    });
    let mut states = STATES.iter().rev();
    let state = states.find(|(state, _)| bits.is_some_and(|bits| bits & state != 0));
    state.map_or(Entry::Other, |(_, state)| {
        Entry::Record(Record::of(at, *state))
    })
}

/// Returns whether a line is one of version 2 with its usual columns, as in a log without its first lines:
/// `310     18274.059 DT     0605 Rx 8  40 …`.
fn is_second(line: &str) -> bool {
    let words: Vec<&str> = line.split_whitespace().take(5).collect();
    let [number, time, kind, _, "Rx" | "Tx"] = words[..] else {
        return false;
    };
    let is_kind = kind.len() == 2 && kind.bytes().all(|c| c.is_ascii_uppercase());
    is_kind && number.parse::<u64>().is_ok() && millis(time).is_some()
}

/// The value of `;$NAME=value`.
fn header<'t>(line: &'t str, name: &str) -> Option<&'t str> {
    let rest = line.trim_start().strip_prefix(";$")?;
    let (found, value) = rest.split_once('=')?;
    found.eq_ignore_ascii_case(name).then_some(value.trim())
}

/// The time in milliseconds of `1)  1059.9  …` as microseconds, and the rest of the line.
fn numbered(line: &str) -> Option<(Instant, impl Iterator<Item = &str>)> {
    let mut words = line.split_whitespace();
    let number = words.next()?.strip_suffix(')')?;
    number.parse::<u64>().ok()?;
    Some((millis(words.next()?)?, words))
}

fn millis(word: &str) -> Option<Instant> {
    // A program on a computer with another language writes a comma.
    let millis = word
        .replace(',', ".")
        .parse::<f64>()
        .ok()
        .filter(|at| at.is_finite() && *at >= 0.0)?;
    Some(Instant::from_micros((millis * 1000.0).round() as u64))
}

/// Where a line has the number of the bus: a column of version 2, and of the versions 1.2 and 1.3 the word after the time.
pub(super) fn form(lines: &[&str]) -> Form {
    let value = |name| lines.iter().find_map(|line| header(line, name));
    match value("FILEVERSION") {
        Some("1.2" | "1.3") => Form::Word(2),
        Some(version) if version.starts_with("2.") => {
            let columns = value("COLUMNS").unwrap_or(COLUMNS);
            let place = columns.split(',').position(|column| column.trim() == "B");
            place.map_or(Form::Other, Form::Word)
        }
        _ => Form::Other,
    }
}

pub(super) fn reader<'t>(lines: &[&'t str]) -> Reader<'t> {
    let version = lines.iter().find_map(|line| header(line, "FILEVERSION"));
    let (major, minor) = version
        .and_then(|text| text.split_once('.'))
        .unwrap_or_default();
    let is_cut = version.is_none() && lines.iter().any(|line| is_second(line));
    if major == "2" || is_cut {
        return second(lines);
    }
    let has_bus = minor.starts_with(['2', '3']);
    let has_reserved = minor.starts_with('3');
    let has_version = version.is_some();
    Box::new(move |line| {
        if line.trim_start().starts_with(';') {
            return Ok(Entry::Nothing);
        }
        let (at, words) = numbered(line).ok_or("the message number or the time is missing")?;
        let mut words = words.skip(usize::from(has_bus)).peekable();
        // Version 1.0 has no direction.
        let direction = words.next_if(|word| {
            let word = word.to_ascii_lowercase();
            ["rx", "tx", "warng", "error"]
                .iter()
                .any(|known| word.starts_with(known))
        });
        let direction = direction.unwrap_or_default().to_ascii_lowercase();
        if direction.starts_with("error") {
            return Ok(Entry::Record(Record::error(at)));
        }
        if direction.starts_with("warng") {
            return Ok(of_status(at, line));
        }
        let id = words.next().unwrap_or_default();
        let mut words: Vec<&str> = words.skip(usize::from(has_reserved)).collect();
        // Version 1.0 writes a change of the bus state like this.
        let is_status =
            !has_version && id.len() >= 4 && id.bytes().all(|c| c.eq_ignore_ascii_case(&b'f'));
        if is_status
            && words
                .first()
                .is_some_and(|word| word.trim_start_matches('0') == "4")
        {
            return Ok(of_status(at, line));
        }
        let remote = words
            .get(1)
            .is_some_and(|word| word.eq_ignore_ascii_case("RTR"));
        let length = if words.is_empty() {
            ""
        } else {
            words.remove(0)
        };
        let frame = Parts {
            id,
            length,
            remote,
            data: &words,
        }
        .frame()?;
        Ok(Entry::Record(
            Record::received(at, frame).sent(direction.starts_with("tx")),
        ))
    })
}

/// Columns of version 2 if the log names none.
const COLUMNS: &str = "N,O,T,I,d,l,D";

fn second<'t>(lines: &[&'t str]) -> Reader<'t> {
    let columns = lines.iter().find_map(|line| header(line, "COLUMNS"));
    let columns: Vec<&str> = columns
        .unwrap_or(COLUMNS)
        .split(',')
        .map(str::trim)
        .collect();
    let place = move |name: &str| columns.iter().position(|column| *column == name);
    Box::new(move |line| {
        if line.trim_start().starts_with(';') {
            return Ok(Entry::Nothing);
        }
        let words: Vec<&str> = line.split_whitespace().collect();
        let field = |name: &str| place(name).and_then(|at| words.get(at).copied());
        let at = field("O")
            .and_then(millis)
            .ok_or("the time offset is missing")?;
        let remote = match field("T").unwrap_or_default() {
            "ER" => return Ok(Entry::Record(Record::error(at))),
            "DT" => false,
            "RR" => true,
            "ST" => return Ok(of_status(at, line)),
            "EC" | "EV" => return Ok(Entry::Other),
            "FD" | "FB" | "FE" | "BI" => return Err(FD.into()),
            other => return Err(format!("`{other}` is not a valid type of message")),
        };
        let data = place("D")
            .and_then(|at| words.get(at..))
            .unwrap_or_default();
        let length = field("L").or_else(|| field("l")).unwrap_or_default();
        let id = field("I").unwrap_or_default();
        let frame = Parts {
            id,
            length,
            remote,
            data,
        }
        .frame()?;
        let sent = field("d").is_some_and(|word| word.to_ascii_lowercase().starts_with("tx"));
        Ok(Entry::Record(Record::received(at, frame).sent(sent)))
    })
}

/// Fields of all versions.
struct Parts<'t> {
    id: &'t str,
    length: &'t str,
    remote: bool,
    data: &'t [&'t str],
}

impl Parts<'_> {
    fn frame(&self) -> Result<od_wire::Frame, String> {
        let id = id(self.id, 16, self.id.len() > 4)?;
        let dlc = self.length.parse().ok().filter(|dlc| *dlc <= 8);
        let dlc = dlc.ok_or_else(|| format!("`{}` is not a valid length", self.length))?;
        frame(id, dlc, self.remote, self.data.iter().copied(), 16)
    }
}
