//! Logs that an adapter or a command line tool writes: lines of slcan, messages of socketcand, `candump` of the
//! older `canutils`, the packet list of tshark.

use std::prelude::v1::*;

use od_wire::{CanId, Frame, Instant};

use super::record::{Entry, FD, Reader, Record, frame, id};
use super::stamp;
use crate::links::slcan;

/// A form of such a log.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Form {
    /// `t18121122`, and `t181211220123` with a time stamp in milliseconds.
    Slcan,
    /// `< frame 181 1.500000 1122 >`.
    Socketcand,
    /// `<0x181> [2] 11 22`.
    Canutils,
    /// `1   0.000000   →   CAN 16 STD: 0x00000181   11 22`.
    Tshark,
}

impl Form {
    /// The form of a line that is a frame, if it is one of these.
    fn of(line: &str) -> Option<Self> {
        let line = line.trim();
        if is_slcan(line) {
            Some(Self::Slcan)
        } else if line.starts_with("< frame ") {
            Some(Self::Socketcand)
        } else if line.starts_with("<0x") && line.contains("> [") {
            Some(Self::Canutils)
        } else if IDS.iter().any(|name| line.contains(name)) {
            Some(Self::Tshark)
        } else {
            None
        }
    }
}

/// Words before the CAN-ID in the packet list of tshark: 11 bits, 29 bits.
const IDS: [&str; 2] = [" STD: 0x", " XTD: 0x"];

/// Returns whether a line is a frame of slcan; two letters could also be a word.
fn is_slcan(line: &str) -> bool {
    slcan::frame_of(line.as_bytes()).is_some()
}

/// Returns whether this line shows that the text is such a log.
pub(super) fn is_one(line: &str) -> bool {
    Form::of(line).is_some()
}

/// Returns whether a line is a frame without a time.
pub(super) fn is_untimed(line: &str) -> bool {
    let line = line.trim();
    match Form::of(line) {
        Some(Form::Slcan) => slcan::stamp_of(line.as_bytes()).is_none(),
        Some(Form::Canutils) => true,
        Some(Form::Socketcand | Form::Tshark) | None => false,
    }
}

/// Milliseconds after which the time stamps of slcan begin again.
const MINUTE: u64 = 60_000;

pub(super) fn reader<'t>() -> Reader<'t> {
    let (mut last, mut minutes) = (0, 0);
    Box::new(move |line| {
        let line = line.trim();
        match Form::of(line) {
            Some(Form::Slcan) => {
                let stamp = slcan::stamp_of(line.as_bytes()).map_or(last, u64::from);
                minutes += u64::from(stamp < last);
                last = stamp;
                let at = Instant::from_micros((minutes * MINUTE + stamp) * 1000);
                let frame = slcan::frame_of(line.as_bytes()).ok_or("the frame is cut")?;
                Ok(Entry::Record(Record::received(at, frame)))
            }
            Some(Form::Socketcand) => socketcand(line),
            Some(Form::Canutils) => canutils(line),
            Some(Form::Tshark) => tshark(line),
            None if is_cut(line) => Err(format!("`{line}` is not a whole frame of slcan")),
            None if line.starts_with(['d', 'D', 'b', 'B']) && is_long(line) => Err(FD.into()),
            // Commands and responses of the adapter, the head of the tool.
            None => Ok(Entry::Other),
        }
    })
}

/// Returns whether a line begins as a frame of slcan does, and is not one.
fn is_cut(line: &str) -> bool {
    line.starts_with(['t', 'T', 'r', 'R']) && is_long(line)
}

/// Returns whether a line is a letter and at least three hex digits.
fn is_long(line: &str) -> bool {
    let digits = line.get(1..).unwrap_or_default();
    digits.len() >= 3 && digits.bytes().all(|digit| digit.is_ascii_hexdigit())
}

/// `< frame 181 1.500000 1122 >`; some versions write a blank after each byte.
fn socketcand(line: &str) -> Result<Entry, String> {
    let inner = line.trim_start_matches('<').trim_end_matches('>');
    let mut words = inner.split_whitespace().skip(1);
    let (digits, time) = (words.next(), words.next().and_then(stamp::seconds));
    let (Some(digits), Some(at)) = (digits, time) else {
        return Err("the CAN-ID or the time is missing".into());
    };
    let data: String = words.collect();
    let id = id(digits, 16, digits.len() > 3)?;
    let frame = packed(id, &data)?;
    Ok(Entry::Record(Record::received(
        Instant::from_micros(at),
        frame,
    )))
}

/// `<0x181> [2] 11 22`, `<0x181> [1] remote request`.
fn canutils(line: &str) -> Result<Entry, String> {
    let cut = "a frame such as `<0x181> [2] 11 22` is cut";
    let (digits, rest) = line
        .strip_prefix("<0x")
        .and_then(|rest| rest.split_once("> ["))
        .ok_or(cut)?;
    let (length, data) = rest.split_once(']').ok_or(cut)?;
    let id = id(digits, 16, digits.len() > 3)?;
    let dlc = length
        .trim()
        .parse()
        .map_err(|_| format!("`{length}` is not a valid length"))?;
    let remote = data.contains("remote");
    let frame = frame(id, dlc, remote, data.split_whitespace(), 16)?;
    Ok(Entry::Record(Record::received(Instant::ZERO, frame)))
}

/// `1   0.000000   →   CAN 16 STD: 0x00000181   11 22`: number, seconds, addresses, protocol, length, CAN-ID, bytes.
fn tshark(line: &str) -> Result<Entry, String> {
    let mut words = line.split_whitespace();
    let time = words.nth(1).and_then(stamp::seconds);
    let at = Instant::from_micros(time.ok_or("the time in seconds is missing")?);
    let place = IDS.iter().find_map(|name| {
        let (_, rest) = line.split_once(name)?;
        Some((rest, *name == IDS[1]))
    });
    let (rest, is_long) = place.ok_or("the CAN-ID is missing")?;
    let (digits, data) = rest.split_once(char::is_whitespace).unwrap_or((rest, ""));
    let id = id(digits, 16, is_long)?;
    let data: String = data.split_whitespace().collect();
    let frame = packed(id, &data)?;
    Ok(Entry::Record(Record::received(at, frame)))
}

/// A frame of hex digits without blanks.
fn packed(id: CanId, data: &str) -> Result<Frame, String> {
    let pairs: Option<Vec<&str>> = (0..data.len())
        .step_by(2)
        .map(|at| data.get(at..at + 2))
        .collect();
    let pairs = pairs.ok_or_else(|| format!("`{data}` is not a number of bytes"))?;
    let dlc = u8::try_from(pairs.len()).unwrap_or(u8::MAX);
    frame(id, dlc, false, pairs.into_iter(), 16)
}

#[cfg(test)]
mod tests {
    use crate::logs::{What, read};
    use std::format;
    use std::prelude::v1::*;

    /// Times in milliseconds and frames, problems, number of other entries, whether times are missing.
    fn told(text: &str) -> (Vec<String>, usize, bool) {
        let log = read(text.as_bytes()).expect("a log");
        let records = log.records.iter().map(|record| match record.what {
            What::Frame(frame) => format!("{} {frame}", record.at.as_micros() / 1000),
            What::Error(_) => "error".into(),
        });
        let problems = log.skipped.iter().map(|problem| format!("{problem}"));
        (
            records.chain(problems).collect(),
            log.others,
            log.lacks_times,
        )
    }

    #[test]
    fn lines_of_slcan_are_read() {
        let text = "V1013\rt70110004D2\rt6018401810010000000004D3\rT000000012AABB04D4\rr7011EA5F\rt701105000A\r\
                    t7011\rd1819\rz\r";
        let (lines, others, lacks_times) = told(text);
        let wanted = [
            "1234 701#00",
            "1235 601#4018100100000000",
            "1236 00000001#AABB",
            "59999 701#R1",
            "60010 701#05",
            "line 7: `t7011` is not a whole frame of slcan",
            "line 8: it is a CAN FD frame, and CANopen does not use CAN FD",
        ];
        assert_eq!(lines, wanted);
        assert_eq!((others, lacks_times), (2, false));
        let (lines, _, lacks_times) = told("t701100\nt18121122\n");
        assert_eq!(lines, ["0 701#00", "0 181#1122"]);
        assert!(lacks_times);
    }

    #[test]
    fn messages_of_socketcand_are_read() {
        let text = "< hi >\n< frame 701 1.500000 00 >\n< frame 00000001 1.600000 AA BB >\n< frame 80 1.7 >\n< frame 181 x 00 >";
        let (lines, others, _) = told(text);
        let wanted = [
            "1500 701#00",
            "1600 00000001#AABB",
            "1700 080#",
            "line 5: the CAN-ID or the time is missing",
        ];
        assert_eq!(lines, wanted);
        assert_eq!(others, 1);
    }

    #[test]
    fn lines_of_canutils_are_read_without_times() {
        let text = "interface = can0, family = 29, type = 3, proto = 1\n<0x181> [2] 11 22 \n<0x00000001> [1] aa\n\
                    <0x701> [1] remote request\n<0x181> [2] 11";
        let (lines, others, lacks_times) = told(text);
        let wanted = [
            "0 181#1122",
            "0 00000001#AA",
            "0 701#R1",
            "line 5: the data is not 2 bytes",
        ];
        assert_eq!(lines, wanted);
        assert_eq!((others, lacks_times), (1, true));
    }

    #[test]
    fn the_packet_list_of_tshark_is_read_if_it_has_the_bytes() {
        let text = "    1   0.000000              →              CAN 16 STD: 0x00000701   00\n    2   0.0125              →    \
                    CAN 16 XTD: 0x00000001   aa bb";
        let (lines, ..) = told(text);
        assert_eq!(lines, ["0 701#00", "12 00000001#AABB"]);
    }
}
