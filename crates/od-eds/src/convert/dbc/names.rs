//! Names and texts that are valid in a DBC.

use alloc::collections::BTreeSet;
use alloc::format;
use alloc::string::String;

/// `Position value [mm]` is `Position_value_mm`: letters, digits and underscores.
pub(super) fn symbol(name: &str) -> String {
    let mut out = String::new();
    for character in name.chars() {
        if character.is_ascii_alphanumeric() {
            out.push(character);
        } else if !out.is_empty() && !out.ends_with('_') {
            out.push('_');
        }
    }
    out.truncate(out.trim_end_matches('_').len());
    match out.as_bytes() {
        [] => "Value".into(),
        [first, ..] if first.is_ascii_digit() => format!("_{out}"),
        _ => out,
    }
}

/// A name that differs from the previous ones.
pub(super) fn unique(names: &mut BTreeSet<String>, name: String) -> String {
    let mut candidate = name.clone();
    let mut number = 2;
    while !names.insert(candidate.clone()) {
        candidate = format!("{name}_{number}");
        number += 1;
    }
    candidate
}

/// A text in quotes: ASCII, because tools read a DBC in different encodings.
pub(super) fn quoted(text: &str) -> String {
    let characters = text.chars().map(|character| match character {
        '"' => '\'',
        // A backslash at the end would escape the quote.
        '\\' => '/',
        ' '..='~' => character,
        _ => '?',
    });
    format!("\"{}\"", characters.collect::<String>())
}

/// The unit at the end of a name: `[rpm]` or `[mm/s]`; empty without a unit.
pub(super) fn unit(name: &str) -> &str {
    let unit = name
        .trim_end()
        .strip_suffix(']')
        .and_then(|name| name.rsplit_once('['));
    unit.map_or("", |(_, unit)| unit.trim())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_are_valid_and_unique() {
        for (name, expected) in [
            ("Position value [mm]", "Position_value_mm"),
            ("2nd  encoder°", "_2nd_encoder"),
            ("°", "Value"),
        ] {
            assert_eq!(symbol(name), expected);
        }
        let mut names = BTreeSet::new();
        for expected in ["A", "A_2", "A_3"] {
            assert_eq!(unique(&mut names, "A".into()), expected);
        }
        assert_eq!(quoted("a\"b\\c\nä"), "\"a'b/c??\"");
        assert_eq!((unit("Speed [rpm] "), unit("Speed")), ("rpm", ""));
    }
}
