//! EDS and DCF texts, and their findings.

use wasm_bindgen::prelude::*;

use crate::crossing::Crosses;
use crate::diagnostics::finding;
use crate::places::Places;

/// Returns the findings of an EDS or DCF text.
#[wasm_bindgen(js_name = checkEds, unchecked_return_type = "Diagnostic[]")]
pub fn check_eds(text: &str) -> Vec<JsValue> {
    let places = Places::of(text);
    od_eds::load(text)
        .findings
        .iter()
        .map(|one| finding(one, &places).value())
        .collect()
}

/// The text after its safe fixes, or also after unsafe fixes.
#[wasm_bindgen(js_name = fixEds)]
pub fn fix_eds(text: &str, guess: bool) -> String {
    use od_eds::fix::{Applicability, fix};
    let level = if guess {
        Applicability::Unsafe
    } else {
        Applicability::Safe
    };
    let document = od_eds::Document::new(text);
    let fixed = fix(&document, level, |document| document.load().findings);
    fixed.document.text().into()
}

/// Returns the kind of a device file of another fieldbus, such as `an ESI file of EtherCAT`; `undefined` for any other text.
#[wasm_bindgen(js_name = foreignFile)]
pub fn foreign_file(text: &str) -> Option<String> {
    od_eds::foreign(text).map(Into::into)
}

/// The text in the bytes of an EDS or DCF file: UTF-8, UTF-16 or Windows-1252.
#[wasm_bindgen(js_name = decodeEds)]
pub fn decode_eds(bytes: &[u8]) -> String {
    od_eds::decode(bytes).into()
}
