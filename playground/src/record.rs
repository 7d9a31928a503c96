//! Plain JavaScript values: objects, byte arrays, numbers of any width.

use wasm_bindgen::prelude::*;

#[wasm_bindgen]
extern "C" {
    /// A plain object.
    #[wasm_bindgen(js_name = Object)]
    type Object;

    #[wasm_bindgen(constructor, js_class = "Object")]
    fn empty_object() -> Object;

    #[wasm_bindgen(method, structural, indexing_setter)]
    fn set(this: &Object, key: &str, value: &JsValue);

    /// An array.
    #[wasm_bindgen(js_name = Array)]
    type Array;

    #[wasm_bindgen(constructor, js_class = "Array")]
    fn empty_array() -> Array;

    #[wasm_bindgen(method)]
    fn push(this: &Array, value: &JsValue) -> u32;

    /// Bytes that JavaScript owns.
    #[wasm_bindgen(js_name = Uint8Array)]
    type Bytes;

    #[wasm_bindgen(constructor, js_class = "Uint8Array")]
    fn copy_of(bytes: &[u8]) -> Bytes;
}

/// A plain object under construction.
pub(crate) struct Record(Object);

impl Record {
    pub(crate) fn new() -> Self {
        Self(Object::empty_object())
    }

    /// Adds a field.
    pub(crate) fn with(self, key: &str, value: impl Into<JsValue>) -> Self {
        self.0.set(key, &value.into());
        self
    }

    pub(crate) fn done(self) -> JsValue {
        self.0.into()
    }
}

/// Values as an array.
pub(crate) fn list(values: impl Iterator<Item = JsValue>) -> JsValue {
    let array = Array::empty_array();
    for value in values {
        array.push(&value);
    }
    array.into()
}

/// Bytes as a `Uint8Array`.
pub(crate) fn bytes(bytes: &[u8]) -> JsValue {
    Bytes::copy_of(bytes).into()
}

/// The largest integer up to which every one is a JavaScript number.
const SAFE: i128 = (1 << 53) - 1;

/// An integer: a number where that is exact, else a bigint.
pub(crate) fn integer(value: i128) -> JsValue {
    if value.abs() <= SAFE {
        JsValue::from_f64(value as f64)
    } else {
        match u64::try_from(value) {
            Ok(value) => value.into(),
            Err(_) => (value as i64).into(),
        }
    }
}
