//! The catalogue: every code that odkit gives, once, in a file of its own.

use alloc::string::String;

use crate::diagnostic::{Diagnostic, Severity, Span};

/// One rule: what a code means, whoever found it.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct Rule {
    /// Stable code; the letter is the severity's.
    pub code: &'static str,
    /// How bad it is.
    pub severity: Severity,
    /// The fault in a few words.
    pub title: &'static str,
    /// Why it matters, and what odkit does about it.
    pub why: &'static str,
    /// Where it is written.
    pub source: &'static str,
    /// What `odkit check --fix` can do about it.
    pub mending: Mending,
    /// Lines of a file that break the rule.
    pub before: &'static str,
    /// The same lines, mended.
    pub after: &'static str,
}

/// What can be done about the findings of a rule without asking.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize),
    serde(rename_all = "kebab-case")
)]
pub enum Mending {
    /// Only who knows the device can mend it.
    None,
    /// What is written then says to every reader what odkit reads now.
    Safe,
    /// A likely guess: look at it before you ship the file.
    Unsafe,
    /// Safe where nothing is lost by it, else unsafe.
    Either,
}

impl Mending {
    /// In one word, for tables.
    pub const fn name(self) -> &'static str {
        match self {
            Self::None => "by hand",
            Self::Safe => "safe",
            Self::Unsafe => "unsafe",
            Self::Either => "safe or unsafe",
        }
    }
}

impl Rule {
    /// A finding of this rule at `span`.
    pub fn at(&self, span: Span, message: impl Into<String>) -> Diagnostic {
        self.anywhere(message).with_span(span)
    }

    /// A finding of this rule about what is nowhere in the text.
    pub fn anywhere(&self, message: impl Into<String>) -> Diagnostic {
        match self.severity {
            Severity::Error => Diagnostic::error(self.code, message),
            Severity::Warning => Diagnostic::warning(self.code, message),
            Severity::Info => Diagnostic::info(self.code, message),
        }
    }
}

/// The rule with this code, in any case.
pub fn rule(code: &str) -> Option<&'static Rule> {
    RULES.iter().find(|r| r.code.eq_ignore_ascii_case(code))
}

/// A module for each rule of a folder, its constant under the name of the code, and all of them.
macro_rules! catalogue {
    ($($file:ident $code:ident)*) => {
        $(
            mod $file;
            pub(crate) use $file::RULE as $code;
        )*
        pub(crate) const ALL: &[super::Rule] = &[$($code),*];
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
        const FOLDERS: &[&[Rule]] = &[$($folder::ALL),*];
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

static TABLE: [Rule; COUNT] = {
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
pub static RULES: &[Rule] = &TABLE;

#[cfg(test)]
mod tests;
