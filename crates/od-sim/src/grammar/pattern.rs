//! A frame with gaps, for `expect` lines.

use std::prelude::v1::*;
use std::{fmt, format};

use od_runtime::{CanId, Frame};

use super::problem::Problem;
use crate::logs::candump;

/// A CAN-ID, and bytes with gaps.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct Pattern {
    id: CanId,
    /// `None`: a remote frame of any length.
    bytes: Option<Vec<Option<u8>>>,
    /// Further bytes may follow.
    open: bool,
}

const HELP: &str = "write bytes as two hex digits, `..` or `xx` for any byte, `*` for any rest";

impl Pattern {
    /// Reads `581#43 02 60 00 .. xx *`, `701#R`, `080#`.
    ///
    /// # Errors
    /// [`Problem`] names the first invalid character.
    pub fn parse(text: &str) -> Result<Self, Problem> {
        let text = text.trim();
        let Some((id, data)) = text.split_once('#') else {
            return Err(Problem::at(
                1,
                format!("`{text}` has no `#`"),
                "write a frame such as 581#60 *",
            ));
        };
        let start = id.chars().count() + 2;
        let id = candump::parse_id(id)?;
        if data.trim() == "R" {
            return Ok(Self {
                id,
                bytes: None,
                open: false,
            });
        }
        let mut pattern = Self {
            id,
            bytes: None,
            open: false,
        };
        let mut bytes = Vec::new();
        let mut chars = data.chars().enumerate().filter(|(_, c)| !c.is_whitespace());
        while let Some((at, first)) = chars.next() {
            let column = start + at;
            if pattern.open {
                return Err(Problem::at(column, "unexpected byte after `*`", HELP));
            }
            if first == '*' {
                pattern.open = true;
                continue;
            }
            let pair = [Some(first), chars.next().map(|(_, c)| c)];
            bytes.push(match pair {
                [Some('.'), Some('.')] | [Some('x' | 'X'), Some('x' | 'X')] => None,
                [Some(high), Some(low)] => match (high.to_digit(16), low.to_digit(16)) {
                    (Some(high), Some(low)) => Some((high << 4 | low) as u8),
                    _ => {
                        return Err(Problem::at(
                            column,
                            format!("`{high}{low}` is not a byte"),
                            HELP,
                        ));
                    }
                },
                _ => return Err(Problem::at(column, "half a byte", HELP)),
            });
            if bytes.len() > 8 {
                return Err(Problem::at(column, "more than 8 bytes", HELP));
            }
        }
        pattern.bytes = Some(bytes);
        Ok(pattern)
    }

    /// A pattern that no frame of a device matches: an NMT command without bytes.
    pub(crate) const NOTHING: Self = Self {
        id: CanId::standard(0),
        bytes: None,
        open: false,
    };

    /// The CAN-ID.
    pub const fn id(&self) -> CanId {
        self.id
    }

    /// Its bytes, `None` for a gap; a remote frame has no bytes.
    pub fn bytes(&self) -> Option<&[Option<u8>]> {
        self.bytes.as_deref()
    }

    /// Returns whether further bytes may follow.
    pub const fn is_open(&self) -> bool {
        self.open
    }

    /// Returns whether a frame matches.
    pub fn matches(&self, frame: &Frame) -> bool {
        let Some(bytes) = &self.bytes else {
            return frame.id() == self.id && frame.is_remote();
        };
        let data = frame.data();
        let long_enough = if self.open {
            data.len() >= bytes.len()
        } else {
            data.len() == bytes.len()
        };
        frame.id() == self.id
            && !frame.is_remote()
            && long_enough
            && bytes
                .iter()
                .zip(data)
                .all(|(want, is)| want.is_none_or(|want| want == *is))
    }
}

impl fmt::Display for Pattern {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}#", self.id)?;
        let Some(bytes) = &self.bytes else {
            return f.write_str("R");
        };
        for byte in bytes {
            match byte {
                Some(byte) => write!(f, "{byte:02X}")?,
                None => f.write_str("..")?,
            }
        }
        f.write_str(if self.open { "*" } else { "" })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_gap_matches_any_byte() {
        let frame = candump::parse_frame("581#4302600000000020").expect("a frame");
        for (text, holds) in [
            ("581#43 02 60 00 00 00 00 20", true),
            ("581#43026000..xx..20", true),
            ("581#43*", true),
            ("581#*", true),
            ("581#43026000", false),
            ("582#*", false),
            ("581#R", false),
            ("581#44*", false),
        ] {
            let pattern = Pattern::parse(text).expect(text);
            assert_eq!(pattern.matches(&frame), holds, "{text}");
            assert_eq!(Pattern::parse(&pattern.to_string()), Ok(pattern), "{text}");
        }
        let remote = candump::parse_frame("701#R4").expect("a frame");
        assert!(Pattern::parse("701#R").expect("a pattern").matches(&remote));
        for text in [
            "581",
            "581#4",
            "581#zz",
            "581#.",
            "581#*40",
            "581#11 22 33 44 55 66 77 88 99",
        ] {
            assert!(Pattern::parse(text).is_err(), "{text}");
        }
    }
}
