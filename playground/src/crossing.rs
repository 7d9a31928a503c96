//! Types that are passed to JavaScript, each written once: a [`record!`] is the Rust type, the plain object that is made
//! of it, and its declaration in TypeScript. wasm-bindgen writes the declarations into `od_playground.d.ts`; they are
//! put together at compile time, so no module contains them.

use std::marker::PhantomData;

use wasm_bindgen::JsValue;

use crate::record::{Record, bytes, list};

/// A type whose values are passed to JavaScript.
pub(crate) trait Crosses: Sized {
    /// `?` after the name of a field that may be missing.
    const MARK: &'static str = "";
    /// The type in TypeScript.
    const TYPE: &'static str;

    /// The value in JavaScript.
    fn value(self) -> JsValue;

    /// Adds the value to a record.
    fn put(self, key: &str, record: &Record) {
        record.set(key, self.value());
    }
}

macro_rules! crosses {
    ($($kind:ty => $type:literal, $value:expr;)*) => {
        $(impl Crosses for $kind {
            const TYPE: &'static str = $type;

            fn value(self) -> JsValue {
                let value: fn(Self) -> JsValue = $value;
                value(self)
            }
        })*
    };
}

crosses! {
    bool => "boolean", JsValue::from;
    u8 => "number", JsValue::from;
    u16 => "number", JsValue::from;
    u32 => "number", JsValue::from;
    f64 => "number", JsValue::from;
    usize => "number", |number| JsValue::from_f64(number as f64);
    &str => "string", JsValue::from;
    String => "string", JsValue::from;
    Bytes => "Uint8Array", |Bytes(all)| bytes(&all);
}

/// Bytes, not as a list of numbers.
pub(crate) struct Bytes(pub(crate) Vec<u8>);

impl From<&[u8]> for Bytes {
    fn from(all: &[u8]) -> Self {
        Self(all.into())
    }
}

/// A JavaScript value with the type that `T` declares.
#[derive(Clone)]
pub(crate) struct Made<T>(JsValue, PhantomData<T>);

impl<T> Made<T> {
    pub(crate) const fn of(value: JsValue) -> Self {
        Self(value, PhantomData)
    }
}

impl<T: Crosses> Made<Vec<T>> {
    /// A list that only exists in JavaScript.
    pub(crate) fn list(values: impl Iterator<Item = T>) -> Self {
        Self::of(list(values.map(Crosses::value)))
    }
}

impl<T: Crosses> Crosses for Made<T> {
    const MARK: &'static str = T::MARK;
    const TYPE: &'static str = T::TYPE;

    fn value(self) -> JsValue {
        self.0
    }
}

/// A field that exists only if it has a value.
#[cfg(feature = "lessons")]
pub(crate) struct Maybe<T>(pub(crate) Option<T>);

#[cfg(feature = "lessons")]
impl<T: Crosses> Crosses for Maybe<T> {
    const MARK: &'static str = "?";
    const TYPE: &'static str = T::TYPE;

    fn value(self) -> JsValue {
        self.0.map_or(JsValue::UNDEFINED, Crosses::value)
    }

    fn put(self, key: &str, record: &Record) {
        if let Some(value) = self.0 {
            value.put(key, record);
        }
    }
}

/// A field that only other records of the same choice have.
pub(crate) struct Absent;

impl Crosses for Absent {
    const MARK: &'static str = "?";
    const TYPE: &'static str = "undefined";

    fn value(self) -> JsValue {
        JsValue::UNDEFINED
    }

    fn put(self, _: &str, _: &Record) {}
}

/// Names of types that are derived from another one.
struct Of<T>(PhantomData<T>);

impl<T: Crosses> Of<T> {
    const OR_NULL: Name = Name::joined(&[T::TYPE, " | null"]);
    const LIST: Name = Name::joined(&[T::TYPE, "[]"]);
}

impl<T: Crosses> Crosses for Option<T> {
    const TYPE: &'static str = Of::<T>::OR_NULL.text();

    fn value(self) -> JsValue {
        self.map_or(JsValue::NULL, Crosses::value)
    }
}

impl<T: Crosses> Crosses for Vec<T> {
    const TYPE: &'static str = Of::<T>::LIST.text();

    fn value(self) -> JsValue {
        Made::list(self.into_iter()).value()
    }
}

/// The name of a type.
struct Name {
    bytes: [u8; 80],
    len: usize,
}

impl Name {
    const fn joined(parts: &[&str]) -> Self {
        let (bytes, len) = (joined(parts), length(parts));
        Self { bytes, len }
    }

    const fn text(&'static self) -> &'static str {
        text(self.bytes.split_at(self.len).0)
    }
}

/// Length of the joined texts.
pub(crate) const fn length(mut parts: &[&str]) -> usize {
    let mut length = 0;
    while let [first, rest @ ..] = parts {
        length += first.len();
        parts = rest;
    }
    length
}

/// Joins texts; does not compile if they are longer than `N`.
pub(crate) const fn joined<const N: usize>(mut parts: &[&str]) -> [u8; N] {
    let (mut bytes, mut at) = ([0; N], 0);
    while let [first, rest @ ..] = parts {
        let mut from = first.as_bytes();
        while let [byte, others @ ..] = from {
            bytes[at] = *byte;
            at += 1;
            from = others;
        }
        parts = rest;
    }
    bytes
}

/// The result of [`joined`].
pub(crate) const fn text(bytes: &[u8]) -> &str {
    match str::from_utf8(bytes) {
        Ok(text) => text,
        Err(_) => unreachable!(),
    }
}

/// Texts of the file of declarations.
macro_rules! declaration {
    ($first:expr, $($part:expr),+ $(,)?) => {
        $crate::crossing::declaration!(&[$first, $($part),+]);
    };
    ($parts:expr) => {
        const _: () = {
            const PARTS: &[&str] = $parts;
            const BYTES: [u8; $crate::crossing::length(PARTS)] = $crate::crossing::joined(PARTS);

            // Compiled everywhere, so that a build for the computer itself finds errors.
            const _: &str = $crate::crossing::text(&BYTES);

            #[wasm_bindgen::prelude::wasm_bindgen(typescript_custom_section)]
            const DECLARATION: &str = $crate::crossing::text(&BYTES);
        };
    };
}
pub(crate) use declaration;

/// A doc comment in TypeScript.
macro_rules! about {
    ($indent:literal) => { "" };
    ($indent:literal $($line:literal)+) => { concat!($indent, "/**", $($line,)+ " */\n") };
}
pub(crate) use about;

/// The name of a field in JavaScript: that of the Rust field unless another is given.
macro_rules! key {
    ($field:ident) => {
        stringify!($field)
    };
    ($field:ident $key:literal) => {
        $key
    };
}
pub(crate) use key;

/// Records. A field can have another name in JavaScript than in Rust.
macro_rules! record {
    ($($(#[doc = $about:literal])* $name:ident {
        $($(#[doc = $doc:literal])* $($key:literal)? $field:ident: $kind:ty,)*
    })*) => {
        $(
            $(#[doc = $about])*
            pub(crate) struct $name {
                $($(#[doc = $doc])* pub(crate) $field: $kind,)*
            }

            impl $crate::crossing::Crosses for $name {
                const TYPE: &'static str = stringify!($name);

                fn value(self) -> wasm_bindgen::JsValue {
                    let record = $crate::record::Record::new();
                    $($crate::crossing::Crosses::put(
                        self.$field,
                        $crate::crossing::key!($field $($key)?),
                        &record,
                    );)*
                    record.done()
                }
            }

            $crate::crossing::declaration!(
                $crate::crossing::about!("" $($about)*),
                "export interface ", stringify!($name), " {\n",
                $(
                    $crate::crossing::about!("  " $($doc)*),
                    "  ", $crate::crossing::key!($field $($key)?),
                    <$kind as $crate::crossing::Crosses>::MARK, ": ",
                    <$kind as $crate::crossing::Crosses>::TYPE, ";\n",
                )*
                "}\n",
            );
        )*
    };
}
pub(crate) use record;

/// A type that is one of a few words.
macro_rules! words {
    ($($(#[doc = $about:literal])* $name:ident { $($word:ident = $text:expr,)* })*) => {
        $(
            $(#[doc = $about])*
            #[derive(Clone, Copy)]
            #[allow(dead_code)] // a module without a feature does not say all of them
            pub(crate) enum $name { $($word,)* }

            impl $name {
                /// The word.
                pub(crate) const fn text(self) -> &'static str {
                    match self { $(Self::$word => $text,)* }
                }
            }

            impl $crate::crossing::Crosses for $name {
                const TYPE: &'static str = stringify!($name);

                fn value(self) -> wasm_bindgen::JsValue {
                    self.text().into()
                }
            }

            $crate::crossing::declaration!(
                $crate::crossing::about!("" $($about)*),
                "export type ", stringify!($name), " =", $(" | '", $text, "'",)* ";\n",
            );
        )*
    };
}
pub(crate) use words;

/// A choice of records.
macro_rules! choice {
    ($($(#[doc = $about:literal])* $name:ident { $($kind:ident,)* })*) => {
        $(
            $(#[doc = $about])*
            pub(crate) enum $name { $($kind($kind),)* }

            impl $crate::crossing::Crosses for $name {
                const TYPE: &'static str = stringify!($name);

                fn value(self) -> wasm_bindgen::JsValue {
                    match self { $(Self::$kind(one) => $crate::crossing::Crosses::value(one),)* }
                }
            }

            $crate::crossing::declaration!(
                $crate::crossing::about!("" $($about)*),
                "export type ", stringify!($name), " =", $(" | ", stringify!($kind),)* ";\n",
            );
        )*
    };
}
pub(crate) use choice;

/// An enum of another crate, by the names of its variants.
macro_rules! names {
    ($($(#[doc = $about:literal])* $name:ident: $kind:ty { $($word:ident,)* })*) => {
        $(
            impl $crate::crossing::Crosses for $kind {
                const TYPE: &'static str = stringify!($name);

                fn value(self) -> wasm_bindgen::JsValue {
                    // All variants are declared.
                    match self { $(Self::$word => {})* }
                    self.name().into()
                }
            }

            $crate::crossing::declaration!(
                $crate::crossing::about!("" $($about)*),
                "export type ", stringify!($name), " =", $(" | '", <$kind>::$word.name(), "'",)* ";\n",
            );
        )*
    };
}
pub(crate) use names;
