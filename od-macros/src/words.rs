//! The words that a field may have, and suggestions for other words.

use od_eds::row;
use od_model::{Access, DataType, Group, ObjectCode};
use proc_macro2::Ident;
use syn::ext::IdentExt;
use syn::parse::ParseStream;

/// One field's vocabulary.
pub(crate) struct Words<T: 'static> {
    what: &'static str,
    /// Words that a help text lists.
    words: &'static [(&'static str, T)],
    /// Words of other languages, and the words with the same meaning.
    foreign: &'static [(&'static str, &'static str)],
}

pub(crate) const TYPES: Words<DataType> = Words {
    what: "a data type",
    words: &row::TYPES,
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
    words: &[
        ("ro", Access::Ro),
        ("wo", Access::Wo),
        ("rw", Access::Rw),
        ("rwr", Access::Rwr),
        ("rww", Access::Rww),
        ("const", Access::Const),
    ],
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
    words: &row::GROUPS,
    foreign: &[],
};

pub(crate) const CODES: Words<ObjectCode> = Words {
    what: "an object code",
    words: &row::CODES,
    foreign: &[("struct", "record"), ("variable", "var"), ("list", "array")],
};

/// A value that can have its name in CiA 301 instead of a word.
pub(crate) trait Named: Copy + PartialEq {
    /// The value with this name.
    fn named(_: &str) -> Option<Self> {
        None
    }
}

impl Named for DataType {
    fn named(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|known| known.name() == name)
    }
}
impl Named for Access {}
impl Named for Group {}
impl Named for ObjectCode {}

impl<T: Named> Words<T> {
    /// Reads one of the words; an error lists the allowed words.
    pub(crate) fn read(&self, body: ParseStream) -> syn::Result<T> {
        let what = self.what;
        let word = Ident::parse_any(body).map_err(|e| {
            let list = self.list();
            syn::Error::new(e.span(), format!("expected {what}\nhelp: one of {list}"))
        })?;
        let text = word.to_string();
        self.value(&text).ok_or_else(|| {
            let help = match self.meant(&text) {
                Some(meant) => format!("did you mean `{meant}`?"),
                None => format!("one of {}", self.list()),
            };
            syn::Error::new(word.span(), format!("`{word}` is not {what}\nhelp: {help}"))
        })
    }

    fn value(&self, text: &str) -> Option<T> {
        let known = self.words.iter().find(|(word, _)| *word == text);
        known.map(|(_, value)| *value).or_else(|| T::named(text))
    }

    fn list(&self) -> String {
        let quoted = self.words.iter().map(|(word, _)| format!("`{word}`"));
        quoted.collect::<Vec<_>>().join(", ")
    }

    fn meant(&self, text: &str) -> Option<&'static str> {
        let lower = text.to_ascii_lowercase();
        let plain = lower.strip_suffix("_t").unwrap_or(&lower);
        let foreign = self.foreign.iter().find(|(word, _)| *word == plain);
        match foreign {
            Some((_, meant)) => Some(meant),
            None => near(text, self.words.iter().map(|(word, _)| *word)),
        }
    }
}

/// The most similar word, if it is similar enough; the same word in other case.
pub(crate) fn near<'a>(
    text: &str,
    words: impl Iterator<Item = &'a str> + Clone,
) -> Option<&'a str> {
    let mut same = words.clone().filter(|word| word.eq_ignore_ascii_case(text));
    same.next()
        .or_else(|| od_eds::nearest(text, words, 2.min(text.len() / 2)))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[track_caller]
    fn check<T: Named>(words: &Words<T>) {
        for (foreign, meant) in words.foreign {
            assert!(words.value(meant).is_some(), "{meant}");
            assert!(words.value(foreign).is_none(), "{foreign}");
        }
    }

    #[test]
    fn a_suggested_word_is_allowed() {
        check(&TYPES);
        check(&ACCESS);
        check(&GROUPS);
        check(&CODES);
    }

    #[test]
    fn the_most_similar_word_is_suggested() {
        for (word, meant) in [
            ("uint16", Some("u16")),
            ("uint16_t", Some("u16")),
            ("unsigned24", Some("UNSIGNED24")),
            ("UNSIGNED42", Some("UNSIGNED24")),
            ("u15", Some("u16")),
            ("Encoder", None),
        ] {
            assert_eq!(TYPES.meant(word), meant, "{word}");
        }
        assert_eq!(ACCESS.meant("RO"), Some("ro"));
    }
}
