//! The rules: every code of odkit is defined once.
//!
//! A rule with a check has a file of its own, or shares that of the rules with the same check. Other code reports the
//! rest (the reader, a patch, a target of `convert`): these are words and a constructor, together in a file
//! named by who reports them.

use crate::finding::Rule;

/// The rules of a folder, each with the file that defines it, and a list of them. Their modules are declared below the
/// call, where cargo-mutants finds them; the compiler reports a rule that is declared and not listed.
macro_rules! catalogue {
    ($($file:ident $code:ident $(($kind:tt))?)*) => {
        $(
            pub(crate) use $file::$code;
        )*
        table! { $($code $(($kind))?)* }
    };
}

/// The list of the rules of a folder, or of a file that defines all of its folder.
macro_rules! table {
    ($($code:ident $(($kind:tt))?)*) => {
        pub(crate) static ALL: &[&crate::finding::Rule] = &[$(&$code),*];
        /// The pairs of example files of all rules, in the same order.
        #[cfg(feature = "explain")]
        pub(crate) static PAIRS: &[super::Pair] = &[$(pair!($code $($kind)?)),*];
    };
}

/// The pair of example files of a rule: one that breaks it, and the same file fixed.
#[cfg(feature = "explain")]
pub struct Pair {
    /// The rule's code.
    pub code: &'static str,
    /// The file that breaks the rule.
    pub bad: &'static [u8],
    /// The same file, without a finding.
    pub fixed: &'static [u8],
}

/// The bytes of an example file.
#[cfg(feature = "explain")]
macro_rules! example {
    ($code:ident $name:literal $kind:ident) => {
        include_bytes!(concat!(
            env!("CARGO_MANIFEST_DIR"),
            "/cases/",
            stringify!($code),
            $name,
            stringify!($kind)
        ))
    };
}

/// The files of a code; an EDS unless its kind is given. A rule with an `example` has none.
#[cfg(feature = "explain")]
macro_rules! pair {
    ($code:ident) => { pair!($code eds) };
    ($code:ident example) => {
        super::Pair { code: stringify!($code), bad: b"", fixed: b"" }
    };
    ($code:ident $kind:ident) => {
        super::Pair {
            code: stringify!($code),
            bad: example!($code "/bad." $kind),
            fixed: example!($code "/fixed." $kind),
        }
    };
}

/// The rules of all folders.
macro_rules! folders {
    ($($folder:ident)*) => {
        $(
            // The patches name their codes themselves.
            #[allow(unused_imports)]
            pub(crate) use $folder::*;
        )*
        static FOLDERS: &[&[&Rule]] = &[$($folder::ALL),*];
        #[cfg(feature = "explain")]
        static FILES: &[&[Pair]] = &[$($folder::PAIRS),*];
    };
}

folders! { text lists structure values pdo standard edits allow profile convert network }

pub(crate) mod allow;
pub(crate) mod convert;
pub(crate) mod edits;
pub(crate) mod lists;
pub(crate) mod network;
pub(crate) mod pdo;
pub(crate) mod profile;
pub(crate) mod standard;
pub(crate) mod structure;
pub(crate) mod text;
pub(crate) mod values;

const COUNT: usize = {
    let (mut count, mut at) = (0, 0);
    while at < FOLDERS.len() {
        count += FOLDERS[at].len();
        at += 1;
    }
    count
};

static TABLE: [&Rule; COUNT] = {
    let mut table = [FOLDERS[0][0]; COUNT];
    let (mut count, mut folder) = (0, 0);
    while folder < FOLDERS.len() {
        let mut at = 0;
        while at < FOLDERS[folder].len() {
            table[count] = FOLDERS[folder][at];
            count += 1;
            at += 1;
        }
        folder += 1;
    }
    table
};

/// The pair of files that a rule is tested and explained with; `None` for a rule with an `example`.
#[cfg(feature = "explain")]
pub fn pair(code: &str) -> Option<&'static Pair> {
    let mut pairs = FILES.iter().copied().flatten();
    pairs.find(|pair| pair.code == code && !pair.bad.is_empty())
}

/// Every rule, by ascending number.
pub static RULES: &[&Rule] = &TABLE;

#[cfg(test)]
mod tests;
