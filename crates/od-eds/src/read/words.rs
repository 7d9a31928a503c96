//! Words in place of the numbers of CiA 306, and spellings of other tools.

use alloc::string::String;

use crate::scan::number::before_comment;
use od_model::{Access, DataType, ObjectCode};

/// A data type by its name: `UNSIGNED8`.
pub(crate) fn data_type(text: &str) -> Option<DataType> {
    let word = before_comment(text);
    DataType::ALL.into_iter().find(|t| same(word, t.name()))
}

/// An object code by its name: `VAR`.
pub(crate) fn object_code(text: &str) -> Option<ObjectCode> {
    let word = before_comment(text);
    let mut codes = (0..=9).filter_map(ObjectCode::from_code);
    codes.find(|code| same(word, code.name()))
}

/// An access type in another spelling than that of CiA 306.
pub(crate) fn access(text: &str) -> Option<Access> {
    const KNOWN: [(&str, Access); 12] = [
        ("r", Access::Ro),
        ("read", Access::Ro),
        ("readonly", Access::Ro),
        ("w", Access::Wo),
        ("write", Access::Wo),
        ("writeonly", Access::Wo),
        ("wr", Access::Rw),
        ("r/w", Access::Rw),
        ("w/r", Access::Rw),
        ("readwrite", Access::Rw),
        ("constant", Access::Const),
        ("co", Access::Const),
    ];
    known(text, &KNOWN)
}

/// PDOMapping as a word.
pub(crate) fn mappable(text: &str) -> Option<bool> {
    const KNOWN: [(&str, bool); 5] = [
        ("no", false),
        ("false", false),
        ("yes", true),
        ("true", true),
        ("optional", true),
    ];
    known(text, &KNOWN)
}

fn known<T: Copy>(text: &str, words: &[(&str, T)]) -> Option<T> {
    let word = before_comment(text);
    let found = words.iter().find(|(known, _)| same(word, known))?;
    Some(found.1)
}

/// Returns whether two texts have the same letters and digits, ignoring all other characters.
fn same(a: &str, b: &str) -> bool {
    let letters = |text: &str| -> String {
        text.chars()
            .filter(|c| !matches!(c, ' ' | '_' | '-'))
            .map(|c| c.to_ascii_lowercase())
            .collect()
    };
    !a.is_empty() && letters(a) == letters(b)
}
