//! Fixes of findings, by places that JavaScript counts: UTF-16 units of the text.

use od_eds::fix::{Applicability, Fix};
use wasm_bindgen::prelude::*;

use crate::record::{self, Record};

/// Map from the bytes of a text to the string that JavaScript has.
pub(crate) struct Places<'a> {
    text: &'a str,
    /// Units before each byte; empty where all is ASCII and the two are the same.
    units: Vec<u32>,
}

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

    /// The edits that fix a finding, or null.
    pub(crate) fn fix(&self, fix: Option<&Fix>) -> JsValue {
        let Some((fix, edits)) = fix.and_then(|fix| Some((fix, fix.text_edits(self.text)?))) else {
            return JsValue::NULL;
        };
        let edits = edits.into_iter().map(|edit| {
            Record::new()
                .with("start", self.unit(edit.start))
                .with("end", self.unit(edit.end))
                .with("text", edit.text)
                .done()
        });
        Record::new()
            .with("safe", fix.applicability == Applicability::Safe)
            .with("edits", record::list(edits))
            .done()
    }
}

#[cfg(test)]
mod tests {
    use super::Places;

    #[test]
    fn units_are_those_of_javascript() {
        let places = Places::of("aµ😀b");
        assert_eq!(
            [0, 1, 3, 7, 8].map(|byte| places.unit(byte)),
            [0, 1, 2, 4, 5]
        );
        assert_eq!(Places::of("plain").unit(3), 3);
    }
}
