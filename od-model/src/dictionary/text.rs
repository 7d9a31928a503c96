//! Texts and bytes of a dictionary.

use super::{Dictionary, NAME};
use crate::value::{Literal, Range};

impl<'a> Dictionary<'a> {
    /// The text of a range: a name or a VISIBLE_STRING.
    pub fn text(&self, range: Range) -> &'a str {
        #[cfg(feature = "names")]
        let arena = if range.start & NAME != 0 {
            self.names.text
        } else {
            self.arenas.text
        };
        #[cfg(not(feature = "names"))]
        let arena = self.arenas.text;
        let start = (range.start & !NAME) as usize;
        arena
            .get(start..start.saturating_add(range.len as usize))
            .unwrap_or("")
    }

    /// The bytes of a range: an OCTET_STRING or a DOMAIN.
    pub fn blob(&self, range: Range) -> &'a [u8] {
        range.of(self.arenas.blob)
    }

    /// The bytes of a string-like literal; empty for numbers.
    pub fn literal_bytes(&self, literal: Literal) -> &'a [u8] {
        match literal {
            Literal::Text(range) => self.text(range).as_bytes(),
            Literal::Bytes(range) => self.blob(range),
            _ => &[],
        }
    }
}
