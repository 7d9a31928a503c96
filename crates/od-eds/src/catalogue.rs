//! Makes the sentence of a finding. Blanks of sentences are filled only here.
//!
//! A sentence of a rule has blanks between braces:
//!
//! | blank | is replaced by |
//! |---|---|
//! | `{low}` | the fact of this name |
//! | `{id:03X}` | a number or an index, hexadecimal with at least three digits |
//! | `{count:entry\|entries}` | a count and its noun: "1 entry", "2 entries" |
//! | `{LowLimit}`, `{key}` | this key, and the key of the finding |
//! | `{DataType={right}}` | this key with a value, which may contain blanks, too |
//! | `{fix}` | " (safe fix)" or " (unsafe fix)", if the finding has one |
//! | `{{`, `}}` | a brace |

mod xml;

use alloc::format;
use alloc::string::{String, ToString};
use alloc::vec::Vec;

use od_model::{Address, DataType, Kind, Visible};

use crate::fact::{Fact, Key, LONGEST, shown};
use crate::finding::{Finding, Severity};
use crate::fix::{Applicability, Fix};
use crate::span::Span;

/// The terms of a sentence: those of an EDS file, of a macro call, or of a language.
pub trait Vocabulary {
    /// A key in a sentence.
    fn key(&self, key: Key) -> &'static str {
        key.name()
    }

    /// A key with the value to write.
    fn set(&self, key: Key, value: &str) -> String {
        format!("{}={value}", key.name())
    }

    /// An object or a sub-index to write.
    fn section(&self, index: u16, sub: Option<u8>) -> String {
        match sub {
            Some(sub) => format!("a section [{index:04X}sub{sub:X}]"),
            None => format!("a section [{index:04X}]"),
        }
    }

    /// The form of a value of this type.
    fn form_of(&self, data_type: DataType) -> String {
        match (data_type.kind(), data_type.integer_range()) {
            (Kind::Boolean, _) => "`0` or `1`".into(),
            (Kind::Real, _) => "a number such as `1.5`".into(),
            (Kind::Text, _) => "a text".into(),
            (Kind::Bytes, _) => "hexadecimal bytes such as `12AB`".into(),
            (_, Some((low, high))) => format!("a number from {low} to {high}"),
            _ => "the value at a member".into(),
        }
    }

    /// A type, a code or an access as the value of a key.
    fn written(&self, fact: &Fact) -> Option<String> {
        match fact {
            Fact::Type(data_type) => Some(format!("0x{:04X}", data_type.code())),
            Fact::Code(code) => Some(format!("0x{:X}", code.code())),
            _ => None,
        }
    }

    /// The words after a help text that odkit can apply itself.
    fn fix(&self, fix: Applicability) -> &'static str {
        match fix {
            Applicability::Safe => " (safe fix)",
            Applicability::Unsafe => " (unsafe fix)",
        }
    }

    /// Returns the English sentence with its blanks; a translation replaces it.
    fn sentence(&self, english: &'static str) -> &'static str {
        english
    }
}

/// The terms of an EDS file: `LowLimit=5`.
#[derive(Clone, Copy, Debug, Default)]
pub struct Eds;

impl Vocabulary for Eds {}

/// The terms of an XDD: `lowLimit="5"`.
struct Xdd;

impl Vocabulary for Xdd {
    fn key(&self, key: Key) -> &'static str {
        xml::key(key)
    }

    fn set(&self, key: Key, value: &str) -> String {
        xml::set(key, value)
    }

    fn section(&self, index: u16, sub: Option<u8>) -> String {
        xml::section(index, sub)
    }
}

/// A second place, in words.
#[derive(Clone, PartialEq, Eq, Debug)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct Label {
    /// Place that the label marks.
    pub span: Span,
    /// Description of the place, in a few words.
    pub text: String,
}

/// The text of a finding.
#[derive(Clone, PartialEq, Eq, Debug)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct Sentence {
    /// Stable code, for example `E0412`.
    pub code: &'static str,
    /// Severity of the finding.
    pub severity: Severity,
    /// The problem, one clause without a full stop.
    pub message: String,
    /// Place in the text; `None` if something is missing.
    pub span: Option<Span>,
    /// The object of the finding, if it has one.
    pub address: Option<Address>,
    /// Second places.
    pub labels: Vec<Label>,
    /// The text to write instead, or the allowed values; empty if the message contains them.
    pub help: String,
    /// Automatic fix, if there is one.
    pub fix: Option<Fix>,
}

impl Sentence {
    /// The message, after the object that it is about.
    pub fn with_object(&self) -> String {
        match self.address {
            Some(address) => format!("object {address}: {}", self.message),
            None => self.message.clone(),
        }
    }
}

/// Returns the finding in these terms.
pub fn say(finding: &Finding, words: &dyn Vocabulary) -> Sentence {
    let filled = |english| {
        if finding.is_xml {
            let english = xml::sentence(english);
            return Blanks {
                finding,
                words: &Xdd,
            }
            .fill(&english, false);
        }
        Blanks { finding, words }.fill(words.sentence(english), false)
    };
    let labels = finding.related.iter().map(|related| Label {
        span: related.span,
        text: filled(related.says),
    });
    Sentence {
        code: finding.rule.code,
        severity: finding.severity,
        message: filled(finding.form.says),
        span: finding.span(),
        address: finding.object,
        labels: labels.collect(),
        help: filled(finding.form.help),
        fix: finding.fix.clone(),
    }
}

/// Provides the values for the blanks of one finding.
struct Blanks<'a> {
    finding: &'a Finding,
    words: &'a dyn Vocabulary,
}

impl Blanks<'_> {
    /// Returns the text with its blanks filled; `written` if it is the value of a key.
    fn fill(&self, text: &str, written: bool) -> String {
        let mut out = String::with_capacity(text.len() + 32);
        for piece in pieces(text) {
            match piece {
                Piece::Text(text) => out.push_str(text),
                Piece::Blank(blank) => out.push_str(&self.blank(blank, written)),
            }
        }
        out
    }

    fn blank(&self, blank: &str, written: bool) -> String {
        let key = |name| match name {
            "key" => self.finding.key,
            name => Key::of(name),
        };
        if let Some((name, value)) = blank.split_once('=')
            && let Some(key) = key(name)
        {
            return self.words.set(key, &self.fill(value, true));
        }
        if let Some(key) = key(blank) {
            return self.words.key(key).into();
        }
        if blank == "fix" {
            let fix = self.finding.fix.as_ref();
            let said = fix.map(|fix| self.words.fix(fix.applicability));
            return said.unwrap_or_default().into();
        }
        let (name, form) = blank.split_once(':').unwrap_or((blank, ""));
        let facts = &self.finding.facts;
        match facts.iter().find(|(known, _)| *known == name) {
            Some((_, Fact::Text(text)))
                if self.finding.is_xml
                    && self.finding.object.is_none()
                    && matches!(name, "name" | "field" | "section") =>
            {
                Visible(&cut(xml::word(text))).line().into_owned()
            }
            Some((_, fact)) if written => {
                let own = self.words.written(fact);
                own.unwrap_or_else(|| self.shown(fact, form))
            }
            Some((_, fact)) => self.shown(fact, form),
            // A test makes sure that this does not happen.
            None => format!("{{{blank}}}"),
        }
    }

    fn all(&self, facts: &[Fact], form: &str) -> Vec<String> {
        facts.iter().map(|fact| self.shown(fact, form)).collect()
    }

    fn shown(&self, fact: &Fact, form: &str) -> String {
        match fact {
            Fact::Number(number) => counted(*number, form),
            Fact::Value(value) => cut(&shown(value)),
            Fact::Type(data_type) => data_type.name().into(),
            Fact::FormOf(data_type) => self.words.form_of(*data_type),
            Fact::Code(code) => code.name().into(),
            Fact::Access(access) => access.name().into(),
            Fact::Index(index) if form.is_empty() => format!("{index:04X}h"),
            Fact::Index(index) => counted(i128::from(*index), form),
            Fact::Object(address) => address.to_string(),
            Fact::Section(index, sub) => self.words.section(*index, *sub),
            Fact::Key(key) => self.words.key(*key).into(),
            Fact::Text(text) => Visible(&cut(text)).line().into_owned(),
            Fact::List(facts) => self.all(facts, form).join(", "),
            Fact::OneOf(facts) => {
                let mut all = self.all(facts, form);
                let last = all.pop().unwrap_or_default();
                if all.is_empty() {
                    last
                } else {
                    format!("{} or {last}", all.join(", "))
                }
            }
        }
    }
}

/// A text of the file, shortened to a readable length.
fn cut(text: &str) -> String {
    match text.char_indices().nth(LONGEST) {
        Some((at, _)) => format!("{}…", &text[..at]),
        None => text.into(),
    }
}

/// A number in one of the forms of a blank.
fn counted(number: i128, form: &str) -> String {
    if let Some((one, many)) = form.split_once('|') {
        let noun = if number == 1 { one } else { many };
        return format!("{number} {noun}");
    }
    match form.strip_suffix('X') {
        Some(width) => format!("{number:0width$X}", width = width.parse().unwrap_or(0)),
        None => number.to_string(),
    }
}

/// A part of a sentence with blanks.
enum Piece<'a> {
    Text(&'a str),
    Blank(&'a str),
}

/// The parts of a sentence with blanks.
fn pieces(mut text: &str) -> impl Iterator<Item = Piece<'_>> {
    core::iter::from_fn(move || {
        if text.is_empty() {
            return None;
        }
        let at = text.find(['{', '}']).unwrap_or(text.len());
        let (piece, rest) = match text.get(at..at + 2) {
            _ if at > 0 => (Piece::Text(&text[..at]), &text[at..]),
            Some("{{" | "}}") => (Piece::Text(&text[..1]), &text[2..]),
            _ => match end(text) {
                Some(0) => (Piece::Text("}"), &text[1..]),
                Some(end) => (Piece::Blank(&text[1..end]), &text[end + 1..]),
                None => (Piece::Text(text), ""),
            },
        };
        text = rest;
        Some(piece)
    })
}

/// End of the blank at the start of the text.
fn end(text: &str) -> Option<usize> {
    let mut depth = 0usize;
    text.char_indices().find_map(|(at, c)| {
        match c {
            '{' => depth += 1,
            '}' => depth = depth.saturating_sub(1),
            _ => {}
        }
        (depth == 0).then_some(at)
    })
}

#[cfg(test)]
mod tests;
