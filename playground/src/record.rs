//! Plain JavaScript values: objects, byte arrays, numbers of any width.

use od_sim::journal::{Sink, Value};
use wasm_bindgen::JsCast;
use wasm_bindgen::prelude::*;

#[wasm_bindgen]
extern "C" {
    /// A plain object.
    #[wasm_bindgen(js_name = Object)]
    pub(crate) type Object;

    #[wasm_bindgen(constructor, js_class = "Object")]
    fn empty_object() -> Object;

    #[wasm_bindgen(method, structural, indexing_setter)]
    fn set(this: &Object, key: &str, value: &JsValue);

    #[wasm_bindgen(method, structural, indexing_getter)]
    pub(crate) fn field(this: &Object, key: &str) -> JsValue;

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

    #[wasm_bindgen(method, js_class = "Uint8Array")]
    fn slice(this: &Bytes) -> Vec<u8>;

    /// Numbers that JavaScript owns.
    #[wasm_bindgen(js_name = Float64Array)]
    type Floats;

    #[wasm_bindgen(static_method_of = Floats, js_class = "Float64Array", js_name = from)]
    fn of(values: &Array) -> Vec<f64>;
}

impl Object {
    /// A value as an object, if it is one.
    pub(crate) fn of(value: &JsValue) -> Option<Self> {
        value.is_object().then(|| value.clone().unchecked_into())
    }
}

/// A plain object under construction.
pub(crate) struct Record(Object);

impl Record {
    pub(crate) fn new() -> Self {
        Self(Object::empty_object())
    }

    /// Adds a field.
    // Called for every field of every record: inlined code here adds a kilobyte to the module.
    #[inline(never)]
    pub(crate) fn set(&self, key: &str, value: JsValue) {
        self.0.set(key, &value);
    }

    pub(crate) fn done(self) -> JsValue {
        self.0.into()
    }
}

/// A field of an input, from JavaScript.
pub(crate) fn value(found: &JsValue) -> Value {
    if found.is_undefined() {
        Value::Missing
    } else if let Some(flag) = found.as_bool() {
        Value::Flag(flag)
    } else if let Some(number) = found.as_f64() {
        Value::Number(number)
    } else if let Some(text) = found.as_string() {
        Value::Text(text)
    } else if let Some(bytes) = found.dyn_ref::<Bytes>() {
        Value::Bytes(bytes.slice())
    } else if let Some(numbers) = found.dyn_ref::<Array>() {
        Value::Numbers(Floats::of(numbers))
    } else {
        Value::Null
    }
}

/// Converts a field of an input for JavaScript. A nested field is named `source.name`.
impl Sink for Record {
    fn put(&mut self, key: &str, value: Value) {
        let value = match value {
            Value::Missing => return,
            Value::Null => JsValue::NULL,
            Value::Flag(flag) => flag.into(),
            Value::Number(number) => number.into(),
            Value::Text(text) => text.into(),
            Value::Bytes(all) => bytes(&all),
            Value::Numbers(all) => list(all.into_iter().map(JsValue::from)),
        };
        let Some((outer, inner)) = key.split_once('.') else {
            return self.0.set(key, &value);
        };
        let object = Object::of(&self.0.field(outer)).unwrap_or_else(Object::empty_object);
        object.set(inner, &value);
        self.0.set(outer, &object);
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

/// The largest integer below which all integers are exact JavaScript numbers.
const SAFE: i128 = (1 << 53) - 1;

/// An integer: a number if that is exact, otherwise a bigint.
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
