//! The subject of a section, found by its name.

use alloc::format;
use alloc::string::String;

/// The three lists of objects.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Debug)]
pub enum List {
    /// 1000h, 1001h and 1018h.
    Mandatory,
    /// The other objects of the standards.
    Optional,
    /// 2000h to 5FFFh.
    Manufacturer,
}

impl List {
    /// All lists.
    pub const ALL: [List; 3] = [List::Mandatory, List::Optional, List::Manufacturer];

    /// The name of its section.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Mandatory => "MandatoryObjects",
            Self::Optional => "OptionalObjects",
            Self::Manufacturer => "ManufacturerObjects",
        }
    }

    /// The list that an object belongs to.
    pub const fn of(index: u16) -> Self {
        match index {
            0x1000 | 0x1001 | 0x1018 => Self::Mandatory,
            0x2000..=0x5FFF => Self::Manufacturer,
            _ => Self::Optional,
        }
    }
}

/// The three sections that belong to an object with CompactSubObj, in the order in which they are
/// read.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Debug)]
pub enum Compact {
    /// `[1600Name]`
    Name,
    /// `[1600Value]`
    Value,
    /// `[1600Denotation]`
    Denotation,
}

/// Subject of a section.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Debug)]
pub enum Place {
    /// `[1018]`
    Object(u16),
    /// `[1018sub1]`
    Member(u16, u8),
    /// A list that belongs to an object with CompactSubObj.
    Compact(u16, Compact),
    /// A list of objects.
    List(List),
    /// Anything else.
    Other,
}

impl Place {
    /// The name of the section of an object or a member.
    pub fn name(self) -> Option<String> {
        match self {
            Self::Object(index) => Some(format!("{index:04X}")),
            Self::Member(index, sub) => Some(format!("{index:04X}sub{sub:X}")),
            Self::Compact(..) | Self::List(_) | Self::Other => None,
        }
    }
}

/// The subject of the section with this name: `1018`, `1018sub2`, `1600Name` …
pub fn place(name: &str) -> Place {
    for list in List::ALL {
        if name.eq_ignore_ascii_case(list.name()) {
            return Place::List(list);
        }
    }
    let Some((digits, rest)) = name.split_at_checked(4) else {
        return Place::Other;
    };
    let Some(index) = hex(digits).and_then(|index| u16::try_from(index).ok()) else {
        return Place::Other;
    };
    if rest.is_empty() {
        return Place::Object(index);
    }
    for (word, compact) in [
        ("Name", Compact::Name),
        ("Value", Compact::Value),
        ("Denotation", Compact::Denotation),
    ] {
        if rest.eq_ignore_ascii_case(word) {
            return Place::Compact(index, compact);
        }
    }
    match rest.split_at_checked(3) {
        Some((word, sub)) if word.eq_ignore_ascii_case("sub") && sub.len() <= 2 => {
            match hex(sub).and_then(|sub| u8::try_from(sub).ok()) {
                Some(sub) => Place::Member(index, sub),
                None => Place::Other,
            }
        }
        _ => Place::Other,
    }
}

/// The likely subject of a section with a misspelled name: `0x1018`, `1018 sub 2`, `1018_sub2`,
/// `1018h`, `5`; `A0` only if the section describes an object.
pub(crate) fn intended(name: &str, describes: bool) -> Option<Place> {
    let plain = name.trim().to_ascii_lowercase();
    // Between the index and the sub-index, not within one of them.
    let is_separator = |c: char| c.is_whitespace() || matches!(c, '_' | '.' | '-');
    let number = |text: &str| {
        let text = text.strip_prefix("0x").unwrap_or(text);
        let text = text.strip_suffix('h').unwrap_or(text);
        let starts = text.bytes().next()?;
        // `[add]` is a section of a tool; `[5]` is an object.
        match text.len() {
            4 => hex(text),
            5..=8 if describes && text.starts_with('0') => hex(text),
            1..=3 if describes || starts.is_ascii_digit() => hex(text),
            _ => None,
        }
    };
    let (index, rest) = match plain.find("sub") {
        Some(at) => (
            plain[..at].trim_end_matches(is_separator),
            Some(plain[at + 3..].trim_start_matches(is_separator)),
        ),
        None => (&plain[..], None),
    };
    let index = u16::try_from(number(index)?).ok()?;
    let Some(sub) = rest else {
        return Some(Place::Object(index));
    };
    let sub = sub.strip_prefix("0x").unwrap_or(sub);
    let sub = sub.strip_suffix('h').unwrap_or(sub);
    let sub = hex(sub).and_then(|sub| u8::try_from(sub).ok())?;
    Some(Place::Member(index, sub))
}

fn hex(digits: &str) -> Option<u32> {
    // `from_str_radix` would accept a sign.
    if digits.bytes().all(|b| b.is_ascii_hexdigit()) {
        u32::from_str_radix(digits, 16).ok()
    } else {
        None
    }
}

/// The object that the section with this name is about.
pub(crate) fn object_of(name: &str) -> Option<u16> {
    match place(name) {
        Place::Object(index) | Place::Member(index, _) | Place::Compact(index, _) => Some(index),
        Place::List(_) | Place::Other => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_give_the_subject_of_a_section() {
        for (name, expected) in [
            ("1018", Place::Object(0x1018)),
            ("6aBc", Place::Object(0x6ABC)),
            ("1018sub2", Place::Member(0x1018, 2)),
            ("1018SUB0A", Place::Member(0x1018, 10)),
            ("1600name", Place::Compact(0x1600, Compact::Name)),
            ("1600Value", Place::Compact(0x1600, Compact::Value)),
            ("mandatoryobjects", Place::List(List::Mandatory)),
        ] {
            assert_eq!(place(name), expected, "{name}");
        }
        for name in [
            "",
            "101",
            "10180",
            "1018sub",
            "1018sub100",
            "+018",
            "1018sub+1",
            "FileInfo",
            "é€x",
            "abc€",
        ] {
            assert_eq!(place(name), Place::Other, "{name}");
        }
    }

    #[test]
    fn misspelled_names_are_understood() {
        for (name, expected) in [
            ("0x1018", Place::Object(0x1018)),
            ("1018h", Place::Object(0x1018)),
            ("5", Place::Object(5)),
            ("1018 Sub 2", Place::Member(0x1018, 2)),
            ("1018_sub_0x0a", Place::Member(0x1018, 10)),
            ("1018sub002", Place::Member(0x1018, 2)),
            ("0x1018sub2h", Place::Member(0x1018, 2)),
        ] {
            assert_eq!(intended(name, false), Some(expected), "{name}");
            let name = expected.name().unwrap();
            assert_eq!(place(&name), expected);
        }
        assert_eq!(intended("A0sub1", true), Some(Place::Member(0xA0, 1)));
        for name in [
            "",
            "add",
            "sub1",
            "1018sub",
            "1018sub100",
            "10180",
            "FileInfo",
            "x1",
            "1Fixed",
            "é",
        ] {
            assert_eq!(intended(name, false), None, "{name}");
        }
    }
}
