//! Converts bytes to text and back, in the encoding of the file.

use alloc::borrow::Cow;
use alloc::string::String;
use alloc::vec::Vec;
use core::fmt;

/// Encoding of a file.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Default)]
pub enum Encoding {
    /// ASCII only: the subset of all encodings except UTF-16, and the encoding of CiA 306.
    #[default]
    Ascii,
    /// UTF-8.
    Utf8,
    /// Windows-1252, the encoding of most 8-bit files; it equals ISO 8859-1 except for 80h–9Fh.
    Windows1252,
    /// UTF-16, low byte first.
    Utf16Le,
    /// UTF-16, high byte first.
    Utf16Be,
}

impl Encoding {
    /// The usual name, for example `UTF-16LE`.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Ascii => "ASCII",
            Self::Utf8 => "UTF-8",
            Self::Windows1252 => "Windows-1252",
            Self::Utf16Le => "UTF-16LE",
            Self::Utf16Be => "UTF-16BE",
        }
    }

    /// Appends the bytes of a character to `bytes`; `false` if the encoding does not have it.
    pub(crate) fn push(self, c: char, bytes: &mut Vec<u8>) -> bool {
        match self {
            // With this character, an ASCII file becomes UTF-8.
            Self::Ascii | Self::Utf8 => {
                bytes.extend_from_slice(c.encode_utf8(&mut [0; 4]).as_bytes());
            }
            Self::Windows1252 => match (0..=0xFF).find(|byte| windows_1252(*byte) == c) {
                Some(byte) => bytes.push(byte),
                None => return false,
            },
            Self::Utf16Le | Self::Utf16Be => {
                for unit in c.encode_utf16(&mut [0; 2]) {
                    bytes.extend_from_slice(&match self {
                        Self::Utf16Le => unit.to_le_bytes(),
                        _ => unit.to_be_bytes(),
                    });
                }
            }
        }
        true
    }

    /// The first character of `bytes`, and the number of its bytes (0 at the end).
    ///
    /// An invalid byte becomes U+FFFD. In UTF-8 it becomes the Windows-1252 character of the byte,
    /// since a byte of another encoding is the likeliest reason.
    pub(crate) fn next(self, bytes: &[u8]) -> (char, usize) {
        const WRONG: char = char::REPLACEMENT_CHARACTER;
        let Some(&first) = bytes.first() else {
            return (WRONG, 0);
        };
        match self {
            Self::Ascii | Self::Utf8 => {
                let longest = &bytes[..bytes.len().min(4)];
                let valid = match core::str::from_utf8(longest) {
                    Ok(text) => text,
                    Err(error) => {
                        core::str::from_utf8(&longest[..error.valid_up_to()]).unwrap_or_default()
                    }
                };
                match valid.chars().next() {
                    Some(c) => (c, c.len_utf8()),
                    None => (windows_1252(first), 1),
                }
            }
            Self::Windows1252 => (windows_1252(first), 1),
            Self::Utf16Le | Self::Utf16Be => {
                let unit = |at: usize| match (bytes.get(at), bytes.get(at + 1)) {
                    (Some(&a), Some(&b)) if self == Self::Utf16Le => {
                        Some(u16::from_le_bytes([a, b]))
                    }
                    (Some(&a), Some(&b)) => Some(u16::from_be_bytes([a, b])),
                    _ => None,
                };
                let units = [unit(0), unit(2)].into_iter().map_while(|unit| unit);
                match char::decode_utf16(units).next() {
                    Some(Ok(c)) => (c, 2 * c.len_utf16()),
                    Some(Err(_)) => (WRONG, 2),
                    // A file that ends in the middle of a unit.
                    None => (WRONG, 1),
                }
            }
        }
    }
}

impl fmt::Display for Encoding {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(self.name())
    }
}

/// The encoding of a file, and the number of bytes of its byte order mark.
///
/// The mark decides. Without a mark, zero bytes show UTF-16; a valid UTF-8 file is UTF-8, and any
/// other file is Windows-1252.
pub(crate) fn detect(bytes: &[u8]) -> (Encoding, usize) {
    match bytes {
        [0xEF, 0xBB, 0xBF, ..] => (Encoding::Utf8, 3),
        [0xFF, 0xFE, ..] => (Encoding::Utf16Le, 2),
        [0xFE, 0xFF, ..] => (Encoding::Utf16Be, 2),
        _ => {
            let encoding = match utf16_without_mark(bytes) {
                Some(utf16) => utf16,
                None if bytes.is_ascii() => Encoding::Ascii,
                None if core::str::from_utf8(bytes).is_ok() => Encoding::Utf8,
                None => Encoding::Windows1252,
            };
            (encoding, 0)
        }
    }
}

/// Nearly every second byte of such a text is zero, and few of the other bytes are.
fn utf16_without_mark(bytes: &[u8]) -> Option<Encoding> {
    let pairs = bytes.chunks_exact(2).take(2048);
    let (mut count, mut first, mut second) = (0usize, 0usize, 0usize);
    for pair in pairs {
        count += 1;
        first += usize::from(pair[0] == 0);
        second += usize::from(pair[1] == 0);
    }
    let most = |zeros: usize| count >= 2 && zeros * 10 >= count * 7;
    let few = |zeros: usize| zeros * 10 <= count;
    match (first, second) {
        (a, b) if few(a) && most(b) => Some(Encoding::Utf16Le),
        (a, b) if most(a) && few(b) => Some(Encoding::Utf16Be),
        _ => None,
    }
}

/// The text of a file: by its byte order mark, otherwise as UTF-16 or UTF-8 if it is valid,
/// otherwise as Windows-1252. [`Document`](crate::Document) converts it back.
///
/// Never fails. The mark is not part of the text; an invalid byte becomes U+FFFD.
pub fn decode(bytes: &[u8]) -> Cow<'_, str> {
    let (encoding, mark) = detect(bytes);
    let rest = &bytes[mark..];
    if matches!(encoding, Encoding::Ascii | Encoding::Utf8)
        && let Ok(text) = core::str::from_utf8(rest)
    {
        return text.into();
    }
    let mut text = String::with_capacity(rest.len());
    let mut at = 0;
    while at < rest.len() {
        let (c, len) = encoding.next(&rest[at..]);
        text.push(c);
        at += len;
    }
    text.into()
}

/// The five bytes without a character become the control characters with the same numbers.
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
    fn the_mark_decides_and_then_the_bytes() {
        assert_eq!(decode(b"\xEF\xBB\xBFa\xC2\xB5"), "aµ");
        assert_eq!(decode(b"\xFF\xFEa\0\xB5\0"), "aµ");
        assert_eq!(decode(b"\xFE\xFF\0a\0\xB5"), "aµ");
        assert_eq!(decode(b"[\0a\0]\0\n\0"), "[a]\n");
        assert_eq!(decode(b"\0[\0a\0]\0\n"), "[a]\n");
        assert_eq!(decode(b"a\xC2\xB5"), "aµ");
        assert_eq!(decode(b"a\xB5\x80\x92"), "aµ€’");
        assert!(matches!(decode(b"plain"), Cow::Borrowed("plain")));
    }

    #[test]
    fn an_invalid_byte_loses_nothing_else() {
        assert_eq!(decode(b"\xFF\xFEa\0b"), "a\u{FFFD}");
        assert_eq!(decode(b"\xFF\xFE\0\xD8a\0"), "\u{FFFD}a");
        assert_eq!(decode(b"\xFF\xFE\x3D\xD8\0\xDE"), "😀");
        // A single byte of another encoding in a UTF-8 file.
        assert_eq!(decode(b"\xEF\xBB\xBF\xC2\xB5 \xB5\xC2"), "µ µÂ");
        assert_eq!(decode(b"\xFE\xFF\xD8\x00"), "\u{FFFD}");
        assert_eq!(decode(b""), "");
        assert_eq!(decode(b"\0\0\0\0"), "\0\0\0\0");
    }

    #[test]
    fn every_character_has_its_bytes() {
        for encoding in [
            Encoding::Utf8,
            Encoding::Windows1252,
            Encoding::Utf16Le,
            Encoding::Utf16Be,
        ] {
            for c in ['a', '\n', 'µ', '\u{81}', '’'] {
                let mut bytes = Vec::new();
                assert!(encoding.push(c, &mut bytes));
                assert_eq!(encoding.next(&bytes), (c, bytes.len()), "{encoding}");
            }
        }
        assert!(!Encoding::Windows1252.push('😀', &mut Vec::new()));
        assert_eq!(Encoding::Utf16Be.next(&[]).1, 0);
    }
}
