//! Positions in a text in UTF-16 units, as in JavaScript; the edits of a fix with such positions.

use crate::crossing::record;
#[cfg(feature = "eds")]
use od_eds::fix;

record! {
    /// Edits of the checked text; all of them are applied, or none.
    Fix {
        /// A safe fix: the meaning of the text does not change.
        safe: bool,
        edits: Vec<TextEdit>,
    }

    /// `text` replaces the range from `start` to before `end`, as in `String.slice`.
    TextEdit {
        start: u32,
        end: u32,
        text: String,
    }
}

/// Maps bytes of a text to units of the JavaScript string.
#[cfg(feature = "eds")]
pub(crate) struct Places<'a> {
    text: &'a str,
    /// Units before each byte; empty if the text is ASCII.
    units: Vec<u32>,
}

#[cfg(feature = "eds")]
impl<'a> Places<'a> {
    pub(crate) fn of(text: &'a str) -> Self {
        let mut units = Vec::new();
        if !text.is_ascii() {
            let mut before = 0;
            for c in text.chars() {
                units.extend(std::iter::repeat_n(before, c.len_utf8()));
                before += if c.len_utf16() == 2 { 2 } else { 1 };
            }
            units.push(before);
        }
        Self { text, units }
    }

    fn unit(&self, byte: u32) -> u32 {
        self.units.get(byte as usize).copied().unwrap_or(byte)
    }

    /// The edits that fix a finding.
    pub(crate) fn fix(&self, fix: &fix::Fix) -> Option<Fix> {
        let edits = fix.text_edits(self.text)?.into_iter().map(|edit| TextEdit {
            start: self.unit(edit.start),
            end: self.unit(edit.end),
            text: edit.text,
        });
        Some(Fix {
            safe: fix.applicability == fix::Applicability::Safe,
            edits: edits.collect(),
        })
    }
}

#[cfg(test)]
mod tests {
    use super::Places;

    #[test]
    fn positions_are_those_of_javascript() {
        let places = Places::of("aµ😀b");
        assert_eq!(
            [0, 1, 3, 7, 8].map(|byte| places.unit(byte)),
            [0, 1, 2, 4, 5]
        );
        assert_eq!(Places::of("plain").unit(3), 3);
    }
}
