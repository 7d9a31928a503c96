//! The text of can-utils: what `candump` prints and `cansend` takes.
//!
//! | form | example |
//! |---|---|
//! | log (`candump -L`) | `(0.100000) can0 601#4004600000000000` |
//! | `cansend` | `601#40.04.60.00`, `701#R`, `701#R4`, `1F334455#11` |
//! | screen (`candump`) | `can0  601   [8]  40 04 60 00 00 00 00 00` |
//!
//! Everything that is not one of these is an [`Error`] that says where and why.

use std::prelude::v1::*;
use std::{fmt, format};

use od_runtime::{CanId, Frame, Instant};

use crate::cursor::Cursor;

/// A frame as a log has it.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct Line {
    /// The time stamp, where there is one.
    pub at: Option<Instant>,
    /// The interface, where there is one.
    pub interface: Option<String>,
    /// The frame.
    pub frame: Frame,
}

/// Error for a text that is not a frame.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct Error {
    /// The first character that does not fit, counted from 1.
    pub column: usize,
    /// The problem, one clause.
    pub message: String,
    /// Text to write instead.
    pub help: &'static str,
}

impl Error {
    pub(crate) fn new(column: usize, message: impl Into<String>, help: &'static str) -> Self {
        Self {
            column,
            message: message.into(),
            help,
        }
    }

    fn shifted(mut self, by: usize) -> Self {
        self.column += by;
        self
    }
}

impl fmt::Display for Error {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "column {}: {}; {}", self.column, self.message, self.help)
    }
}

impl core::error::Error for Error {}

/// One line in any of the three forms. Empty lines are the caller's business.
///
/// # Errors
/// [`Error`] names the first character that does not fit.
pub fn parse_line(line: &str) -> Result<Line, Error> {
    let mut rest = Cursor::new(line);
    let at = match rest.peek().starts_with('(') {
        true => Some(time_stamp(&mut rest)?),
        false => None,
    };
    let (column, word) = next_word(&mut rest, FRAME)?;
    if word.contains('#') {
        let frame = parse_frame(word).map_err(|error| error.shifted(column - 1))?;
        return end(rest).map(|()| Line {
            at,
            interface: None,
            frame,
        });
    }
    let interface = Some(word.to_owned());
    let (column, word) = next_word(&mut rest, FRAME)?;
    let frame = if word.contains('#') {
        parse_frame(word).map_err(|error| error.shifted(column - 1))?
    } else {
        screen(column, word, &mut rest)?
    };
    end(rest).map(|()| Line {
        at,
        interface,
        frame,
    })
}

const FRAME: &str = "write a frame such as 601#4004600000000000 or 701#R";
const TIME: &str = "write seconds in parentheses, such as (0.100000)";
const ID: &str =
    "write a CAN-ID of 3 hex digits (11 bits, up to 7FF) or 8 (29 bits, up to 1FFFFFFF)";
const DATA: &str = "write 0 to 8 bytes of two hex digits each";

/// A frame as `cansend` takes it: `601#40046000`, `601#40.04.60.00`, `701#R`, `701#R4`.
///
/// # Errors
/// [`Error`] names the first character that does not fit.
pub fn parse_frame(text: &str) -> Result<Frame, Error> {
    let Some((id, data)) = text.split_once('#') else {
        return Err(Error::new(1, format!("`{text}` has no `#`"), FRAME));
    };
    let start = id.chars().count() + 2;
    let id = parse_id(id)?;
    if data.starts_with('#') {
        return Err(Error::new(
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
            Error::new(
                start + 1,
                format!("`{dlc}` is not a valid length"),
                "write R, or R and a length from 0 to 8",
            )
        });
    }
    let (bytes, len) = parse_data(data).map_err(|error| error.shifted(start - 1))?;
    Ok(Frame::with_dlc(id, bytes, len as u8))
}

/// An identifier of 3 or 8 hex digits.
pub(crate) fn parse_id(text: &str) -> Result<CanId, Error> {
    let bad = |message: String| Err(Error::new(1, message, ID));
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

/// Hex bytes, with or without dots or blanks between them.
fn parse_data(text: &str) -> Result<([u8; 8], usize), Error> {
    let mut bytes = [0; 8];
    let mut len = 0;
    let mut high = None;
    for (column, c) in text.chars().enumerate().map(|(at, c)| (at + 1, c)) {
        let Some(digit) = c.to_digit(16) else {
            if matches!(c, '.' | ' ') && high.is_none() {
                continue;
            }
            return Err(Error::new(
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
            return Err(Error::new(column, "more than 8 bytes", DATA));
        };
        *byte = (first << 4 | digit) as u8;
        len += 1;
    }
    match high {
        Some(_) => Err(Error::new(text.chars().count(), "half a byte", DATA)),
        None => Ok((bytes, len)),
    }
}

/// `601   [8]  40 04 60 00 00 00 00 00`, or `701   [0]  remote request`.
fn screen(column: usize, id: &str, rest: &mut Cursor<'_>) -> Result<Frame, Error> {
    let id = parse_id(id).map_err(|error| error.shifted(column - 1))?;
    let (column, length) = next_word(rest, FRAME)?;
    let length = length
        .strip_prefix('[')
        .and_then(|rest| rest.strip_suffix(']'));
    let dlc = length.and_then(|digits| digits.parse().ok());
    let Some(request) = dlc.and_then(|dlc| Frame::remote(id, dlc)) else {
        return Err(Error::new(
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
    for byte in data.iter_mut().take(request.dlc().into()) {
        let (column, word) = next_word(rest, "write as many bytes as the length gives")?;
        *byte = match (word.len(), u8::from_str_radix(word, 16)) {
            (2, Ok(byte)) => byte,
            _ => return Err(Error::new(column, format!("`{word}` is not a byte"), DATA)),
        };
    }
    Ok(Frame::with_dlc(id, data, request.dlc()))
}

fn time_stamp(rest: &mut Cursor<'_>) -> Result<Instant, Error> {
    let (column, word) = next_word(rest, TIME)?;
    let inner = word
        .strip_prefix('(')
        .and_then(|rest| rest.strip_suffix(')'));
    match inner.and_then(seconds) {
        Some(micros) => Ok(Instant::from_micros(micros)),
        None => Err(Error::new(
            column,
            format!("`{word}` is not a time stamp"),
            TIME,
        )),
    }
}

/// Microseconds of a decimal number of seconds; digits past the sixth are cut.
pub(crate) fn seconds(text: &str) -> Option<u64> {
    let (whole, fraction) = text.split_once('.').unwrap_or((text, ""));
    let digits = |text: &str| text.bytes().all(|byte| byte.is_ascii_digit());
    if !digits(whole) || !digits(fraction) || whole.len() + fraction.len() == 0 {
        return None;
    }
    let whole: u64 = if whole.is_empty() {
        0
    } else {
        whole.parse().ok()?
    };
    let micros = fraction.bytes().chain([b'0'; 6]).take(6);
    let micros = micros.fold(0, |micros, digit| micros * 10 + u64::from(digit - b'0'));
    whole.checked_mul(1_000_000)?.checked_add(micros)
}

/// A log line may end with `R` or `T`: received or sent. Nothing else follows a frame.
fn end(mut rest: Cursor<'_>) -> Result<(), Error> {
    match next_word(&mut rest, "") {
        Err(_) | Ok((_, "R" | "T")) => Ok(()),
        Ok((column, word)) => Err(Error::new(
            column,
            format!("unexpected `{word}` after the frame"),
            "write one frame per line",
        )),
    }
}

/// One line of a log, as `candump -L` writes it.
pub fn format_line(at: Instant, interface: &str, frame: &Frame) -> String {
    format!("({at:?}) {interface} {frame}")
}

/// The next word, with its column.
fn next_word<'t>(rest: &mut Cursor<'t>, help: &'static str) -> Result<(usize, &'t str), Error> {
    let column = rest.column;
    match rest.next() {
        "" => Err(Error::new(column, "the line ends here", help)),
        word => Ok((column, word)),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[track_caller]
    fn check(line: &str, expected: &str) {
        let shown = match parse_line(line) {
            Ok(Line {
                at: Some(at),
                interface,
                frame,
            }) => format_line(at, interface.as_deref().unwrap_or("-"), &frame),
            Ok(Line { frame, .. }) => frame.to_string(),
            Err(error) => format!("{}: {}", error.column, error.message),
        };
        assert_eq!(shown, expected, "{line}");
    }

    #[test]
    fn the_three_forms_read_the_same() {
        check(
            "(0.100000) can0 601#4004600000000000",
            "(0.100000) can0 601#4004600000000000",
        );
        check(
            "  (1600000000.5)  vcan1  701#R R",
            "(1600000000.500000) vcan1 701#R",
        );
        check("601#40.04.60.00", "601#40046000");
        check("1F334455#11", "1F334455#11");
        check("701#R4", "701#R4");
        check("080#", "080#");
        check(
            "can0  601   [8]  40 04 60 00 00 00 00 00",
            "601#4004600000000000",
        );
        check(
            " (003.1)  can0  701   [0]  remote request",
            "(3.100000) can0 701#R",
        );
    }

    #[test]
    fn errors_say_where_and_what() {
        check("601", "4: the line ends here");
        check("(x) can0 601#40", "1: `(x)` is not a time stamp");
        check("601#4", "5: half a byte");
        check("601#4g", "6: `g` is not a hex digit");
        check("601#112233445566778899", "22: more than 8 bytes");
        check("800#11", "1: CAN-ID 800 is too large");
        check("can0 6011#11", "6: `6011` has 4 digits");
        check("60x#11", "3: `60x` is not a valid CAN-ID");
        check("601#R9", "6: `9` is not a valid length");
        check("601##011", "5: `##` begins a CAN FD frame");
        check("can0 601 [9] 00", "10: the length is not valid");
        check("can0 601 [2] 00", "16: the line ends here");
        check("601#11 22", "8: unexpected `22` after the frame");
        check("ä#11", "1: `ä` is not a valid CAN-ID");
    }

    #[test]
    fn no_text_panics() {
        let pieces = [
            "(", ")", "can0", "#", "601", "R", "9", "[8]", " ", "ä", "\u{0}", "FFFFFFFF", ".",
        ];
        let mut state = 1u32;
        for _ in 0..20_000 {
            let mut line = String::new();
            for _ in 0..state % 9 {
                state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
                line.push_str(pieces[(state >> 16) as usize % pieces.len()]);
            }
            state = state.wrapping_add(1);
            let _ = parse_line(&line);
        }
    }
}
