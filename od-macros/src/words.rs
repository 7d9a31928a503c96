//! The words that a field may have, and which one was meant by another.

use od_model::{Access, DataType, Group, ObjectCode};
use proc_macro2::Ident;
use syn::ext::IdentExt;
use syn::parse::ParseStream;

use crate::names::distance;

/// One field's vocabulary.
pub(crate) struct Words<T: 'static> {
    what: &'static str,
    /// Words that a help text lists.
    shown: &'static [&'static str],
    of: fn(&str) -> Option<T>,
    /// Words of other languages, and what they mean here.
    foreign: &'static [(&'static str, &'static str)],
}

pub(crate) const TYPES: Words<DataType> = Words {
    what: "a data type",
    shown: &[
        "bool",
        "u8",
        "u16",
        "u32",
        "u64",
        "i8",
        "i16",
        "i32",
        "i64",
        "f32",
        "f64",
        "str",
        "UNSIGNED24",
        "UNSIGNED40",
        "UNSIGNED48",
        "UNSIGNED56",
        "INTEGER24",
        "INTEGER40",
        "INTEGER48",
        "INTEGER56",
        "TIME_OF_DAY",
        "TIME_DIFFERENCE",
        "OCTET_STRING",
        "UNICODE_STRING",
        "DOMAIN",
    ],
    of: data_type,
    foreign: &[
        ("uint8", "u8"),
        ("uint16", "u16"),
        ("uint32", "u32"),
        ("uint64", "u64"),
        ("int8", "i8"),
        ("int16", "i16"),
        ("int32", "i32"),
        ("int64", "i64"),
        ("byte", "u8"),
        ("word", "u16"),
        ("dword", "u32"),
        ("usize", "u32"),
        ("isize", "i32"),
        ("boolean", "bool"),
        ("float", "f32"),
        ("double", "f64"),
        ("string", "str"),
        ("u24", "UNSIGNED24"),
        ("i24", "INTEGER24"),
        ("bytes", "OCTET_STRING"),
    ],
};

pub(crate) const ACCESS: Words<Access> = Words {
    what: "an access type",
    shown: &["ro", "wo", "rw", "rwr", "rww", "const"],
    of: access,
    foreign: &[
        ("readonly", "ro"),
        ("read", "ro"),
        ("r", "ro"),
        ("writeonly", "wo"),
        ("write", "wo"),
        ("readwrite", "rw"),
        ("constant", "const"),
    ],
};

pub(crate) const GROUPS: Words<Group> = Words {
    what: "a parameter group",
    shown: &["communication", "application", "manufacturer", "none"],
    of: group,
    foreign: &[],
};

pub(crate) const CODES: Words<ObjectCode> = Words {
    what: "an object code",
    shown: &["var", "array", "record", "domain"],
    of: code,
    foreign: &[("struct", "record"), ("variable", "var"), ("list", "array")],
};

impl<T> Words<T> {
    /// Reads one of the words; for another one says what is allowed.
    pub(crate) fn read(&self, body: ParseStream) -> syn::Result<T> {
        let what = self.what;
        let word = Ident::parse_any(body).map_err(|e| {
            let list = self.list();
            syn::Error::new(e.span(), format!("expected {what}\nhelp: one of {list}"))
        })?;
        let text = word.to_string();
        (self.of)(&text).ok_or_else(|| {
            let help = match self.meant(&text) {
                Some(meant) => format!("did you mean `{meant}`?"),
                None => format!("one of {}", self.list()),
            };
            syn::Error::new(word.span(), format!("`{word}` is not {what}\nhelp: {help}"))
        })
    }

    /// The word for a value.
    pub(crate) fn word(&self, value: T) -> Option<&'static str>
    where
        T: PartialEq,
    {
        let mut words = self.shown.iter().copied();
        words.find(|word| (self.of)(word).as_ref() == Some(&value))
    }

    fn list(&self) -> String {
        let quoted: Vec<String> = self.shown.iter().map(|word| format!("`{word}`")).collect();
        quoted.join(", ")
    }

    fn meant(&self, text: &str) -> Option<&'static str> {
        let lower = text.to_ascii_lowercase();
        let plain = lower.strip_suffix("_t").unwrap_or(&lower);
        let foreign = self.foreign.iter().find(|(word, _)| *word == plain);
        if let Some((_, meant)) = foreign {
            return Some(meant);
        }
        near(text, self.shown.iter().copied())
    }
}

/// The word that differs least, if it is not another one altogether.
pub(crate) fn near<'a>(text: &str, words: impl Iterator<Item = &'a str>) -> Option<&'a str> {
    words
        .map(|word| (distance(text, word), word))
        .filter(|(distance, _)| *distance <= 2.min(text.len() / 2))
        .min_by_key(|(distance, _)| *distance)
        .map(|(_, word)| word)
}

fn data_type(word: &str) -> Option<DataType> {
    use DataType as T;
    Some(match word {
        "bool" => T::Boolean,
        "u8" => T::Unsigned8,
        "u16" => T::Unsigned16,
        "u32" => T::Unsigned32,
        "u64" => T::Unsigned64,
        "i8" => T::Integer8,
        "i16" => T::Integer16,
        "i32" => T::Integer32,
        "i64" => T::Integer64,
        "f32" => T::Real32,
        "f64" => T::Real64,
        "str" => T::VisibleString,
        _ => return DataType::ALL.into_iter().find(|t| t.name() == word),
    })
}

fn access(word: &str) -> Option<Access> {
    let mut all = Access::ALL.into_iter();
    all.find(|access| access.name() == word)
}

fn group(word: &str) -> Option<Group> {
    Some(match word {
        "communication" => Group::Communication,
        "application" => Group::Application,
        "manufacturer" => Group::Manufacturer,
        "none" => Group::None,
        _ => return None,
    })
}

fn code(word: &str) -> Option<ObjectCode> {
    Some(match word {
        "var" => ObjectCode::Var,
        "array" => ObjectCode::Array,
        "record" => ObjectCode::Record,
        "domain" => ObjectCode::Domain,
        _ => return None,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[track_caller]
    fn check<T>(words: &Words<T>) {
        let meant = words.foreign.iter().map(|(_, word)| word);
        assert!(
            words
                .shown
                .iter()
                .chain(meant)
                .all(|w| (words.of)(w).is_some())
        );
        assert!(words.foreign.iter().all(|(w, _)| (words.of)(w).is_none()));
    }

    #[test]
    fn what_is_suggested_is_allowed() {
        check(&TYPES);
        check(&ACCESS);
        check(&GROUPS);
        check(&CODES);
    }

    #[test]
    fn what_was_meant() {
        for (word, meant) in [
            ("uint16", Some("u16")),
            ("uint16_t", Some("u16")),
            ("unsigned24", Some("UNSIGNED24")),
            ("UNSIGNED42", Some("UNSIGNED40")),
            ("u15", Some("u16")),
            ("Encoder", None),
        ] {
            assert_eq!(TYPES.meant(word), meant, "{word}");
        }
        assert_eq!(ACCESS.meant("RO"), Some("ro"));
    }
}
