//! Numbers as EDS files write them.

use alloc::vec::Vec;

/// What was odd about a value that was understood all the same.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) enum Note {
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
    /// An OCTET_STRING that is no hexadecimal bytes.
    Characters,
    /// `true`, `false`
    Word,
}

/// A number with what was odd about it.
#[derive(Clone, PartialEq, Debug)]
pub(super) struct Number {
    pub(super) value: i128,
    /// Written in hexadecimal, without a sign.
    pub(super) pattern: bool,
}

/// The text in front of a `;` or a `#`.
pub(super) fn before_comment(text: &str) -> &str {
    match text.find([';', '#']) {
        Some(at) => text[..at].trim_end(),
        None => text,
    }
}

/// The text in front of a `;` or a `#`, which is noted.
pub(super) fn without_comment<'a>(text: &'a str, notes: &mut Vec<Note>) -> &'a str {
    match text.find([';', '#']) {
        Some(at) => {
            notes.push(Note::Comment);
            text[..at].trim_end()
        }
        None => text,
    }
}

/// An integer: decimal, `0x` hexadecimal or octal with a leading 0, with a sign.
pub(super) fn integer(text: &str, notes: &mut Vec<Note>) -> Option<Number> {
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
    let (radix, digits) = match hex_digits(digits) {
        Some(digits) => (16, digits),
        None => (decimal_or_octal(digits, notes), digits),
    };
    // from_str_radix would take a second sign.
    if !digits.bytes().all(|b| b.is_ascii_alphanumeric()) {
        return None;
    }
    let magnitude = i128::from(u64::from_str_radix(digits, radix).ok()?);
    Some(Number {
        value: if negative { -magnitude } else { magnitude },
        pattern: radix == 16 && !negative,
    })
}

fn hex_digits(text: &str) -> Option<&str> {
    text.strip_prefix("0x").or_else(|| text.strip_prefix("0X"))
}

/// 8 for `017`, 10 for `17`, `08` and `0`; `007` is the same in both and no news.
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

/// The offset in `$NODEID+n`, in either order, any case and spacing; 0 for `$NODEID`.
///
/// `Some(Err)` is a formula with something else in it.
pub(super) fn node_id(text: &str, notes: &mut Vec<Note>) -> Option<Result<u32, ()>> {
    const NAME: &str = "$NODEID";
    let at = text
        .as_bytes()
        .windows(NAME.len())
        .position(|w| w.eq_ignore_ascii_case(NAME.as_bytes()))?;
    // The name is ASCII, so both cuts are between characters.
    let (before, rest) = text.split_at(at);
    let (name, behind) = rest.split_at(NAME.len());
    let (before, after) = (before.trim(), behind.trim());
    let offset = match (before, after) {
        ("", "") => "0",
        ("", after) => match after.strip_prefix('+') {
            Some(offset) => offset.trim(),
            None => return Some(Err(())),
        },
        (before, "") => match before.strip_suffix('+') {
            Some(offset) => offset.trim(),
            None => return Some(Err(())),
        },
        _ => return Some(Err(())),
    };
    if name != NAME || !before.is_empty() || text.contains(char::is_whitespace) {
        notes.push(Note::NodeId);
    }
    let offset = integer(offset, notes).map(|n| n.value);
    Some(match offset.map(u32::try_from) {
        Some(Ok(offset)) => Ok(offset),
        _ => Err(()),
    })
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
        for bad in [
            "$NODEID-1",
            "2*$NODEID",
            "1+$NODEID+1",
            "$NODEID+",
            "$NODEID+0x100000000",
        ] {
            assert_eq!(read(bad).0, Some(Err(())), "{bad}");
        }
        assert_eq!(read("NODEID+1").0, None);
    }
}
