//! Names of C variables, made from object names in the same way as CANopenEditor does.

use alloc::collections::BTreeSet;
use alloc::format;
use alloc::string::String;

/// Reserved words of C or C++, and names that compilers define.
const RESERVED: &str = " alignas alignof and asm auto bitand bitor bool break case catch char class \
    compl const constexpr continue decltype default delete do double else enum explicit export \
    extern false float for friend goto if inline int linux long mutable namespace new noexcept not \
    nullptr operator or private protected public register restrict return short signed sizeof \
    static struct switch template this throw true try typedef typeid typename typeof union unix \
    unsigned using virtual void volatile while xor ";

/// Turns `COB ID used by RPDO` into `COB_IDUsedByRPDO`; empty if the name has no letter and no digit.
pub(super) fn c_name(name: &str) -> String {
    let name = name.replace('-', "_");
    let words = name.split(|c: char| !c.is_ascii_alphanumeric() && c != '_');
    let mut out = String::new();
    for word in words.filter(|word| !word.is_empty()) {
        let first = word.as_bytes()[0];
        let is_upper = |byte: Option<u8>| byte.is_some_and(|byte| byte.is_ascii_uppercase());
        if is_upper(out.bytes().last()) && first.is_ascii_uppercase() {
            out.push('_');
        }
        if word.len() > 1 {
            out.push(char::from(first.to_ascii_uppercase()));
            out.push_str(&word[1..]);
        } else {
            out.push_str(word)
        }
    }
    match *out.as_bytes() {
        [] => out,
        [first, ..] if first.is_ascii_digit() => format!("_{out}"),
        [_] => out.to_ascii_lowercase(),
        // A word in capitals does not change.
        [_, second, ..] if second.is_ascii_lowercase() => out[..1].to_ascii_lowercase() + &out[1..],
        _ => out,
    }
}

/// The name of a struct member: valid, and different from the previous ones.
pub(super) fn member(names: &mut BTreeSet<String>, name: &str, sub: u8) -> String {
    let mut name = c_name(name);
    if name.is_empty() {
        name = format!("sub{sub}");
    }
    if RESERVED.contains(&format!(" {name} ")) {
        name.push('_');
    }
    while !names.insert(name.clone()) {
        name = format!("{name}_{sub}");
    }
    name
}

/// The name of the dictionary, with which all definitions of its files begin: `OD` for `OD.c`.
pub(super) fn dictionary(stem: &str) -> String {
    let valid = |c: char| c.is_ascii_alphanumeric() || c == '_';
    let name = stem.replace(|c: char| !valid(c), "_");
    match name.chars().next() {
        None => "OD".into(),
        Some(first) if first.is_ascii_digit() => format!("_{name}"),
        Some(_) => name,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The names that CANopenEditor's own tests expect, and those that it makes wrong.
    #[test]
    fn names_are_those_of_canopeneditor() {
        for (name, expected) in [
            (
                "axle 0 wheel right controlword",
                "axle0WheelRightControlword",
            ),
            ("COB ID used by RPDO", "COB_IDUsedByRPDO"),
            ("Pre-defined error field", "pre_definedErrorField"),
            (
                "A/D unit offset value (filtered)",
                "A_DUnitOffsetValueFiltered",
            ),
            ("80 test string", "_80TestString"),
            ("A", "a"),
            ("°", ""),
        ] {
            assert_eq!(c_name(name), expected);
        }
        let mut names = BTreeSet::new();
        assert_eq!(member(&mut names, "Default", 1), "default_");
        assert_eq!(member(&mut names, "default", 2), "default__2");
        assert_eq!(member(&mut names, "", 3), "sub3");
        assert_eq!(dictionary("my-od.v2"), "my_od_v2");
    }
}
