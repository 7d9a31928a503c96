//! Frames in words.

use od_sim::words;
use od_sim::words::{Service, Words};
use wasm_bindgen::prelude::*;

use crate::bus::Bus;
use crate::crossing::{Crosses, record};
use crate::packed;

record! {
    /// A part of a frame.
    Field {
        /// The first byte.
        from: u8,
        /// The byte after the last.
        to: u8,
        name: String,
        value: String,
        /// The object that it is about, as `index * 256 + sub`.
        object: Option<u32>,
    }
}

#[wasm_bindgen]
impl Bus {
    /// The text of each of these packed frames.
    #[wasm_bindgen(js_name = describeAll)]
    pub fn describe_all(&self, frames: &[u8]) -> Vec<String> {
        let frames = frames.chunks_exact(packed::LEN);
        frames.map(|frame| self.words(frame)).collect()
    }

    /// The fields of a packed frame in order; empty for a disturbed frame.
    #[wasm_bindgen(unchecked_return_type = "Field[]")]
    pub fn fields(&self, frame: &[u8]) -> Vec<JsValue> {
        let known = packed::frame(frame).filter(|_| !packed::is_disturbed(frame));
        let fields = known.map(|frame| words::fields(self.journal.rig.bus.devices(), &frame));
        let field = |one: words::Field| Field {
            from: one.from,
            to: one.to,
            name: one.name,
            value: one.value,
            object: one.object.map(packed::object),
        };
        let fields = fields.unwrap_or_default().into_iter();
        fields.map(|one| field(one).value()).collect()
    }
}

impl Bus {
    /// The text of a packed frame.
    pub(crate) fn words(&self, frame: &[u8]) -> String {
        packed::frame(frame)
            .map(|frame| sentence(words::explain(self.journal.rig.bus.devices(), &frame)))
            .unwrap_or_default()
    }
}

/// The text of a frame, with its node if the CAN-ID does not tell it.
pub(crate) fn sentence(words: Words) -> String {
    let mut text = match (words.service, words.node) {
        (Service::Nmt, Some(node)) => format!("{} node {node}", words.text),
        (Service::ErrorControl | Service::Emcy, Some(node)) => {
            format!("node {node}: {}", words.text)
        }
        _ => words.reason_first.unwrap_or(words.text),
    };
    if let Some(first) = text.get_mut(..1) {
        first.make_ascii_uppercase();
    }
    text
}

#[cfg(test)]
mod tests {
    const GERMAN: &str = include_str!("../web/src/texts/de/words.ts");

    #[test]
    fn every_text_of_an_error_code_is_in_the_german_catalogue() {
        for code in 0..=u16::MAX {
            for profile in [None, Some(402)] {
                let text = od_wire::emcy::text(profile, code);
                let is_there = [format!("\n  '{text}': '"), format!("\n  {text}: '")]
                    .iter()
                    .any(|line| GERMAN.contains(line));
                assert!(is_there, "{code:04X}h: {text}");
            }
        }
    }
}
