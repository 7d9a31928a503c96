//! Logs of programs that print a frame per line in columns: python-can (`print(message)`, `can_logger`), Kvaser CanKing,
//! Kvaser Memorator (text), BUSMASTER.

use std::prelude::v1::*;

use od_wire::Instant;

use super::channel::Form;
use super::record::{Entry, FD, Reader, Record, bases, frame, id};
use super::stamp;

/// Returns whether this line is one of python-can or BUSMASTER, or the line over the columns of CanKing or Memorator.
pub(super) fn is_one(line: &str) -> bool {
    is_printed(line) || is_head(line) || is_memorator(line) || is_busmaster(line)
}

/// Where a line has the name of the channel.
pub(super) fn form(lines: &[&str]) -> Form {
    let has = |is: fn(&str) -> bool| lines.iter().any(|line| is(line));
    if has(is_busmaster) {
        Form::Word(2)
    } else if has(is_memorator) {
        Form::Word(1)
    } else if has(is_head) {
        Form::Word(0)
    } else {
        Form::Printed
    }
}

/// Returns whether this line is a frame of BUSMASTER, whose head is often not pasted.
fn is_busmaster(line: &str) -> bool {
    let words: Vec<&str> = line.split_whitespace().take(6).collect();
    let [time, "Rx" | "Tx", channel, _, kind, _] = words[..] else {
        return false;
    };
    let is_number = |word: &str| word.bytes().all(|byte| byte.is_ascii_digit());
    time.split(':').filter(|part| is_number(part)).count() == 4
        && is_number(channel)
        && matches!(kind, "s" | "x" | "sr" | "xr")
}

/// Returns whether this line has the names of the columns of Memorator.
fn is_memorator(line: &str) -> bool {
    let words = ["Time", "Chan", "Identifier", "Flags", "DLC", "Data"];
    line.split_whitespace().take(6).eq(words)
}

/// Returns whether a line has a message of python-can, which its log puts after words of its own.
fn is_printed(line: &str) -> bool {
    let has = |name: &str| line.split_whitespace().any(|word| word == name);
    has("Timestamp:") && has("ID:") && line.split_whitespace().any(is_length)
}

/// Returns whether a word comes before the length; old versions of python-can print `DLC:`.
fn is_length(word: &str) -> bool {
    matches!(word, "DL:" | "DLC:")
}

fn is_head(line: &str) -> bool {
    let mut words = line.split_whitespace();
    words.next() == Some("Chn") && words.next() == Some("Identifier")
}

pub(super) fn reader<'t>(lines: &[&'t str]) -> Reader<'t> {
    let bases = bases(lines);
    if lines.iter().any(|line| is_busmaster(line)) {
        return busmaster(lines);
    }
    let is_from_memorator = lines.iter().any(|line| is_memorator(line));
    let mut is_begun = false;
    Box::new(move |line| {
        let line = line.trim();
        if is_from_memorator {
            let is_row = is_begun;
            is_begun |= is_memorator(line);
            // Lines about the logger come before the names, a line of `=` after them.
            if is_row && !line.starts_with("===") {
                memorator(line, bases)
            } else {
                Ok(Entry::Nothing)
            }
        } else if is_head(line) {
            Ok(Entry::Nothing)
        } else if is_printed(line) {
            printed(line)
        } else {
            canking(line)
        }
    })
}

/// `Timestamp: 1700000000.123456    ID: 0701    S Rx    DL:  1    00    '.'    Channel: can0`. The letters are `X` or `S`
/// (29 or 11 bits), `Rx` or `Tx`, `E` (error frame), `R` (remote frame), `F` (CAN FD).
fn printed(line: &str) -> Result<Entry, String> {
    let mut words = line.split_whitespace();
    let mut after = |name: &str| {
        words.find(|word| *word == name)?;
        words.next()
    };
    let at = after("Timestamp:").and_then(stamp::seconds);
    let at = Instant::from_micros(at.ok_or("the time is missing")?);
    let digits = after("ID:").unwrap_or_default();
    let mut words = line.split_whitespace().skip_while(|word| *word != "ID:");
    let flags: Vec<&str> = words
        .by_ref()
        .skip(2)
        .take_while(|word| !is_length(word))
        .collect();
    if flags.contains(&"E") {
        return Ok(Entry::Record(Record::error(at)));
    }
    if flags.contains(&"F") {
        return Err(FD.into());
    }
    let id = id(digits, 16, flags.contains(&"X"))?;
    let length = words.next().unwrap_or_default();
    let dlc = length
        .parse()
        .map_err(|_| format!("`{length}` is not a valid length"))?;
    let frame = frame(id, dlc, flags.contains(&"R"), words, 16)?;
    let sent = flags.contains(&"Tx");
    Ok(Entry::Record(Record::received(at, frame).sent(sent)))
}

/// `0    00000701    X    1  00    0.000000 R`: channel, CAN-ID, flags or none (`X` 29 bits, `R` remote frame), length, bytes,
/// seconds, direction.
fn canking(line: &str) -> Result<Entry, String> {
    let words: Vec<&str> = line.split_whitespace().collect();
    let is_number = |word: &&&str| word.bytes().all(|byte| byte.is_ascii_digit());
    let seconds = words.iter().rev().find(|word| word.contains('.'));
    let (Some(_), Some(seconds)) = (words.first().filter(is_number), seconds) else {
        // The program writes when logging began and ended.
        return Ok(Entry::Other);
    };
    let at = stamp::seconds(seconds).ok_or_else(|| format!("`{seconds}` is not a time"))?;
    let at = Instant::from_micros(at);
    if line.contains("ErrorFrame") {
        return Ok(Entry::Record(Record::error(at)));
    }
    let digits = words.get(1).copied().unwrap_or_default();
    let flags = words.get(2).filter(|word| !is_number(word));
    let rest = words.get(2 + usize::from(flags.is_some())..);
    let (length, data) = rest
        .and_then(<[_]>::split_first)
        .ok_or("the frame is cut")?;
    let has = |flag| flags.is_some_and(|flags| flags.contains(flag));
    let raw = digits.trim_start_matches('0');
    let id = id(if raw.is_empty() { "0" } else { raw }, 16, has('X'))?;
    let dlc = length
        .parse()
        .map_err(|_| format!("`{length}` is not a valid length"))?;
    let frame = frame(id, dlc, has('R'), data.iter().copied(), 16)?;
    let sent = words.last() == Some(&"T");
    Ok(Entry::Record(Record::received(at, frame).sent(sent)))
}

/// `0.100000  1       601    Rx        8  40 00 10 00 00 00 00 00   2`: seconds, channel, CAN-ID, `x` (29 bits), direction,
/// flags (`F` CAN FD, `R` remote frame), length, bytes, counter.
fn memorator(line: &str, [base, data_base]: [u32; 2]) -> Result<Entry, String> {
    let words: Vec<&str> = line.split_whitespace().collect();
    let Some(at) = words.first().and_then(|word| stamp::seconds(word)) else {
        // The time of day of the logger.
        return Ok(Entry::Other);
    };
    let at = Instant::from_micros(at);
    match words.get(1) {
        Some(&"Trigger") => return Ok(Entry::Other),
        _ if line.contains("ErrorFrame") => return Ok(Entry::Record(Record::error(at))),
        _ => {}
    }
    // The letter of a CAN-ID of 29 bits is a word of its own, or follows eight digits without a space.
    let word = words.get(2).copied().unwrap_or_default();
    let digits = word.trim_end_matches('x');
    let is_long = digits != word || words.get(3) == Some(&"x");
    let id = id(digits, base, is_long)?;
    let mut rest = words
        .iter()
        .copied()
        .skip(3)
        .skip_while(|word| *word == "x");
    let direction = rest.next().unwrap_or_default();
    let mut length = rest.next().unwrap_or_default();
    let mut flags = "";
    if !length.starts_with(|c: char| c.is_ascii_digit()) {
        (flags, length) = (length, rest.next().unwrap_or_default());
    }
    if flags.contains('F') {
        return Err(FD.into());
    }
    let dlc = length
        .parse()
        .map_err(|_| format!("`{length}` is not a valid length"))?;
    let frame = frame(id, dlc, flags.contains('R'), rest, data_base)?;
    let sent = direction.starts_with("Tx");
    Ok(Entry::Record(Record::received(at, frame).sent(sent)))
}

/// `17:02:30:4711 Rx 1 0x27F s 8 20 F4 6C 11 00 20 01 00`: time of day with 100 µs, or the time from the frame before, direction,
/// channel, CAN-ID, `s` (11 bits) or `x` (29 bits) and `r` (remote frame), length, bytes. The head names the base of the numbers.
fn busmaster<'t>(lines: &[&'t str]) -> Reader<'t> {
    let has = |word| lines.iter().any(|line| line.contains(word));
    let radix = if has("***DEC***") { 10 } else { 16 };
    let is_relative = has("***RELATIVE MODE***");
    let mut last = 0;
    Box::new(move |line| {
        if line.starts_with("***") {
            return Ok(Entry::Nothing);
        }
        let mut words = line.split_whitespace();
        let clock = words.next().unwrap_or_default();
        let (seconds, part) = clock.rsplit_once(':').unwrap_or_default();
        let time = stamp::time_of_day(&format!("{seconds}.{part}"));
        let time = time.ok_or_else(|| format!("`{clock}` is not a time"))?;
        last = if is_relative {
            time.saturating_add(last)
        } else {
            time
        };
        let words: Vec<&str> = words.collect();
        let [direction, _, digits, kind, length, data @ ..] = &words[..] else {
            return Ok(Entry::Other);
        };
        let digits = digits.strip_prefix("0x").unwrap_or(digits);
        let id = id(digits, radix, kind.starts_with('x'))?;
        let dlc = length
            .parse()
            .map_err(|_| format!("`{length}` is not a valid length"))?;
        let frame = frame(id, dlc, kind.ends_with('r'), data.iter().copied(), radix)?;
        let record = Record::received(Instant::from_micros(last), frame);
        Ok(Entry::Record(record.sent(*direction == "Tx")))
    })
}

#[cfg(test)]
mod tests {
    use crate::logs::{What, read};
    use std::format;
    use std::prelude::v1::*;

    fn told(text: &str) -> Vec<String> {
        let log = read(text.as_bytes()).expect("a log");
        let told = |what| match what {
            What::Frame(frame) => format!("{frame}"),
            What::Error(_) => "error".into(),
        };
        let records = log.records.iter().map(|record| {
            let sent = if record.sent { " sent" } else { "" };
            format!(
                "{} {}{sent}",
                record.at.as_micros() / 1000,
                told(record.what)
            )
        });
        let problems = log.skipped.iter().map(|problem| format!("{problem}"));
        records.chain(problems).collect()
    }

    #[test]
    fn a_printout_of_python_can_is_read() {
        let text = "\
Timestamp:        1.500000    ID:      701    S Rx                DL:  1    00                          Channel: 0
Timestamp:        1.600000        ID: 0601    S Tx                DL:  8    40 18 10 01 00 00 00 00     '@.......' Channel: can0
Timestamp:        1.700000    ID: 00000123    X Rx   R            DL:  0
Timestamp:        1.800000    ID: 00000000    S Rx E              DL:  0
Timestamp:        1.900000    ID: 0123    S Rx     F BS           DL: 12    00 00 00 00 00 00 00 00 00 00 00 00";
        assert_eq!(
            told(text),
            [
                "1500 701#00",
                "1600 601#4018100100000000 sent",
                "1700 00000123#R",
                "1800 error",
                "line 5: it is a CAN FD frame, and CANopen does not use CAN FD"
            ]
        );
    }

    /// Version 3 prints `DLC:`, and at the level DEBUG python-can writes each frame that it sends into a log.
    #[test]
    fn a_log_of_python_can_is_read() {
        let text = "\
DEBUG:canopen.sdo.client:Reading 0x1800:1 from node 1
DEBUG:can.socketcan.tx:sending: Timestamp:        0.000000        ID: 0601    S                DLC:  8    40 00 18 01 00 00 00 00
DEBUG:canopen.variable:Value of Transmit PDO Communication Parameter 1.COB-ID (0x1800:1) is 385";
        assert_eq!(told(text), ["0 601#4000180100000000"]);
    }

    #[test]
    fn the_text_of_kvaser_memorator_is_read_in_the_base_that_it_names() {
        let log = |base: &str, rows: &str| {
            format!(
                "                              Kvaser Memorator Log\n\nSettings:\n   Format of data field: {base}\n   \
                 Format of id field:   {base}\n   CAN channel:          1 2\n\n        Time Chan   Identifier Flags        DLC  \
                 Data                                   Counter\n==========\n    0.000000  Trigger (type=0x1, active=0x00)\n{rows}"
            )
        };
        let hex = "    1.500000  1         701    Rx           1  00                                     1\n    \
            1.600000  1         601    Tx           8  40 18 10 01 00 00 00 00                   2\n    \
            1.700000  2    18FF0001x   Rx           2  DE AD                                     3\n    \
            1.800000  1         181    Rx       R   2  RTR                                       4\n    \
            1.900000  1  ErrorFrame    Rx                ERROR FRAME                             5\n    \
            2.000000  1         181    Rx    F      9  00                                        6\n";
        assert_eq!(
            told(&log("HEX", hex)),
            [
                "1500 701#00",
                "1600 601#4018100100000000 sent",
                "1700 18FF0001#DEAD",
                "1800 181#R2",
                "1900 error",
                "line 16: it is a CAN FD frame, and CANopen does not use CAN FD"
            ]
        );
        let decimal = "    1.500000  1        1793    Rx           2  127   5                                1\n";
        assert_eq!(told(&log("DEC", decimal)), ["1500 701#7F05"]);
    }

    #[test]
    fn a_log_of_busmaster_is_read_in_the_base_and_the_times_that_it_names() {
        let rows = "17:02:30:4711 Rx 1 0x701 s 1 00 \n17:02:30:5711 Tx 1 0x601 s 8 40 18 10 01 00 00 00 00 \n\
            17:02:30:6711 Rx 2 0x00000123 x 0\n17:02:30:7711 Rx 1 0x701 sr 0\n17:02:61:0000 Rx 1 0x701 s 1 00\n";
        let expected = [
            "61350471 701#00",
            "61350571 601#4018100100000000 sent",
            "61350671 00000123#",
            "61350771 701#R",
        ];
        let read = told(rows);
        assert_eq!(read[..4], expected);
        assert_eq!(read[4], "line 5: `17:02:61:0000` is not a time");
        let head = "***BUSMASTER Ver 3.2.2***\n***DEC***\n***RELATIVE MODE***\n";
        let decimal = "00:00:00:5000 Rx 1 1793 s 2 127 5\n00:00:01:0000 Rx 1 1793 s 1 5\n";
        assert_eq!(
            told(&format!("{head}{decimal}")),
            ["500 701#7F05", "1500 701#05"]
        );
    }

    #[test]
    fn the_columns_of_canking_are_read() {
        let text = "\
Chn Identifier Flg   DLC  D0...1...2...3...4...5...6..D7       Time     Dir
 0    00000701         1  00                                   1.500000 R
 0    00000601         8  40  18  10  01  00  00  00  00       1.600000 T
 0    00000123 X       0                                       1.700000 R
 0    00000701  R      0                                       1.800000 R
 0    ErrorFrame                                               1.900000 R
Logging stopped.";
        assert_eq!(
            told(text),
            [
                "1500 701#00",
                "1600 601#4018100100000000 sent",
                "1700 00000123#",
                "1800 701#R",
                "1900 error"
            ]
        );
    }
}
