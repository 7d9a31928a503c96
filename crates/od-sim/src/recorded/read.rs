//! Reads the lines of a recording.

use std::format;
use std::prelude::v1::*;

use od_model::{Address, Refused, values};
use od_wire::emcy::Emcy;

use super::{BYTES, LINES, LONGEST, Recorded, VERSION};
use crate::grammar::duration;

/// The first line, and the start of the other lines.
const FIRST: &str = ";odkit-twin=";
const START: &str = ";twin ";

/// Reads the recording in the text of an EDS; `None` if it has no recording.
///
/// # Errors
/// The number of an invalid line, and its error.
pub fn read(text: &str) -> Result<Option<Recorded>, Refused> {
    let mut recorded: Option<Recorded> = None;
    let mut count = 0;
    for (number, line) in (1..).zip(text.lines()) {
        let line = line.trim();
        if let Some(version) = line.strip_prefix(FIRST) {
            if version.trim().parse() != Ok(VERSION) {
                return Err(format!(
                    "line {number}: version `{}` of a recording is not supported; this odkit reads \
                     version {VERSION}",
                    version.trim()
                )
                .into());
            }
            recorded.get_or_insert_default();
        } else if let Some(rest) = line.strip_prefix(START) {
            let Some(recorded) = &mut recorded else {
                return Err(
                    format!("line {number}: write `{FIRST}{VERSION}` before `{START}`").into(),
                );
            };
            count += 1;
            if count > LINES {
                return Err(format!("line {number}: a recording has at most {LINES} lines").into());
            }
            one(recorded, rest).map_err(|why| format!("line {number}: {why}"))?;
        }
    }
    if let Some(recorded) = &mut recorded {
        recorded.values.sort_by_key(|(at, ..)| *at);
        recorded.errors.sort_by_key(|(at, _)| *at);
    }
    Ok(recorded)
}

fn one(recorded: &mut Recorded, line: &str) -> Result<(), String> {
    let (word, rest) = line.split_once(' ').unwrap_or((line, ""));
    let mut words = rest.split_whitespace();
    let mut next = || words.next().unwrap_or_default();
    match word {
        "length" => recorded.length = time(next())?,
        "answer" => recorded.answer = time(next())?,
        "boot-up" => recorded.boot_up = Some(time(next())?),
        "heartbeat" => recorded.heartbeat = Some(period(next())?),
        "tpdo" => {
            let number = next();
            let valid = number
                .parse()
                .ok()
                .filter(|number| (1..=512).contains(number));
            let number = valid.ok_or_else(|| wrong(number, "a number of a TPDO, 1 to 512"))?;
            recorded.tpdos.insert(number, period(next())?);
        }
        "emcy" => {
            let at = time(next())?;
            let code = hex(next(), 0xFFFF)? as u16;
            let register = hex(next(), 0xFF)? as u8;
            let info = bytes(words)?;
            let info =
                <[u8; 5]>::try_from(info).map_err(|_| "an EMCY has 5 bytes of information")?;
            let error = Emcy {
                code,
                register,
                info,
            };
            recorded.errors.push((at, error));
            return Ok(());
        }
        "without" => {
            for service in words {
                match service {
                    "segments" => recorded.no_segments = true,
                    "blocks" => recorded.no_blocks = true,
                    _ => return Err(wrong(service, "segments or blocks")),
                }
            }
            return Ok(());
        }
        "empty" => {
            let address = object(next())?;
            let bytes = bytes(words)?;
            if bytes.len() > 4 {
                return Err("such a value has at most 4 bytes".into());
            }
            recorded.empty.insert(address, bytes);
            return Ok(());
        }
        "abort" => {
            let address = object(next())?;
            recorded.aborts.insert(address, hex(next(), u32::MAX)?);
        }
        "value" => {
            let address = object(next())?;
            let at = time(next())?;
            recorded.values.push((at, address, bytes(words)?));
            return Ok(());
        }
        _ => {
            return Err(wrong(
                word,
                "length, answer, boot-up, heartbeat, tpdo, emcy, without, empty, abort or value",
            ));
        }
    }
    match words.next() {
        None => Ok(()),
        Some(more) => Err(format!("`{more}` is not expected at the end of the line")),
    }
}

fn wrong(given: &str, expected: &str) -> String {
    format!("`{given}` is not valid; write {expected}")
}

/// `500us`, `20ms`, `10s`, in microseconds.
fn time(text: &str) -> Result<u64, String> {
    let valid = duration::parse(text).filter(|micros| *micros <= LONGEST);
    valid.ok_or_else(|| {
        wrong(
            text,
            "a time of at most 3600s, such as `500us`, `20ms` or `10s`",
        )
    })
}

/// A time between two frames, at least the duration of a frame.
fn period(text: &str) -> Result<u64, String> {
    let valid = time(text)?;
    match valid {
        100.. => Ok(valid),
        _ => Err(wrong(text, "a period of at least `100us`")),
    }
}

fn hex(text: &str, most: u32) -> Result<u32, String> {
    let digits = text.strip_suffix('h').unwrap_or_default();
    let valid = u32::from_str_radix(digits, 16)
        .ok()
        .filter(|number| *number <= most);
    valid.ok_or_else(|| wrong(text, "a hexadecimal number such as `1000h`"))
}

fn object(text: &str) -> Result<Address, String> {
    values::address(text).ok_or_else(|| wrong(text, "an object such as `6004h:00`"))
}

fn bytes<'t>(words: impl Iterator<Item = &'t str>) -> Result<Vec<u8>, String> {
    let mut bytes = Vec::new();
    for word in words {
        let valid = (word.len() == 2)
            .then(|| u8::from_str_radix(word, 16).ok())
            .flatten();
        bytes.push(valid.ok_or_else(|| wrong(word, "bytes such as `12 00`"))?);
        if bytes.len() > BYTES {
            return Err(format!("a value has at most {BYTES} bytes"));
        }
    }
    if bytes.is_empty() {
        Err("bytes such as `12 00` are missing".into())
    } else {
        Ok(bytes)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_written_recording_is_read_again() {
        let text = ";odkit-twin=1\n;twin length 10s\n;twin answer 400us\n;twin boot-up 1200ms\n\
                    ;twin heartbeat 990ms\n;twin tpdo 1 50ms\n\
                    ;twin emcy 20ms 1000h 01h 00 00 00 00 00\n;twin without segments blocks\n\
                    ;twin empty 1003h:01 00 00 00 00\n;twin abort 2100h:01 08000022h\n\
                    ;twin value 6004h:00 100ms 12 00 00 00\n";
        let recorded = read(text).expect("valid lines").expect("a recording");
        assert_eq!(recorded.boot_up, Some(1_200_000));
        assert_eq!(recorded.to_string(), text);
        assert_eq!(read("[1000]\n;a comment\n"), Ok(None));
    }

    #[test]
    fn a_line_that_is_not_valid_is_refused_in_words() {
        for (line, word) in [
            (";odkit-twin=2", "version `2`"),
            (";twin answer 1ms", "before `;twin `"),
            (";odkit-twin=1\n;twin answer 1h", "`1h`"),
            (";odkit-twin=1\n;twin answer 99999999999999999999s", "3600s"),
            (";odkit-twin=1\n;twin tpdo 513 1s", "512"),
            (";odkit-twin=1\n;twin heartbeat 0ms", "100us"),
            (";odkit-twin=1\n;twin emcy 1ms 1000h 01h 00", "5 bytes"),
            (";odkit-twin=1\n;twin abort 1h", "hexadecimal"),
            (";odkit-twin=1\n;twin value 6004h 1ms", "missing"),
            (";odkit-twin=1\n;twin value 6004h 1ms 1", "`1`"),
            (";odkit-twin=1\n;twin answer 1ms 2ms", "`2ms`"),
            (";odkit-twin=1\n;twin without bytes", "`bytes`"),
            (";odkit-twin=1\n;twin empty 1003h:01 1 2 3 4 5", "bytes"),
            (
                ";odkit-twin=1\n;twin empty 1003h:01 01 02 03 04 05",
                "4 bytes",
            ),
            (";odkit-twin=1\n;twin reply 1ms", "`reply`"),
        ] {
            let why = read(line).expect_err(line).to_string();
            assert!(why.contains(word), "{line}: {why}");
        }
        let many = ";odkit-twin=1\n".to_owned() + &";twin answer 1ms\n".repeat(LINES + 1);
        let why = read(&many).expect_err("too many").to_string();
        assert!(why.contains("at most"));
    }
}
