//! Frames and values typed by users: the forms of can-utils, and less strict ones.

use std::prelude::v1::*;

use od_model::{DataType, Kind, Refused, values};
use od_wire::{CanId, Frame};

use crate::grammar::problem::Problem;

const EXAMPLE: &str = "type a CAN-ID and up to 8 bytes, such as 601#40 04 60 00";

/// `601#4004600000000000`, `601#40 04 60 00`, `601 40 4 60 0`, `601h: 40,04`, `601 [2] 40 04`,
/// `701#R`, `181 [4] rtr`, `12345678#0102` (eight digits: 29 bits).
///
/// # Errors
/// [`Problem`] names the first invalid character.
pub fn frame(text: &str) -> Result<Frame, Problem> {
    let mut rest = Text::new(text);
    rest.skip(char::is_whitespace);
    let start = rest.at;
    if rest.is_empty() {
        return Err(Problem::at(1, "the frame is missing", EXAMPLE));
    }
    rest.take("0x");
    let digits = rest.word(|c| !c.is_whitespace() && !matches!(c, '#' | ':' | ','));
    let id = id(digits.strip_suffix(['h', 'H']).unwrap_or(&digits), start)?;
    let length = rest.length();
    if length.is_none() {
        rest.skip(char::is_whitespace);
        if matches!(rest.peek(), Some('#' | ':' | ',')) {
            rest.at += 1;
        }
        rest.skip(char::is_whitespace);
    }
    if let Some(remote) = rest.remote() {
        let dlc = remote.or(length).unwrap_or(0);
        let error = || Problem::at(rest.chars.len(), "a CAN frame has at most 8 bytes", EXAMPLE);
        return Frame::remote(id, dlc).ok_or_else(error);
    }
    let from = rest.at;
    let data = rest.bytes()?;
    if let Some(length) = length.filter(|length| usize::from(*length) != data.len()) {
        let count = data.len();
        let message = format!("[{length}] is followed by {count} bytes");
        return Err(Problem::at(from + 1, message, EXAMPLE));
    }
    let error = || Problem::at(from + 1, "a CAN frame has at most 8 bytes", EXAMPLE);
    Frame::new(id, &data).ok_or_else(error)
}

fn id(digits: &str, at: usize) -> Result<CanId, Problem> {
    let wrong = |message| Err(Problem::at(at + 1, message, EXAMPLE));
    let raw = u32::from_str_radix(digits, 16).ok();
    match (raw, digits.len()) {
        (Some(raw), 1..=3) if raw <= 0x7FF => Ok(CanId::standard(raw as u16)),
        (Some(_), 1..=3) => wrong("an 11-bit CAN-ID is at most 7FF"),
        (Some(raw), 8) if raw <= 0x1FFF_FFFF => Ok(CanId::extended(raw)),
        _ if digits.is_empty() || !digits.bytes().all(|c| c.is_ascii_hexdigit()) => {
            wrong("the CAN-ID has to be a hexadecimal number, such as 601")
        }
        _ => wrong("a CAN-ID has up to 3 digits, or 8 digits (29 bits, up to 1FFFFFFF)"),
    }
}

/// A line, read character by character.
struct Text {
    chars: Vec<char>,
    at: usize,
}

impl Text {
    fn new(text: &str) -> Self {
        let chars = text.chars().collect();
        Self { chars, at: 0 }
    }

    fn is_empty(&self) -> bool {
        self.at >= self.chars.len()
    }

    fn peek(&self) -> Option<char> {
        self.chars.get(self.at).copied()
    }

    fn skip(&mut self, wanted: impl Fn(char) -> bool) {
        while self.peek().is_some_and(&wanted) {
            self.at += 1;
        }
    }

    fn word(&mut self, wanted: impl Fn(char) -> bool) -> String {
        let from = self.at;
        self.skip(wanted);
        self.chars[from..self.at].iter().collect()
    }

    /// Takes these characters if they come next, in upper or lower case.
    fn take(&mut self, text: &str) -> bool {
        let len = text.chars().count();
        let next = self.chars.get(self.at..self.at + len).unwrap_or_default();
        let is_next = len > 0
            && next.len() == len
            && next
                .iter()
                .zip(text.chars())
                .all(|(is, wanted)| is.eq_ignore_ascii_case(&wanted));
        self.at += if is_next { len } else { 0 };
        is_next
    }

    /// Reads `[8]`, with optional characters before it.
    fn length(&mut self) -> Option<u8> {
        let from = self.at;
        self.skip(char::is_whitespace);
        if matches!(self.peek(), Some('#' | ':')) {
            self.at += 1;
        }
        self.skip(char::is_whitespace);
        if self.take("[")
            && let Some(digit) = self.peek().and_then(|c| c.to_digit(10))
        {
            self.at += 1;
            if self.take("]") {
                return Some(digit as u8);
            }
        }
        self.at = from;
        None
    }

    /// Reads `R`, `R4` or `rtr`: the rest is a remote frame, with an optional length.
    fn remote(&mut self) -> Option<Option<u8>> {
        let rest: String = self.chars[self.at..].iter().collect();
        let rest = rest.trim().to_ascii_lowercase();
        let rest = rest
            .strip_prefix("rtr")
            .or_else(|| rest.strip_prefix('r'))?
            .trim();
        match rest.as_bytes() {
            [] => Some(None),
            [digit @ b'0'..=b'9'] => Some(Some(digit - b'0')),
            _ => None,
        }
    }

    /// Reads bytes of one or two digits; one digit needs a separator after it.
    fn bytes(&mut self) -> Result<Vec<u8>, Problem> {
        let between = |c: char| c.is_whitespace() || matches!(c, '.' | ',' | '_' | '-');
        let mut bytes = Vec::new();
        loop {
            self.skip(between);
            if self.is_empty() {
                return Ok(bytes);
            }
            let from = self.at;
            self.take("0x");
            let mut value = None;
            for _ in 0..2 {
                let digit = self.peek().and_then(|c| c.to_digit(16));
                let Some(digit) = digit else {
                    break;
                };
                value = Some(value.unwrap_or(0) << 4 | digit);
                self.at += 1;
            }
            let is_single = self.chars[from..self.at].iter().collect::<String>().len() % 2 == 1;
            let next = self.peek();
            let is_bad = is_single && next.is_some_and(|c| !between(c));
            let Some(value) = value.filter(|_| !is_bad) else {
                let at = if is_bad { self.at } else { from };
                let wrong = self.chars.get(at).copied().unwrap_or(' ');
                let message = format!("“{wrong}” is not a hexadecimal digit");
                return Err(Problem::at(at + 1, message, EXAMPLE));
            };
            if bytes.len() == 8 {
                let message = "a CAN frame has at most 8 bytes";
                return Err(Problem::at(from + 1, message, EXAMPLE));
            }
            bytes.push(value as u8);
        }
    }
}

/// Returns the bytes of a value for an object of this type: `4096`, `0x1000`, `1000h`, `4 096`, `-1`,
/// `true`, `1.5`, `"save"`, a text without quotes for a text, `01 02 FF` for bytes. `real` reads
/// a decimal fraction; a page already has such a function.
///
/// # Errors
/// The problem of the text.
pub fn value(
    data_type: DataType,
    text: &str,
    real: impl Fn(&str) -> Option<f64>,
) -> Result<Vec<u8>, Refused> {
    let text = text.trim();
    if text.is_empty() {
        return Err("the value is missing".into());
    }
    let kind = data_type.kind();
    let quoted = quoted(text);
    if kind == Kind::Text || quoted.is_some() {
        let content = quoted.unwrap_or(text);
        return match data_type.size() {
            Some(size) if kind != Kind::Text && content.len() > size => {
                Err(format!("“{content}” is longer than {size} bytes").into())
            }
            _ => Ok(content.as_bytes().to_vec()),
        };
    }
    match kind {
        Kind::Real => {
            let number = real(text).filter(|number| number.is_finite());
            let number = number.ok_or_else(|| format!("“{text}” is not a number"))?;
            Ok(match data_type.size() {
                Some(4) => (number as f32).to_le_bytes().to_vec(),
                _ => number.to_le_bytes().to_vec(),
            })
        }
        Kind::Boolean | Kind::Unsigned | Kind::Signed => integer(data_type, text),
        _ => hex(text).ok_or_else(|| "type the bytes in hexadecimal".into()),
    }
}

fn quoted(text: &str) -> Option<&str> {
    let rest = text.strip_prefix(['"', '\'', '“'])?;
    rest.strip_suffix(['"', '\'', '”'])
}

fn integer(data_type: DataType, text: &str) -> Result<Vec<u8>, Refused> {
    let is_blank = |c: &char| c.is_whitespace() || matches!(c, ',' | '_');
    let digits: String = text.chars().filter(|c| !is_blank(c)).collect();
    let value = match digits.to_ascii_lowercase().as_str() {
        "true" => Some(1),
        "false" => Some(0),
        _ => values::integer(&digits),
    };
    let value =
        value.ok_or_else(|| format!("“{text}” is not a whole number (decimal, 0x1F or 1Fh)"))?;
    // All bits may be given, for signed types, too; an unsigned type has no negative values.
    let bits = data_type.bits().unwrap_or(8);
    let low = match data_type.kind() {
        Kind::Signed => -(1 << (bits - 1)),
        _ => 0,
    };
    if value < low || value >= 1 << bits {
        return Err(format!("{value} does not fit {data_type}").into());
    }
    let size = data_type.size().unwrap_or(1).clamp(1, 16);
    Ok(value.to_le_bytes()[..size].to_vec())
}

fn hex(text: &str) -> Option<Vec<u8>> {
    let digits: Vec<u32> = text
        .chars()
        .filter(|c| !c.is_whitespace() && *c != ',')
        .map(|c| c.to_digit(16))
        .collect::<Option<_>>()?;
    let pair = |pair: &[u32]| match pair {
        [high, low] => Some((high << 4 | low) as u8),
        _ => None,
    };
    digits.chunks(2).map(pair).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::string::ToString;

    #[test]
    fn frames_may_have_a_loose_form() {
        for text in [
            "601#4004600000000000",
            "601#40 04 60 00 00 00 00 00",
            "  601 40 04 60 00 00 00 00 00 ",
            "601#40.04.60.00.00.00.00.00",
            "0x601 40,04,60,00,00,00,00,00",
            "601h 40 4 60 0 0 0 0 0",
            "601   [8]  40 04 60 00 00 00 00 00",
            "601: 40 04 60 00 00 00 00 00",
            "601#40 0x04 0x60 0 0 0 0 0",
        ] {
            let read = frame(text).map(|frame| frame.to_string());
            assert_eq!(read.as_deref(), Ok("601#4004600000000000"), "{text}");
        }
        for (text, expected) in [
            ("0#0101", "000#0101"),
            ("80", "080#"),
            ("601#4", "601#04"),
            ("601#40 04 60 00 00", "601#4004600000"),
            ("12345678#01", "12345678#01"),
            ("701#R", "701#R"),
            ("701 r", "701#R"),
            ("181#R4", "181#R4"),
            ("181 [4] rtr", "181#R4"),
        ] {
            assert_eq!(
                frame(text).map(|frame| frame.to_string()).as_deref(),
                Ok(expected)
            );
        }
    }

    #[test]
    fn a_mistake_in_a_frame_has_a_place() {
        for (text, column, why) in [
            ("", 1, "missing"),
            ("xyz#00", 1, "hexadecimal"),
            ("800#00", 1, "7FF"),
            ("1234#00", 1, "3 digits, or 8"),
            ("FFFFFFFF#00", 1, "1FFFFFFF"),
            ("601#4g", 6, "“g”"),
            ("601#40 0x", 8, "hexadecimal"),
            ("601#00 11 22 33 44 55 66 77 88", 29, "8 bytes"),
            ("601 [2] 40", 8, "followed by 1"),
            ("601#R9", 6, "8 bytes"),
        ] {
            let error = frame(text).expect_err(text);
            assert!(error.message.contains(why), "{text}: {error}");
            assert_eq!(error.column, column, "{text}: {error}");
        }
    }

    #[test]
    fn values_may_have_a_loose_form() {
        let value = |data_type, text: &str| super::value(data_type, text, |text| text.parse().ok());
        let u32_ = DataType::Unsigned32;
        for text in [
            "4096",
            "0x1000",
            "1000h",
            " 4 096 ",
            "4_096",
            "4,096",
            "4\u{2009}096",
        ] {
            assert_eq!(value(u32_, text), Ok(vec![0, 0x10, 0, 0]), "{text}");
        }
        for (data_type, text, bytes) in [
            (u32_, "\"save\"", &b"save"[..]),
            (DataType::Integer16, "-1", &[0xFF, 0xFF]),
            (DataType::Integer16, "0xFFFF", &[0xFF, 0xFF]),
            (DataType::Unsigned64, "18446744073709551615", &[0xFF; 8]),
            (DataType::Boolean, "true", &[1]),
            (DataType::VisibleString, "GXMM", b"GXMM"),
            (DataType::VisibleString, "“GXMM”", b"GXMM"),
            (DataType::OctetString, "01 02 ff", &[1, 2, 0xFF]),
            (DataType::Real32, "1.5", &[0, 0, 0xC0, 0x3F]),
        ] {
            assert_eq!(value(data_type, text).as_deref(), Ok(bytes), "{text}");
        }
        for (data_type, text, why) in [
            (DataType::Unsigned8, "256", "256 does not fit UNSIGNED8"),
            (DataType::Unsigned16, "-1", "-1 does not fit UNSIGNED16"),
            (
                DataType::Unsigned16,
                "70000",
                "70000 does not fit UNSIGNED16",
            ),
            (DataType::Integer8, "-129", "-129 does not fit INTEGER8"),
            (DataType::Unsigned8, "twelve", "not a whole number"),
            (DataType::Unsigned8, "", "missing"),
            (DataType::Unsigned16, "\"save\"", "longer than 2 bytes"),
            (DataType::Real32, "x", "not a number"),
            (DataType::Domain, "1", "hexadecimal"),
        ] {
            let error = value(data_type, text).expect_err(text).to_string();
            assert!(error.contains(why), "{text}: {error}");
        }
    }
}
