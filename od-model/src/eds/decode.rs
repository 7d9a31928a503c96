//! From bytes to text, whatever the encoding.

use alloc::borrow::Cow;
use alloc::string::String;

/// The text of a file: by its byte order mark, else UTF-8, else Windows-1252.
///
/// Never fails. A mark is not part of the text; what is no character becomes U+FFFD.
pub fn decode(bytes: &[u8]) -> Cow<'_, str> {
    match bytes {
        [0xEF, 0xBB, 0xBF, rest @ ..] => String::from_utf8_lossy(rest),
        [0xFF, 0xFE, rest @ ..] => utf16(rest, u16::from_le_bytes).into(),
        [0xFE, 0xFF, rest @ ..] => utf16(rest, u16::from_be_bytes).into(),
        _ => match core::str::from_utf8(bytes) {
            Ok(text) => text.into(),
            Err(_) => bytes.iter().copied().map(windows_1252).collect(),
        },
    }
}

fn utf16(bytes: &[u8], unit: fn([u8; 2]) -> u16) -> String {
    let units = bytes.chunks(2).map(|pair| match *pair {
        [a, b] => unit([a, b]),
        // A file cut in the middle of a unit.
        _ => 0xFFFD,
    });
    char::decode_utf16(units)
        .map(|c| c.unwrap_or(char::REPLACEMENT_CHARACTER))
        .collect()
}

/// The five bytes without a character there are the control characters of that number.
fn windows_1252(byte: u8) -> char {
    const C1: [char; 32] = [
        '€', '\u{81}', '‚', 'ƒ', '„', '…', '†', '‡', 'ˆ', '‰', 'Š', '‹', 'Œ', '\u{8D}', 'Ž',
        '\u{8F}', '\u{90}', '‘', '’', '“', '”', '•', '–', '—', '˜', '™', 'š', '›', 'œ', '\u{9D}',
        'ž', 'Ÿ',
    ];
    match byte {
        0x80..=0x9F => C1[usize::from(byte - 0x80)],
        _ => char::from(byte),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_mark_decides_then_the_bytes() {
        assert_eq!(decode(b"\xEF\xBB\xBFa\xC2\xB5"), "aµ");
        assert_eq!(decode(b"\xFF\xFEa\0\xB5\0"), "aµ");
        assert_eq!(decode(b"\xFE\xFF\0a\0\xB5"), "aµ");
        assert_eq!(decode(b"a\xC2\xB5"), "aµ");
        assert_eq!(decode(b"a\xB5\x80\x92"), "aµ€’");
        assert!(matches!(decode(b"plain"), Cow::Borrowed("plain")));
    }

    #[test]
    fn cut_files_end_in_a_replacement() {
        assert_eq!(decode(b"\xFF\xFEa\0b"), "a\u{FFFD}");
        assert_eq!(decode(b"\xEF\xBB\xBFa\xC2"), "a\u{FFFD}");
        assert_eq!(decode(b"\xFE\xFF\xD8\x00"), "\u{FFFD}");
        assert_eq!(decode(b""), "");
    }
}
