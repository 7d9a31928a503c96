//! Frames as people type them in a question, one in a line.
//!
//! | form | example |
//! |---|---|
//! | CAN-ID and bytes | `0x601: 40 00 10 00 00 00 00 00` |
//! | with a direction, a length, separators | `TX 601h \| 8 \| 40,00,10,00,00,00,00,00` |
//! | with names and a time | `12:01:02.5 ID=601 DLC=8 Data=4000100000000000` |
//!
//! A line is a frame if it has a CAN-ID and then as many bytes as the length says, or 1 to 8. Other words, and a remark after
//! the frame, do not count.

use std::prelude::v1::*;

use od_wire::{CanId, Frame, Instant};

use super::record::{Entry, Reader, Record, What};
use super::stamp;

/// Characters that separate words.
const BETWEEN: &str = ",;:|=()[]<>{}\"'`.-_#";

/// A line with a frame.
struct Typed {
    /// Microseconds, if the line has a time.
    at: Option<u64>,
    sent: bool,
    frame: Frame,
}

/// Returns whether most of these lines are frames.
pub(super) fn is_one<'t>(lines: impl Iterator<Item = &'t str>) -> bool {
    let (mut all, mut frames) = (0, 0);
    for line in lines.filter(|line| !line.trim().is_empty()) {
        all += 1;
        frames += usize::from(typed(line).is_some());
    }
    frames * 2 > all
}

/// Returns whether no frame has a time.
pub(super) fn is_untimed(lines: &[&str]) -> bool {
    let mut frames = lines.iter().filter_map(|line| typed(line));
    frames.all(|line| line.at.is_none())
}

/// Reads such lines. A frame without a time has that of the frame before.
pub(super) fn reader<'t>() -> Reader<'t> {
    let mut last = 0;
    Box::new(move |line| {
        let Some(Typed { at, sent, frame }) = typed(line) else {
            return Err("no CAN-ID is followed by the bytes of a frame".into());
        };
        last = at.unwrap_or(last);
        Ok(Entry::Record(Record {
            at: Instant::from_micros(last),
            sent,
            what: What::Frame(frame),
        }))
    })
}

fn typed(line: &str) -> Option<Typed> {
    let (at, line) = timed(line);
    let mut words = line
        .split(|c: char| c.is_whitespace() || BETWEEN.contains(c))
        .filter(|word| !word.is_empty())
        .peekable();
    let mut sent = false;
    let mut is_sent = |word: &str| sent |= ["tx", "send", "sent"].contains(&&*word.to_lowercase());
    let id = loop {
        let word = words.next()?;
        if let Some(id) = id(word) {
            break id;
        }
        is_sent(word);
    };
    let (mut length, mut is_remote) = (None, false);
    while let Some(word) = words.peek().filter(|word| byte(word).is_none()) {
        let digit = word.parse::<u8>().ok().filter(|_| word.len() == 1);
        length = digit.filter(|length| *length <= 8).or(length);
        is_remote |= ["rtr", "remote"].contains(&&*word.to_lowercase());
        is_sent(word);
        if word.len() > 2 && bytes(word).is_some() {
            break;
        }
        words.next();
    }
    let frame = if is_remote {
        Frame::remote(id, length.unwrap_or(0))?
    } else {
        Frame::new(id, &data(&mut words, length)?)?
    };
    Some(Typed { at, sent, frame })
}

/// The bytes of a frame: in one word, or in a word each, as many as `length` says.
fn data<'t>(
    words: &mut core::iter::Peekable<impl Iterator<Item = &'t str>>,
    length: Option<u8>,
) -> Option<Vec<u8>> {
    let together = words.peek().filter(|word| word.len() > 2);
    if let Some(data) = together.and_then(|word| bytes(word)) {
        return Some(data)
            .filter(|data| length.is_none_or(|length| usize::from(length) == data.len()));
    }
    let most = usize::from(length.unwrap_or(9));
    let found: Vec<u8> = words.map_while(byte).take(most).collect();
    let is_whole = match length {
        Some(_) => found.len() == most,
        None => (1..=8).contains(&found.len()),
    };
    is_whole.then_some(found)
}

/// The time at the front of a line, in microseconds, and the rest: a time of day, or seconds with a decimal point.
fn timed(line: &str) -> (Option<u64>, &str) {
    let line = line.trim_start();
    let (word, rest) = line.split_once(char::is_whitespace).unwrap_or((line, ""));
    let word = word.trim_matches(|c: char| "()[]".contains(c));
    let seconds = || stamp::seconds(word).filter(|_| word.contains('.'));
    match stamp::time_of_day(word).or_else(seconds) {
        Some(at) => (Some(at), rest),
        None => (None, line),
    }
}

/// A CAN-ID: three or eight hexadecimal digits, or any number of them after `0x` or before `h`.
fn id(word: &str) -> Option<CanId> {
    let marked = marked(word);
    let digits = marked.unwrap_or(word);
    let is_one = match marked {
        Some(digits) => digits.len() > 2,
        None => digits.len() == 3 || digits.len() == 8,
    };
    let is_one = is_one && digits.bytes().all(|digit| digit.is_ascii_hexdigit());
    let raw = u32::from_str_radix(digits, 16).ok().filter(|_| is_one)?;
    match raw {
        0..=0x7FF if digits.len() < 8 => Some(CanId::standard(raw as u16)),
        0x800..=0x1FFF_FFFF if digits.len() > 3 => Some(CanId::extended(raw)),
        _ => None,
    }
}

/// The digits of a word that says that they are hexadecimal.
fn marked(word: &str) -> Option<&str> {
    word.strip_prefix("0x")
        .or_else(|| word.strip_prefix("0X"))
        .or_else(|| word.strip_suffix(['h', 'H']))
}

/// A byte: two hexadecimal digits, or one or two that are marked.
fn byte(word: &str) -> Option<u8> {
    let marked = marked(word);
    let digits = marked.unwrap_or(word);
    let is_one = digits.len() == 2 || marked.is_some() && digits.len() == 1;
    u8::from_str_radix(digits, 16)
        .ok()
        .filter(|_| is_one && !digits.starts_with('+'))
}

/// Two to eight bytes in one word.
fn bytes(word: &str) -> Option<Vec<u8>> {
    let digits = marked(word).unwrap_or(word);
    let is_right = digits.bytes().all(|digit| digit.is_ascii_hexdigit())
        && digits.len().is_multiple_of(2)
        && (4..=16).contains(&digits.len());
    let pairs = (0..digits.len()).step_by(2);
    is_right.then(|| {
        pairs
            .filter_map(|at| u8::from_str_radix(&digits[at..at + 2], 16).ok())
            .collect()
    })
}

#[cfg(test)]
mod tests {
    use crate::logs::{Log, What, read};
    use std::prelude::v1::*;

    /// Direction and frame of each record, with its time in milliseconds if the log has times.
    fn shown(log: &Log) -> Vec<String> {
        let line = |record: &crate::logs::Record| {
            let What::Frame(frame) = record.what else {
                return String::from("error");
            };
            let time = if log.lacks_times {
                String::new()
            } else {
                format!("{} ", record.at.as_micros() / 1000)
            };
            format!("{time}{}{frame}", if record.sent { "> " } else { "" })
        };
        log.records.iter().map(line).collect()
    }

    #[test]
    fn a_request_is_read_as_people_type_it() {
        for text in [
            "0x601: 40 00 10 00 00 00 00 00",
            "ID: 0x601, DLC: 8, Data: 40 00 10 00 00 00 00 00",
            "601 8 40 00 10 00 00 00 00 00",
            "RX 601h 40 00 10 00 00 00 00 00",
            "601 | 40 00 10 00 00 00 00 00",
            "0x601 0x40 0x0 0x10 0x00 0x00 0x00 0x00 0x00",
            "Message: 601 (8) 40,00,10,00,00,00,00,00",
            "COB-ID=0x601 data=40-00-10-00-00-00-00-00  read 1000h",
            "1\t601h\tRx\t8\t40 00 10 00 00 00 00 00",
            "id 601 data 4000100000000000",
            "601: 0x4000100000000000",
            "master asks 0x601 [8] 40.00.10.00.00.00.00.00 # and waits",
        ] {
            let log = read(text.as_bytes()).unwrap_or_else(|why| panic!("{text}: {why}"));
            assert_eq!(shown(&log), ["601#4000100000000000"], "{text}");
            assert!(log.lacks_times && log.skipped.is_empty(), "{text}");
        }
    }

    #[test]
    fn short_remote_and_long_frames_are_read() {
        let text = "Tx 0x000: 01 05\n0x701: 05\n80h 0\n0x181 DLC 0\n701 RTR 1\n18FF1234 8 01 02 03 04 05 06 07 08\n";
        let log = read(text.as_bytes()).expect("a log");
        let frames = [
            "> 000#0105",
            "701#05",
            "181#",
            "701#R1",
            "18FF1234#0102030405060708",
        ];
        assert_eq!(shown(&log), frames);
        assert_eq!(log.skipped.len(), 1, "the CAN-ID 80h has two digits");
    }

    #[test]
    fn a_time_of_day_or_seconds_may_stand_before_a_frame() {
        for (text, times) in [
            (
                "12:01:02.123  601  [8]  40 00 10 00 00 00 00 00\n12:01:02.125  581  [8]  43 00 10 00 91 01 0F 00",
                [43_262_123, 43_262_125],
            ),
            (
                "[0.010] ID 601: 40 00 10 00 00 00 00 00\n[0.012] ID 581: 43 00 10 00 91 01 0F 00",
                [10, 12],
            ),
        ] {
            let log = read(text.as_bytes()).expect("a log");
            let [request, response] = times;
            let frames = [
                format!("{request} 601#4000100000000000"),
                format!("{response} 581#4300100091010F00"),
            ];
            assert_eq!(shown(&log), frames, "{text}");
        }
    }

    #[test]
    fn other_text_is_not_a_log() {
        for text in [
            "The node does not respond to 0x601.\nI send 40 00 10 00.\n0x601: 40 00 10 00 00 00 00 00",
            "0x601: 40 00 10 00 00 00 00 00 00",
            "0x601 [8] 40 00",
            "0x601",
            "601 8 4000",
            "100 200 300",
            "fee 12 34",
            "+12 34 56",
        ] {
            assert!(read(text.as_bytes()).is_err(), "{text}");
        }
    }
}
