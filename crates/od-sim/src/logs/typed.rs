//! Frames as people type them in a question, or as programs print them in a log of their own, one in a line.
//!
//! | form | example |
//! |---|---|
//! | CAN-ID and bytes | `0x601: 40 00 10 00 00 00 00 00` |
//! | with a direction, a length, separators | `TX 601h \| 8 \| 40,00,10,00,00,00,00,00` |
//! | with names and a time | `12:01:02.5 ID=601 DLC=8 Data=4000100000000000` |
//! | `cansend` in other words | `[ERROR] [1.5]: EMCY received: 81#1082110000000000` |
//!
//! A line is a frame if it has a CAN-ID and then as many bytes as the length says, or 1 to 8. Other words, and a remark after
//! the frame, do not count. A CAN-ID with the flag of SocketCAN is an error message.

use std::format;
use std::prelude::v1::*;

use od_wire::{CanId, Frame, Instant};

use super::candump;
use super::record::{BusError, ERROR, Entry, Reader, Record, What};
use super::stamp;

/// Characters that separate pieces of a line.
const BETWEEN: &str = ",;:|=()[]<>{}\"'`.-_#";

/// A line with a frame.
struct Typed {
    /// Microseconds, if the line has a time.
    at: Option<u64>,
    sent: bool,
    /// `None`: an error message of SocketCAN that is no error.
    what: Option<What>,
}

/// Returns whether these lines have frames: half of them, or two and a quarter of them.
pub(super) fn is_one<'t>(lines: impl Iterator<Item = &'t str>) -> bool {
    let (mut all, mut frames) = (0, 0);
    for line in lines.filter(|line| !line.trim().is_empty()) {
        all += 1;
        frames += usize::from(typed(line).is_some());
    }
    frames > 0 && frames * 2 >= all || frames >= 2 && frames * 4 >= all
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
        let Some(Typed { at, sent, what }) = typed(line) else {
            return Err("no CAN-ID is followed by the bytes of a frame".into());
        };
        last = at.unwrap_or(last);
        Ok(what.map_or(Entry::Other, |what| {
            Entry::Record(Record {
                at: Instant::from_micros(last),
                sent,
                what,
            })
        }))
    })
}

fn typed(line: &str) -> Option<Typed> {
    let mut words = line.split_whitespace();
    let timed = words.find_map(|word| Some((word, time(word)?)));
    if let Some((word, at)) = timed {
        let start = word.as_ptr() as usize - line.as_ptr() as usize;
        let frame = untimed(&line[start + word.len()..]);
        let frame = frame.or_else(|| untimed(&line[..start]))?;
        return Some(Typed {
            at: Some(at),
            ..frame
        });
    }
    untimed(line)
}

/// A time of day, or seconds with a decimal point, in microseconds.
fn time(word: &str) -> Option<u64> {
    let word = word.trim_matches(|c: char| "()[]:,;".contains(c));
    let has_point = || word.contains('.') && !word.ends_with('.');
    let seconds = || stamp::seconds(word).filter(|_| has_point());
    stamp::time_of_day(word).or_else(seconds)
}

fn untimed(line: &str) -> Option<Typed> {
    let mut words = line.split_whitespace();
    if let Some(what) = words.find_map(hash) {
        return Some(Typed {
            at: None,
            sent: false,
            what,
        });
    }
    let mut pieces = pieces(line).peekable();
    let mut sent = false;
    let mut is_sent = |word: &str| sent |= ["tx", "send", "sent"].contains(&&*word.to_lowercase());
    let (id, mut is_remote) = loop {
        let piece = pieces.next()?;
        if let Some(id) = id(piece.text).or_else(|| piece.short_id()) {
            break (id, false);
        }
        if let Some(id) = piece.text.strip_suffix('R').and_then(id) {
            break (id, true);
        }
        is_sent(piece.text);
    };
    let mut length = None;
    while let Some(piece) = pieces.peek().copied() {
        let word = piece.text;
        if length.is_none()
            && let Some(own) = piece.length(pieces.clone().skip(1))
        {
            length = Some(own);
        } else if byte(word).is_some() || word.len() > 2 && bytes(word).is_some() {
            break;
        } else {
            let digit = word.parse::<u8>().ok().filter(|_| word.len() == 1);
            length = digit.filter(|length| *length <= 8).or(length);
            let is_named = ["rtr", "remote"].contains(&&*word.to_lowercase());
            is_remote |= is_named && !piece.is_denied();
            is_sent(word);
        }
        pieces.next();
    }
    let what = match id {
        Id::Frame(id) if is_remote => Some(What::Frame(Frame::remote(id, length.unwrap_or(0))?)),
        Id::Frame(id) => Some(What::Frame(Frame::new(id, &data(pieces, length)?)?)),
        Id::Error(id) => {
            let data = data(pieces, Some(8))?.try_into().ok()?;
            BusError::of_socketcan(id, data).map(What::Error)
        }
    };
    Some(Typed {
        at: None,
        sent,
        what,
    })
}

/// Reads `81#1082110000000000`, also with fewer than three digits before `#`.
fn hash(word: &str) -> Option<Option<What>> {
    let (id, data) = word.split_once('#').filter(|(id, _)| !id.is_empty())?;
    let text = format!("{id:0>3}#{data}");
    Some(candump::logged(&text).ok()?.what())
}

/// A word between separators.
#[derive(Clone, Copy)]
struct Piece<'t> {
    text: &'t str,
    before: &'t str,
    after: &'t str,
}

/// The pieces of a line, without the index in a name such as `Data[0..7]`.
fn pieces(line: &str) -> impl Iterator<Item = Piece<'_>> + Clone {
    let is_between = |c: char| c.is_whitespace() || BETWEEN.contains(c);
    let texts = line.split(is_between).filter(|text| !text.is_empty());
    let pieces = texts.map(move |text| {
        let at = text.as_ptr() as usize - line.as_ptr() as usize;
        Piece {
            text,
            before: &line[..at],
            after: &line[at + text.len()..],
        }
    });
    pieces.filter(|piece| !piece.is_index())
}

impl Piece<'_> {
    /// Returns whether it is the name or the index of a byte, in `Data[0..7]` or `Data[0]=40`.
    fn is_index(&self) -> bool {
        let is_letter = |text: &str| text.ends_with(char::is_alphabetic);
        let begins = self.before.strip_suffix('[').is_some_and(is_letter);
        let ends = self.after.starts_with("..") || self.after.starts_with(']');
        let is_range = self.before.ends_with("..") && self.after.starts_with(']');
        let is_number = matches!(self.text.as_bytes(), [b'0'..=b'7']);
        let mut after = self.after.chars();
        let is_name = is_letter(self.text)
            && after.next() == Some('[')
            && matches!(after.next(), Some('0'..='7'))
            && matches!(after.next(), Some(']' | '.'));
        is_name || is_number && (begins && ends || is_range)
    }

    /// Returns whether the value of a field is no: `RTR = NO`, `rtr: 0`.
    fn is_denied(&self) -> bool {
        let value = self.after.trim_start().strip_prefix(['=', ':']);
        let value = value.map(|value| value.trim_start().to_lowercase());
        value.is_some_and(|value| ["no", "0", "false"].iter().any(|no| value.starts_with(no)))
    }

    /// A CAN-ID of two marked digits, which could be a byte: a separator follows.
    fn short_id(&self) -> Option<Id> {
        let digits = marked(self.text).filter(|digits| digits.len() == 2)?;
        let raw = u16::from_str_radix(digits, 16).ok()?;
        let is_apart =
            self.after.starts_with(':') || self.after.trim_start().starts_with(['|', '[']);
        is_apart.then_some(Id::Frame(CanId::standard(raw)))
    }

    /// The length of a frame in two digits, as in `000 | 02 | 01 05`: separators enclose it, and as many bytes follow.
    fn length(&self, rest: impl Iterator<Item = Self> + Clone) -> Option<u8> {
        let length: u8 = self.text.parse().ok().filter(|_| self.text.len() == 2)?;
        let begins = self.before.trim_end().ends_with(['|', '[', '(']);
        let is_enclosed = begins && self.after.trim_start().starts_with(['|', ']', ')']);
        let is_remote = || {
            let next = rest.clone().next();
            next.is_some_and(|next| next.text.eq_ignore_ascii_case("rtr"))
        };
        let count = || {
            rest.clone()
                .take_while(|next| byte(next.text).is_some())
                .count()
        };
        let follow = || is_remote() || count() >= length.into();
        // A frame does not have nine bytes.
        let is_first = || length == 8 && count() == 8;
        (length <= 8 && (is_enclosed && follow() || is_first())).then_some(length)
    }
}

/// The bytes of a frame: in one word, or in a word each, as many as `length` says.
fn data<'t>(
    mut pieces: core::iter::Peekable<impl Iterator<Item = Piece<'t>>>,
    length: Option<u8>,
) -> Option<Vec<u8>> {
    let together = pieces.peek().filter(|piece| piece.text.len() > 2);
    if let Some(data) = together.and_then(|piece| bytes(piece.text)) {
        return Some(data)
            .filter(|data| length.is_none_or(|length| usize::from(length) == data.len()));
    }
    let most = usize::from(length.unwrap_or(9));
    let found = pieces.map_while(|piece| byte(piece.text));
    let found: Vec<u8> = found.take(most).collect();
    let is_whole = match length {
        Some(_) => found.len() == most,
        None => (1..=8).contains(&found.len()),
    };
    is_whole.then_some(found)
}

/// A CAN-ID.
enum Id {
    Frame(CanId),
    /// The classes of an error message of SocketCAN.
    Error(u32),
}

/// A CAN-ID: three or eight hexadecimal digits, or any number of them after `0x` or before `h`. Four digits of a larger
/// number are the index of an object.
fn id(word: &str) -> Option<Id> {
    let marked = marked(word);
    let digits = marked.unwrap_or(word);
    let is_one = match marked {
        Some(digits) => digits.len() > 2,
        None => digits.len() == 3 || digits.len() == 8,
    };
    let is_one = is_one && digits.bytes().all(|digit| digit.is_ascii_hexdigit());
    let raw = u32::from_str_radix(digits, 16).ok().filter(|_| is_one)?;
    match raw {
        0..=0x7FF if digits.len() < 8 => Some(Id::Frame(CanId::standard(raw as u16))),
        0x800..=0x1FFF_FFFF if digits.len() > 4 => Some(Id::Frame(CanId::extended(raw))),
        _ if marked.is_some() && digits.len() == 8 && raw & ERROR != 0 => Some(Id::Error(raw)),
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
    use crate::logs::{BusError, Log, What, read};
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
            "601 [08] 40 00 10 00 00 00 00 00",
            "SDO 601 | 08 | 40 00 10 00 | 00 00 00 00 reads the device type",
            "| 601 | 40 00 10 00 00 00 00 00 | read 0x1000 = 0x000F0191 |",
            "ID = 0x601, Data[0..7]: 0x40, 0x00, 0x10, 0x00, 0x00, 0x00, 0x00, 0x00 (can0)",
            "ID=0x601 Data[0]=0x40 Data[1]=0x00 Data[2]=0x10 Data[3]=0x00 Data[4]=0x00 Data[5]=0x00 Data[6]=0x00 Data[7]=0x00",
            "driver: frame 601#4000100000000000 was queued",
        ] {
            let log = read(text.as_bytes()).unwrap_or_else(|why| panic!("{text}: {why}"));
            assert_eq!(shown(&log), ["601#4000100000000000"], "{text}");
            assert!(log.lacks_times && log.skipped.is_empty(), "{text}");
        }
    }

    #[test]
    fn short_remote_and_long_frames_are_read() {
        let text = "Tx 0x000: 01 05\n0x701: 05\n80h 0\n80h | 01\n85h: 10 82 11 00 00 00 00 00\n0x181 DLC 0\n701 RTR 1\n18FF1234 8 01 02 03 04 05 06 07 08\n";
        let log = read(text.as_bytes()).expect("a log");
        let frames = [
            "> 000#0105",
            "701#05",
            "080#01",
            "085#1082110000000000",
            "181#",
            "701#R1",
            "18FF1234#0102030405060708",
        ];
        assert_eq!(shown(&log), frames);
        assert_eq!(log.skipped.len(), 1, "`80h` could be a byte");
    }

    /// A manual writes the length with two digits and marks remote frames.
    #[test]
    fn a_length_of_two_digits_is_no_byte() {
        let text = "Send 000 | 02 | 01 05\nReceive 705 | 01 | 05\nSend 185 | 00 | RTR\nReceive 185 | 04 | 11 22 | 33 44 position\n\
            705R | DLC=0\n705 | 85\n201 | 02 11\n301 02 11 22\n";
        let log = read(text.as_bytes()).expect("a log");
        let frames = [
            "000#0105",
            "705#05",
            "185#R",
            "185#11223344",
            "705#R",
            "705#85",
            "201#0211",
            "301#021122",
        ];
        let shown = shown(&log).into_iter().map(|line| line.replace("> ", ""));
        assert_eq!(shown.collect::<Vec<_>>(), frames);
    }

    /// A test tool writes date, time, channel and names around each frame.
    #[test]
    fn neither_a_date_nor_an_index_is_a_can_id() {
        let text = "26.11.28 : 15:47:14.042 : Test CAN : CAN1  605 Tx SD  8  40 01 10 00 00 00 00 00\n\
            26.11.28 : 15:47:14.106 : Test CAN : CAN1  585 Rx SD  8  4F 01 10 00 10 00 00 00\n\
            26.11.28 : 15:47:14.107 : Test Error : object 1001h:00h - response 0x10, EDS default value 0x00\n\
            1. object 1014h:00h\n    line 2: (001.250000) read 1001h 00";
        let log = read(text.as_bytes()).expect("a log");
        assert_eq!(
            shown(&log),
            [
                "56834042 > 605#4001100000000000",
                "56834106 585#4F01100010000000"
            ]
        );
        assert_eq!(log.skipped.len(), 3, "{:?}", log.skipped);
    }

    #[test]
    fn frames_that_a_driver_prints_in_its_log_are_read() {
        let text = "[ERROR] [1795621801.250000000]: EMCY received: 85#1082110000000000\n\
            [ WARN] [1795621801.300000000]: error: 20000004#0030000000000000\n\
            [ INFO] [1795621801.400000000]: no response\n\
            [ WARN] [1795621801.500000000]: error ID: 0x20000040, Data[0..7]: 0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00\n\
            [ WARN] [1795621801.600000000]: error: 20000002#0300000000000000\n";
        let log = read(text.as_bytes()).expect("a log");
        let records: Vec<_> = log
            .records
            .iter()
            .map(|record| (record.at.as_micros(), record.what))
            .collect();
        let [(0, What::Frame(_)), passive, off] = records[..] else {
            panic!("{records:?}");
        };
        assert_eq!(passive, (50_000, What::Error(BusError::Passive)));
        assert_eq!(off, (250_000, What::Error(BusError::BusOff)));
        assert_eq!(
            (log.skipped.len(), log.others),
            (1, 1),
            "lost arbitration is no error"
        );
    }

    #[test]
    fn a_time_of_day_or_seconds_may_stand_before_a_frame() {
        for (text, times) in [
            (
                "line 1: (000.000000) can0  601  [8]  40 00 10 00 00 00 00 00\nline 2: (000.003000) can0  581  [8]  43 00 10 00 91 01 0F 00",
                [0, 3],
            ),
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
