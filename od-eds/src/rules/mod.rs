//! The rules: every code that odkit reports, once, in a file of its own.

use crate::finding::Rule;

/// The rule with this code, in any case.
pub fn rule(code: &str) -> Option<&'static Rule> {
    RULES
        .iter()
        .copied()
        .find(|r| r.code.eq_ignore_ascii_case(code))
}

/// A module for each rule of a folder, the rule under the name of its code, and all of them.
macro_rules! catalogue {
    ($($file:ident $code:ident)*) => {
        $(
            mod $file;
            pub(crate) use $file::RULE as $code;
        )*
        pub(crate) static ALL: &[&crate::finding::Rule] = &[$(&$code),*];
    };
}

/// A module for each folder, and the rules of all of them.
macro_rules! folders {
    ($($folder:ident)*) => {
        $(
            mod $folder;
            // The patches name their codes themselves.
            #[allow(unused_imports)]
            pub(crate) use $folder::*;
        )*
        static FOLDERS: &[&[&Rule]] = &[$($folder::ALL),*];
    };
}

folders! { text lists structure values pdo standard edits allow profile }

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

/// Every rule, by ascending number.
pub static RULES: &[&Rule] = &TABLE;

#[cfg(test)]
mod tests;
