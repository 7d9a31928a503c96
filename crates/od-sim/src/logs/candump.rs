//! The text formats of can-utils: the output of `candump` and the input of `cansend`.
//!
//! | form | example |
//! |---|---|
//! | log (`candump -L`) | `(0.100000) can0 601#4004600000000000` |
//! | `cansend` | `601#40.04.60.00`, `701#R`, `701#R4`, `1F334455#11` |
//! | screen (`candump`) | `can0  601   [8]  40 04 60 00 00 00 00 00` |
//! | bits, last byte first (`candump -i`, `-S`) | `can0  601   [2]  01000000 00000100`, <code>can0  601   \[2\]  04\`40</code> |
//! | screen (`candump -tA -x -a`) | `(2026-11-25 15:50:01.123456)  can0  RX - -  601   [2]  40 41   '@A'` |
//!
//! A remark may follow the frame. Any other text is a [`Problem`] with the place and the reason.

use std::format;
use std::prelude::v1::*;

use od_runtime::{CanId, Frame, Instant};

use super::record::{BusError, ERROR, What};
use super::stamp;
use crate::cursor::Cursor;
use crate::grammar::problem::Problem;

/// A frame with the other fields of its log line.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct LogLine {
    /// The time stamp, if there is one.
    pub at: Option<Instant>,
    /// The interface, if there is one.
    pub interface: Option<String>,
    /// The frame.
    pub frame: Frame,
}

/// Reads one line in any of the three forms. The caller handles empty lines.
///
/// # Errors
/// [`Problem`] names the first invalid character.
pub fn parse_line(line: &str) -> Result<LogLine, Problem> {
    let Logged {
        at,
        interface,
        frame,
        word: (column, word),
        ..
    } = logged(line)?;
    match frame {
        Some(frame) => Ok(LogLine {
            at,
            interface: interface.map(str::to_owned),
            frame,
        }),
        None => Err(Problem::at(
            column,
            format!("`{word}` is an error frame"),
            "remove the line; an error frame cannot be sent",
        )),
    }
}

/// Content of a line of a log.
pub(super) struct Logged<'t> {
    pub(super) at: Option<Instant>,
    interface: Option<&'t str>,
    /// Sent by the computer that wrote the log.
    pub(super) sent: bool,
    /// `None`: an error message of SocketCAN.
    frame: Option<Frame>,
    /// The word of the frame or of its CAN-ID, with its column, and the text after it.
    word: (usize, &'t str),
    rest: Cursor<'t>,
}

impl Logged<'_> {
    /// The frame, or the error; an error message of SocketCAN that is no error has neither.
    pub(super) fn what(&self) -> Option<What> {
        if let Some(frame) = self.frame {
            return Some(What::Frame(frame));
        }
        let (_, word) = self.word;
        let error = BusError::of_socketcan(error_id(word)?, error_data(word, self.rest));
        error.map(What::Error)
    }
}

/// Returns whether a line is one of a log: a time stamp, an interface and a frame.
pub(super) fn is_record(line: &str) -> bool {
    logged(line).is_ok_and(|line| line.at.is_some() && line.interface.is_some())
}

/// Returns whether a line is a frame without a time stamp, with or without its interface; also a CAN FD frame, so that a log
/// of such frames is named.
pub(super) fn is_untimed(line: &str) -> bool {
    match logged(line) {
        Ok(line) => {
            // A time of day without parentheses is not the name of an interface.
            let is_time = |name| stamp::time_of_day(name).is_some();
            line.at.is_none() && !line.interface.is_some_and(is_time)
        }
        Err(problem) => {
            problem.message.ends_with(" a CAN FD frame") && !line.trim_start().starts_with('(')
        }
    }
}

/// Reads a line in any of the three forms, including error frames.
pub(super) fn logged(line: &str) -> Result<Logged<'_>, Problem> {
    let mut rest = Cursor::new(line);
    let at = if rest.peek().starts_with('(') {
        Some(time_stamp(&mut rest)?)
    } else {
        None
    };
    let (column, word) = next_word(&mut rest, FRAME)?;
    let mut logged = Logged {
        at,
        interface: None,
        sent: false,
        frame: None,
        word: (column, word),
        rest,
    };
    if !word.contains('#') {
        logged.interface = Some(word);
        logged.sent = direction(&mut rest);
        logged.word = next_word(&mut rest, FRAME)?;
    }
    logged.rest = rest;
    let (column, word) = logged.word;
    if error_id(word).is_some() {
        return Ok(logged);
    }
    logged.frame = Some(if word.contains('#') {
        parse_frame(word).map_err(|error| error.shifted(column - 1))?
    } else {
        screen(column, word, &mut rest)?
    });
    // On a screen the length says where the data ends.
    let is_over = !word.contains('#') && screen_byte(1, rest.peek()).is_err();
    logged.sent |= !is_over && end(rest)?;
    Ok(logged)
}

/// Reads `TX - -`, which `candump -x` writes before the CAN-ID: the direction, and flags for bit rate and error state.
fn direction(rest: &mut Cursor<'_>) -> bool {
    let sent = rest.peek() == "TX";
    if sent || rest.peek() == "RX" {
        rest.next();
        for flag in ["B", "E"] {
            if ["-", flag].contains(&rest.peek()) {
                rest.next();
            }
        }
    }
    sent
}

/// The CAN-ID of an error message of SocketCAN, which a flag marks.
fn error_id(frame: &str) -> Option<u32> {
    let id = frame.split('#').next().unwrap_or_default();
    let raw = u32::from_str_radix(id, 16).ok().filter(|_| id.len() == 8);
    raw.filter(|raw| raw & ERROR != 0)
}

/// The bytes of an error message, in the log form, or after its length on a screen.
fn error_data(frame: &str, rest: Cursor<'_>) -> [u8; 8] {
    if let Some((_, data)) = frame.split_once('#') {
        return parse_data(data).map(|(bytes, _)| bytes).unwrap_or_default();
    }
    let words = rest.text.split_whitespace().skip(1);
    let mut data = [0; 8];
    for (byte, word) in data.iter_mut().zip(words) {
        *byte = u8::from_str_radix(word, 16).unwrap_or_default();
    }
    data
}

const FRAME: &str = "write a frame such as 601#4004600000000000 or 701#R";
const TIME: &str = "write seconds in parentheses, such as (0.100000)";
const ID: &str =
    "write a CAN-ID of 3 hex digits (11 bits, up to 7FF) or 8 (29 bits, up to 1FFFFFFF)";
const DATA: &str = "write 0 to 8 bytes of two hex digits each";

/// Reads a frame in the form of `cansend`: `601#40046000`, `601#40.04.60.00`, `701#R`, `701#R4`.
///
/// # Errors
/// [`Problem`] names the first invalid character.
pub fn parse_frame(text: &str) -> Result<Frame, Problem> {
    let Some((id, data)) = text.split_once('#') else {
        return Err(Problem::at(1, format!("`{text}` has no `#`"), FRAME));
    };
    let start = id.chars().count() + 2;
    let id = parse_id(id)?;
    if data.starts_with('#') {
        return Err(Problem::at(
            start,
            "`##` begins a CAN FD frame",
            "write one `#`; CANopen does not use CAN FD",
        ));
    }
    if let Some(dlc) = data.strip_prefix(['R', 'r']) {
        let length = match dlc.as_bytes() {
            [] => Some(0),
            [digit @ b'0'..=b'9'] => Some(digit - b'0'),
            _ => None,
        };
        let frame = length.and_then(|length| Frame::remote(id, length));
        return frame.ok_or_else(|| {
            Problem::at(
                start + 1,
                format!("`{dlc}` is not a valid length"),
                "write R, or R and a length from 0 to 8",
            )
        });
    }
    let (bytes, len) = parse_data(data).map_err(|error| error.shifted(start - 1))?;
    Ok(Frame::with_dlc(id, bytes, len as u8))
}

/// A CAN-ID of 3 or 8 hex digits.
pub(crate) fn parse_id(text: &str) -> Result<CanId, Problem> {
    let bad = |message: String| Err(Problem::at(1, message, ID));
    if let Some(at) = text.chars().position(|c| !c.is_ascii_hexdigit()) {
        return bad(format!("`{text}` is not a valid CAN-ID")).map_err(|error| error.shifted(at));
    }
    let raw = u32::from_str_radix(text, 16).unwrap_or(u32::MAX);
    match text.len() {
        3 if raw <= 0x7FF => Ok(CanId::standard(raw as u16)),
        8 if raw <= 0x1FFF_FFFF => Ok(CanId::extended(raw)),
        3 | 8 => bad(format!("CAN-ID {text} is too large")),
        0 => bad("the CAN-ID is missing".into()),
        digits => bad(format!("`{text}` has {digits} digits")),
    }
}

/// Hex bytes, with or without dots or blanks between them. After eight bytes candump writes a DLC above 8 as `_9` to `_F`.
fn parse_data(text: &str) -> Result<([u8; 8], usize), Problem> {
    let text = match text.split_once('_') {
        Some((bytes, "9" | "A" | "B" | "C" | "D" | "E" | "F")) if bytes.len() >= 16 => bytes,
        _ => text,
    };
    let mut bytes = [0; 8];
    let mut len = 0;
    let mut high = None;
    for (column, c) in text.chars().enumerate().map(|(at, c)| (at + 1, c)) {
        let Some(digit) = c.to_digit(16) else {
            if matches!(c, '.' | ' ') && high.is_none() {
                continue;
            }
            return Err(Problem::at(
                column,
                format!("`{c}` is not a hex digit"),
                DATA,
            ));
        };
        let Some(first) = high.take() else {
            high = Some(digit);
            continue;
        };
        let Some(byte) = bytes.get_mut(len) else {
            return Err(Problem::at(column, "more than 8 bytes", DATA));
        };
        *byte = (first << 4 | digit) as u8;
        len += 1;
    }
    match high {
        Some(_) => Err(Problem::at(text.chars().count(), "half a byte", DATA)),
        None => Ok((bytes, len)),
    }
}

/// `601   [8]  40 04 60 00 00 00 00 00`, or `701   [0]  remote request`.
fn screen(column: usize, id: &str, rest: &mut Cursor<'_>) -> Result<Frame, Problem> {
    let id = parse_id(id).map_err(|error| error.shifted(column - 1))?;
    let (column, length) = next_word(rest, FRAME)?;
    let length = length
        .strip_prefix('[')
        .and_then(|rest| rest.strip_suffix(']'));
    if length.is_some_and(|digits| digits.len() == 2 && digits.parse::<u8>().is_ok()) {
        return Err(Problem::at(
            column,
            "a length of two digits belongs to a CAN FD frame",
            "remove the line; CANopen does not use CAN FD",
        ));
    }
    let dlc = length.and_then(|digits| digits.parse().ok());
    let Some(request) = dlc.and_then(|dlc| Frame::remote(id, dlc)) else {
        return Err(Problem::at(
            column,
            "the length is not valid",
            "write the length as [0] to [8]",
        ));
    };
    if rest.peek() == "remote" {
        next_word(rest, FRAME)?;
        if rest.peek() == "request" {
            next_word(rest, FRAME)?;
        }
        return Ok(request);
    }
    let mut data = [0; 8];
    let room = &mut data[..request.dlc().into()];
    if rest.peek().contains('`') {
        let (column, word) = next_word(rest, DATA)?;
        let words: Vec<&str> = word.rsplit('`').collect();
        if words.len() != room.len() {
            return Err(Problem::at(
                column,
                format!("`{word}` is not {} bytes", room.len()),
                DATA,
            ));
        }
        for (byte, word) in room.iter_mut().zip(words) {
            *byte = screen_byte(column, word)?;
        }
        return Ok(Frame::with_dlc(id, data, request.dlc()));
    }
    for byte in room {
        let (column, word) = next_word(rest, "write as many bytes as the length gives")?;
        *byte = screen_byte(column, word)?;
    }
    Ok(Frame::with_dlc(id, data, request.dlc()))
}

/// A byte of the screen form: two hex digits, or eight bits (`candump -i`).
fn screen_byte(column: usize, word: &str) -> Result<u8, Problem> {
    let radix = match word.len() {
        2 => 16,
        8 => 2,
        _ => 0,
    };
    let digits = word.chars().all(|digit| radix > 0 && digit.is_digit(radix));
    let byte = u8::from_str_radix(word, radix.max(2))
        .ok()
        .filter(|_| digits);
    byte.ok_or_else(|| Problem::at(column, format!("`{word}` is not a byte"), DATA))
}

fn time_stamp(rest: &mut Cursor<'_>) -> Result<Instant, Problem> {
    let (column, word) = (rest.column, rest.peek());
    let not_one = || Problem::at(column, format!("`{word}` is not a time stamp"), TIME);
    stamp::take(rest)
        .map(Instant::from_micros)
        .ok_or_else(not_one)
}

/// A log line may end with `R` or `T` (received or sent), and with a remark, such as `# NMT start`.
fn end(mut rest: Cursor<'_>) -> Result<bool, Problem> {
    let direction = rest.peek();
    if matches!(direction, "R" | "r" | "T" | "t") {
        rest.next();
    }
    if rest.text.starts_with(char::is_alphanumeric) {
        return Err(Problem::at(
            rest.column,
            format!("unexpected `{}` after the frame", rest.peek()),
            "write one frame per line",
        ));
    }
    Ok(matches!(direction, "T" | "t"))
}

/// One line of a log in the form of `candump -L`.
pub fn format_line(at: Instant, interface: &str, frame: &Frame) -> String {
    format!("({at:?}) {interface} {frame}")
}

/// The next word, with its column.
fn next_word<'t>(rest: &mut Cursor<'t>, help: &'static str) -> Result<(usize, &'t str), Problem> {
    let column = rest.column;
    match rest.next() {
        "" => Err(Problem::at(column, "the line ends here", help)),
        word => Ok((column, word)),
    }
}

#[cfg(test)]
mod tests;
