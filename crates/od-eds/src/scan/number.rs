//! Numbers in the spellings of EDS files.

use alloc::string::String;
use alloc::vec::Vec;

use crate::scan::either;

/// Peculiarity of a value that odkit understands in spite of it.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(crate) enum Note {
    /// `5 ; five`
    Comment,
    /// `010` is 8.
    Octal,
    /// `08` is 8.
    NotOctal,
    /// `0x10L`, `5.0`
    Suffix,
    /// 0xFF in an INTEGER8 is -1.
    TwosComplement,
    /// `0x180 + $nodeid`
    NodeId,
    /// An OCTET_STRING that is not hexadecimal.
    Characters,
    /// `true`, `false`
    Word,
    /// `FF`, `1Fh`
    BareHex,
    /// `1,5`
    Comma,
}

/// A number and its peculiarities.
#[derive(Clone, PartialEq, Debug)]
pub(crate) struct Number {
    pub(crate) value: i128,
    /// Written in hexadecimal, without a sign.
    pub(crate) pattern: bool,
}

/// The text before a `;` or a `#`.
pub fn before_comment(text: &str) -> &str {
    let found = either(text, [b';', b'#']).or_else(|| {
        let slash = either(text, [b'/'; 2])?;
        text[slash..].find("//").map(|at| slash + at)
    });
    match found {
        Some(at) => text[..at].trim_end(),
        None => text,
    }
}

/// The text before a `;` or a `#`; the comment is noted.
pub(crate) fn without_comment<'a>(text: &'a str, notes: &mut Vec<Note>) -> &'a str {
    let before = before_comment(text);
    if before.len() != text.len() {
        notes.push(Note::Comment);
    }
    before
}

/// An integer: decimal, `0x` hexadecimal or octal with a leading 0, with a sign.
pub(crate) fn integer(text: &str, notes: &mut Vec<Note>) -> Option<Number> {
    if let Some(number) = plain(text.as_bytes()) {
        return Some(number);
    }
    let (negative, unsigned) = match text.strip_prefix('-') {
        Some(rest) => (true, rest.trim_start()),
        None => (false, text.strip_prefix('+').unwrap_or(text).trim_start()),
    };
    let mut digits = unsigned;
    let hex = hex_digits(unsigned);
    if hex.is_none()
        && let Some((whole, fraction)) = unsigned.split_once('.')
        && !whole.is_empty()
        && fraction.bytes().all(|b| b == b'0')
    {
        notes.push(Note::Suffix);
        digits = whole;
    } else {
        let bare = unsigned.trim_end_matches(['u', 'U', 'l', 'L']);
        if bare.len() != unsigned.len() && unsigned.len() - bare.len() <= 3 {
            notes.push(Note::Suffix);
            digits = bare;
        }
    }
    let (radix, digits) = match hex_digits(digits).or_else(|| bare_hex(unsigned, notes)) {
        Some(digits) => (16, digits),
        None => (decimal_or_octal(digits, notes), digits),
    };
    // `from_str_radix` would accept a second sign.
    if !digits.bytes().all(|b| b.is_ascii_alphanumeric()) {
        return None;
    }
    let magnitude = i128::from(u64::from_str_radix(digits, radix).ok()?);
    Some(Number {
        value: if negative { -magnitude } else { magnitude },
        pattern: radix == 16 && !negative,
    })
}

/// An integer in the usual spelling, decimal or hexadecimal, of at most 64 bits.
fn plain(text: &[u8]) -> Option<Number> {
    let (radix, digits) = match text {
        [b'0', b'x' | b'X', digits @ ..] if digits.len() <= 16 => (16, digits),
        [b'0'] | [b'1'..=b'9', ..] if text.len() <= 18 => (10, text),
        _ => return None,
    };
    let (mut value, mut at) = (0u64, 0);
    while at < digits.len() {
        let digit = char::from(digits[at]).to_digit(radix)?;
        value = value * u64::from(radix) + u64::from(digit);
        at += 1;
    }
    (at > 0).then(|| Number {
        value: i128::from(value),
        pattern: radix == 16,
    })
}

fn hex_digits(text: &str) -> Option<&str> {
    text.strip_prefix("0x").or_else(|| text.strip_prefix("0X"))
}

/// The digits of `1Fh` and `FF`; a word such as `add` is not a number.
fn bare_hex<'a>(text: &'a str, notes: &mut Vec<Note>) -> Option<&'a str> {
    let digits = text.strip_suffix(['h', 'H']);
    let bare = digits.unwrap_or(text);
    let letters = || bare.bytes().filter(u8::is_ascii_alphabetic);
    // `1e3` may as well be a thousand.
    let exponent = bare.bytes().filter(u8::is_ascii_alphabetic).eq(*b"e")
        || bare.bytes().filter(u8::is_ascii_alphabetic).eq(*b"E");
    let is_number = bare.bytes().all(|b| b.is_ascii_hexdigit())
        && (digits.is_some() || letters().next().is_some())
        && match bare.len() {
            0 => false,
            1 | 2 => true,
            _ if exponent => false,
            _ => {
                bare.bytes().any(|b| b.is_ascii_digit())
                    || letters().all(|b| b.eq_ignore_ascii_case(&b'F'))
            }
        };
    is_number.then(|| notes.push(Note::BareHex))?;
    Some(bare)
}

/// 8 for `017`, 10 for `17`, `08` and `0`; `007` is the same in both, and is not reported.
fn decimal_or_octal(digits: &str, notes: &mut Vec<Note>) -> u32 {
    let significant = digits.trim_start_matches('0');
    if significant.len() == digits.len() || significant.is_empty() {
        return 10;
    }
    if significant.bytes().any(|b| !(b'0'..=b'7').contains(&b)) {
        if significant.bytes().all(|b| b.is_ascii_digit()) {
            notes.push(Note::NotOctal);
        }
        return 10;
    }
    if significant.len() > 1 {
        notes.push(Note::Octal);
    }
    8
}

/// The offset in `$NODEID+n`: in any order, case and spacing, with or without `$` and brackets; the
/// sum if there are several numbers; 0 for `$NODEID`.
///
/// `Some(Err)` is a formula with other content.
pub(crate) fn node_id(text: &str, notes: &mut Vec<Note>) -> Option<Result<u32, ()>> {
    const NAME: &str = "$NODEID";
    // Nearly every value is a number without any of these letters.
    if !text.bytes().any(|b| b.eq_ignore_ascii_case(&b'N')) {
        return None;
    }
    let plain: String = text
        .chars()
        .filter(|c| !c.is_whitespace() && !matches!(c, '(' | ')' | '{' | '}'))
        .map(|c| c.to_ascii_uppercase())
        .collect();
    let is_name = |part: &str| {
        let name = part.strip_prefix('$').unwrap_or(part);
        matches!(name, "NODEID" | "NODE_ID" | "NODE-ID")
    };
    if !["NODEID", "NODE_ID", "NODE-ID"]
        .iter()
        .any(|name| plain.contains(name))
    {
        return None;
    }
    let mut names = 0;
    let mut offset = 0i128;
    let mut odd = Vec::new();
    for part in plain.split('+') {
        if is_name(part) {
            names += 1;
            continue;
        }
        match integer(part, &mut odd) {
            Some(number) if number.value >= 0 => offset += number.value,
            _ => return Some(Err(())),
        }
    }
    if names != 1 {
        return Some(Err(()));
    }
    let as_written = match text.strip_prefix(NAME) {
        Some("") => true,
        Some(rest) => plain.matches('+').count() == 1 && rest.len() + NAME.len() == plain.len(),
        None => false,
    };
    if !as_written {
        notes.push(Note::NodeId);
    }
    notes.append(&mut odd);
    Some(u32::try_from(offset).map_err(|_| ()))
}

/// The offset in `$MY_NODE_ID+n`, with another name in place of `$NODEID`; `None` for anything
/// except one name and numbers.
pub(crate) fn meant_node_id(text: &str) -> Option<u32> {
    let is_name = |part: &str| {
        let own = |b: u8| b.is_ascii_alphanumeric() || b"$_ ".contains(&b);
        let node = part.to_ascii_uppercase().contains("NODE");
        part.bytes().all(own) && (part.starts_with('$') || node)
    };
    let (names, numbers): (Vec<&str>, Vec<&str>) = text
        .split('+')
        .map(str::trim)
        .partition(|part| is_name(part));
    let mut offset = 0;
    for number in &numbers {
        offset += integer(number, &mut Vec::new())?.value;
    }
    let one = names.len() == 1 && !numbers.is_empty();
    one.then(|| u32::try_from(offset).ok())?
}

/// A number in a section that describes no object, in any spelling.
pub fn number(text: &str) -> Option<i128> {
    let mut notes = Vec::new();
    let text = without_comment(text, &mut notes);
    integer(text, &mut notes).map(|number| number.value)
}

#[cfg(test)]
mod tests {
    use alloc::vec;

    use super::*;

    #[track_caller]
    fn number(text: &str, value: impl Into<Option<i128>>, expected: &[Note]) {
        let mut notes = vec![];
        let read = integer(text, &mut notes).map(|n| n.value);
        assert_eq!(read, value.into(), "{text}");
        assert_eq!(notes, expected, "{text}");
    }

    #[test]
    fn integers() {
        number("0", 0, &[]);
        number("000", 0, &[]);
        number("42", 42, &[]);
        number("-42", -42, &[]);
        number("- 0x10", -16, &[]);
        number("0X1f", 31, &[]);
        number("007", 7, &[]);
        number("017", 15, &[Note::Octal]);
        number("08", 8, &[Note::NotOctal]);
        number("0x10L", 16, &[Note::Suffix]);
        number("16UL", 16, &[Note::Suffix]);
        number("5.00", 5, &[Note::Suffix]);
        number("FF", 255, &[Note::BareHex]);
        number("1Fh", 31, &[Note::BareHex]);
        number("80H", 128, &[Note::BareHex]);
        number("FFFF8000", 0xFFFF_8000, &[Note::BareHex]);
        number("18446744073709551615", i128::from(u64::MAX), &[]);
        for text in [
            "",
            "-",
            "0x",
            "x",
            "1 2",
            "--1",
            "0x+1",
            "5.5",
            "1e3",
            "add",
            "h",
            "red",
            "é",
            ".",
            "18446744073709551616",
        ] {
            let mut notes = vec![];
            assert_eq!(integer(text, &mut notes), None, "{text}");
        }
    }

    #[test]
    fn formulas() {
        let read = |text: &str| {
            let mut notes = vec![];
            (node_id(text, &mut notes), notes)
        };
        assert_eq!(read("$NODEID+0x180"), (Some(Ok(0x180)), vec![]));
        assert_eq!(read("$NODEID"), (Some(Ok(0)), vec![]));
        for odd in [
            "$NODEID + 0x180",
            "0x180+$NODEID",
            "$nodeid+384",
            "384 + $NodeId",
        ] {
            assert_eq!(read(odd), (Some(Ok(0x180)), vec![Note::NodeId]), "{odd}");
        }
        for (odd, offset) in [
            ("NODEID+0x180", 0x180),
            ("nodeid", 0),
            ("( $Node_ID + 384 )", 0x180),
            ("0x80000000 + $NODEID + 0x180", 0x8000_0180),
            ("$ NODEID+1", 1),
            ("{$NODEID}+1", 1),
        ] {
            assert_eq!(read(odd), (Some(Ok(offset)), vec![Note::NodeId]), "{odd}");
        }
        assert_eq!(read("$NODEID+017").1, vec![Note::Octal]);
        for bad in [
            "$NODEID+$NODEID",
            "$NODEID-1",
            "2*$NODEID",
            "$NODEID+",
            "$NODEID+0x100000000",
        ] {
            assert_eq!(read(bad).0, Some(Err(())), "{bad}");
        }
        assert_eq!(read("NODE+1").0, None);
    }
}
