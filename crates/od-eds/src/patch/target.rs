//! The object or sub-object of an edit.

use alloc::format;
use alloc::string::{String, ToString};
use core::fmt;
use core::str::FromStr;

use crate::fact::Fact;
use crate::finding::{Finding, Rule};
use crate::span::{Span, Spanned};
use od_model::{Address, Refused};

/// The target of an edit: an object, or one of its sub-objects.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Debug)]
pub struct Target {
    /// Index.
    pub index: u16,
    /// The member; `None` for the object, and for the value of a VAR.
    pub sub: Option<u8>,
}

impl Target {
    /// The object at `index`.
    pub const fn object(index: u16) -> Self {
        Self { index, sub: None }
    }

    /// The member at `index` and `sub`.
    pub const fn member(index: u16, sub: u8) -> Self {
        Self {
            index,
            sub: Some(sub),
        }
    }

    /// The address of its value, with sub-index 0 for an object.
    pub const fn address(self) -> Address {
        Address::new(
            self.index,
            match self.sub {
                Some(sub) => sub,
                None => 0,
            },
        )
    }

    /// In a sentence: `1018h` or `1018h:02`.
    pub(crate) fn shown(self) -> Fact {
        match self.sub {
            Some(_) => Fact::Object(self.address()),
            None => Fact::Index(self.index),
        }
    }
}

impl Spanned<Target> {
    /// A finding about the target.
    pub(crate) fn finding(&self, rule: &'static Rule, at: Span) -> Finding {
        rule.at(at).about(self.address())
    }

    /// A finding about the target, with the target as its fact `target`.
    pub(crate) fn named(&self, rule: &'static Rule, at: Span) -> Finding {
        self.finding(rule, at).fact("target", self.to_string())
    }
}

/// The spelling in a macro call, `0x1018sub2`: that of the EDS section after `0x`.
impl fmt::Display for Target {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.sub {
            Some(sub) => write!(f, "0x{:04X}sub{sub:X}", self.index),
            None => write!(f, "0x{:04X}", self.index),
        }
    }
}

/// Reads `0x6004` or `0x1018sub2`, with underscores and in any case. The error is a sentence with a help line.
impl FromStr for Target {
    type Err = Refused;

    fn from_str(text: &str) -> Result<Self, Refused> {
        let lower = text.replace('_', "").to_ascii_lowercase();
        let Some(hex) = lower.strip_prefix("0x") else {
            let help = match text.parse::<u16>() {
                Ok(index) => format!("`0x{text}`; or `0x{index:04X}`, which is {text}"),
                Err(_) => "for example `0x6004` or `0x1018sub2`".to_string(),
            };
            return Err(format!("an index is written in hex\nhelp: {help}").into());
        };
        let (index, sub) = match hex.split_once("sub") {
            Some((index, sub)) => (index, Some(sub)),
            None => (hex, None),
        };
        let index = u16::from_str_radix(index, 16).map_err(|_| {
            // `0x2000h`
            let hex = index.strip_suffix('h').unwrap_or_default();
            let help = match u16::from_str_radix(hex, 16) {
                Ok(index) => format!("write `0x{index:04X}`"),
                Err(_) => String::from("four hex digits, `0x0001` to `0xFFFF`"),
            };
            format!("`{text}` is not an index\nhelp: {help}")
        })?;
        let sub = sub.map(|sub| {
            u8::from_str_radix(sub, 16).map_err(|_| {
                format!(
                    "`{text}` has no sub-index\nhelp: up to two hex digits after `sub`: \
                     `0x{index:04X}sub0` to `0x{index:04X}subFF`"
                )
            })
        });
        Ok(Self {
            index,
            sub: sub.transpose()?,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn targets_are_spelled_as_in_the_eds() {
        let parse = |text: &str| text.parse::<Target>();
        assert_eq!(parse("0x6004"), Ok(Target::object(0x6004)));
        assert_eq!(parse("0x1018sub2"), Ok(Target::member(0x1018, 2)));
        assert_eq!(parse("0x1a00Sub1F"), Ok(Target::member(0x1A00, 0x1F)));
        for bad in [
            "6004",
            "0x1018sub",
            "0x1018sub100",
            "0x12345",
            "0x1018u8",
            "0x",
        ] {
            assert!(parse(bad).is_err(), "{bad}");
        }
    }
}
