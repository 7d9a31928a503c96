//! The object or sub-object of an edit.

use alloc::string::ToString;
use core::fmt;

use crate::fact::Fact;
use crate::finding::{Finding, Rule};
use crate::span::{Span, Spanned};
use od_model::Address;

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
