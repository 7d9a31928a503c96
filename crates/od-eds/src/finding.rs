//! Rules and findings as plain data; `say` makes sentences of them.

use alloc::collections::BTreeSet;
use alloc::vec::Vec;
use core::fmt;

use od_model::Address;

use crate::description::Description;
use crate::fact::{Fact, Key};
use crate::fix::Fix;
use crate::span::{Span, Spanned, token, token_of};
use crate::subject::{Entry, Object, Subject};

/// Severity of a finding.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Debug)]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize),
    serde(rename_all = "lowercase")
)]
pub enum Severity {
    /// A hint; nothing is wrong.
    Info,
    /// Many files in use have it, and a device can be built.
    Warning,
    /// A device built from the file does not work, or a master fails.
    Error,
}

impl Severity {
    /// The word in texts for users.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Error => "error",
            Self::Warning => "warning",
            Self::Info => "remark",
        }
    }
}

/// Kind of fix that the findings of a rule have.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize),
    serde(rename_all = "kebab-case")
)]
pub enum Fixability {
    /// No fix: the user corrects the file.
    None,
    /// A safe fix: afterwards every tool reads what odkit reads now.
    Safe,
    /// An unsafe fix: probably right, but a user should review it.
    Unsafe,
    /// A safe fix if it loses nothing, otherwise an unsafe one.
    Either,
}

impl Fixability {
    /// In one word, for tables.
    pub const fn name(self) -> &'static str {
        match self {
            Self::None => "none",
            Self::Safe => "safe",
            Self::Unsafe => "unsafe",
            Self::Either => "safe or unsafe",
        }
    }
}

/// The sentences of a finding, with blanks such as `{low}` that its facts fill.
///
/// The catalogue describes the blanks.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct Form {
    /// The fault: one clause without a full stop.
    pub says: &'static str,
    /// The text to write instead, or the allowed values.
    pub help: &'static str,
}

impl Form {
    /// The sentences of the rule itself: `Form { says: "…", ..Form::OWN }` keeps the rule's help.
    pub(crate) const OWN: Self = Self { says: "", help: "" };
}

/// The check of a rule: what it looks at, and the function that reports the findings.
#[derive(Clone, Copy)]
pub(crate) enum Check {
    /// A check of each value.
    Entry(fn(&Entry<'_>, &mut Vec<Finding>)),
    /// A check of each object.
    Object(fn(&Object<'_>, &mut Vec<Finding>)),
    /// A check of the whole description.
    Device(fn(&Description, &mut Vec<Finding>)),
    /// Other code calls the constructor in the rule's file: while odkit reads the text, applies
    /// edits, or writes a target that cannot express all content.
    Elsewhere,
}

/// One rule: the meaning of its code, the sentences of its findings, and its check.
#[derive(Clone, Copy)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct Rule {
    /// Stable code. Its letter is that of the first severity of the rule. A code never changes its
    /// meaning or its letter.
    pub code: &'static str,
    /// Severity of its findings, unless a finding has its own.
    pub severity: Severity,
    /// The class of the fault, in a few words.
    pub title: &'static str,
    /// The consequence for a master or a tool, then what odkit does.
    pub why: &'static str,
    /// Document and clause.
    pub source: &'static str,
    /// The fix that `odkit check` can apply.
    pub fixability: Fixability,
    /// A statement of a macro call, or a description of a file, that breaks the rule; empty for a
    /// rule with a pair of files.
    pub example: &'static str,
    /// The fault: one clause without a full stop. A finding may use one of `also` instead.
    #[cfg_attr(feature = "serde", serde(skip))]
    pub says: &'static str,
    /// The text to write instead, or the allowed values.
    #[cfg_attr(feature = "serde", serde(skip))]
    pub help: &'static str,
    /// Other sentences of its findings.
    #[cfg_attr(feature = "serde", serde(skip))]
    pub also: &'static [Form],
    /// Whether a device can be built from the file although this is an error; then only its master
    /// fails.
    pub buildable: bool,
    /// The check that reports its findings.
    #[cfg_attr(feature = "serde", serde(skip))]
    pub(crate) check: Check,
}

impl PartialEq for Rule {
    fn eq(&self, other: &Self) -> bool {
        self.code == other.code
    }
}
impl Eq for Rule {}

impl fmt::Debug for Rule {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.code)
    }
}

impl Rule {
    /// The defaults of a rule with this code: its letter gives the severity. A rule whose severity was
    /// raised sets `severity`, too.
    pub(crate) const fn of(code: &'static str) -> Self {
        let severity = match code.as_bytes() {
            [b'E', ..] => Severity::Error,
            [b'W', ..] => Severity::Warning,
            _ => Severity::Info,
        };
        Self {
            code,
            severity,
            ..Self::NEW
        }
    }

    /// The defaults of words that several rules share.
    pub(crate) const NEW: Self = Self {
        code: "",
        severity: Severity::Info,
        title: "",
        why: "",
        source: "",
        fixability: Fixability::None,
        example: "",
        says: "",
        help: "",
        also: &[],
        buildable: false,
        check: Check::Elsewhere,
    };

    /// Returns whether a finding depends on one value only, not on other objects.
    pub const fn is_of_one_value(&self) -> bool {
        matches!(self.check, Check::Entry(_))
    }

    /// All sentences that its findings can have.
    pub fn forms(&self) -> impl Iterator<Item = Form> {
        let own = Form {
            says: self.says,
            help: self.help,
        };
        let or = |given: &'static str, own| if given.is_empty() { own } else { given };
        let also = self.also.iter().map(move |also| Form {
            says: or(also.says, own.says),
            help: or(also.help, own.help),
        });
        core::iter::once(own).chain(also)
    }

    /// A finding of this rule; place and facts are added to it.
    pub(crate) fn finding(&'static self) -> Finding {
        Finding {
            rule: self,
            severity: self.severity,
            form: Form {
                says: self.says,
                help: self.help,
            },
            place: Place::Nowhere,
            object: None,
            key: None,
            facts: Vec::new(),
            related: Vec::new(),
            fix: None,
            is_xml: false,
        }
    }

    /// A finding of this rule at `span`.
    pub(crate) fn at(&'static self, span: Span) -> Finding {
        Finding {
            place: Place::from(span),
            ..self.finding()
        }
    }

    /// A finding at a piece of the text; the piece is its fact `given`.
    pub(crate) fn given(&'static self, given: &Spanned<impl AsRef<str>>) -> Finding {
        self.at(given.span).fact("given", given.as_ref())
    }

    /// A finding about a value or an object, at `span`, or at the subject if `span` is in no text.
    pub(crate) fn on(&'static self, subject: &impl Subject, span: Span) -> Finding {
        self.at(span.or(subject.span())).about(subject.address())
    }
}

/// Place of a finding.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Place {
    /// In the text.
    Text(Span),
    /// At the token of the caller with this number.
    Token(u32),
    /// Something is missing, so there is no place.
    Nowhere,
}

impl From<Span> for Place {
    fn from(span: Span) -> Self {
        match (span.line, token_of(span)) {
            (0, _) => Self::Nowhere,
            (_, Some(id)) => Self::Token(id),
            _ => Self::Text(span),
        }
    }
}

/// A second place that belongs to a finding.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct Related {
    /// Place that the label marks.
    pub span: Span,
    /// The label, with blanks as in a [`Form`].
    pub says: &'static str,
}

/// One report at one place, as data; [`say`](crate::say) makes the sentence.
#[derive(Clone, PartialEq, Debug)]
pub struct Finding {
    /// The rule that reports it.
    pub rule: &'static Rule,
    /// Severity: that of the rule, unless this finding or the settings of a project have another.
    pub severity: Severity,
    /// Its sentences, with blanks.
    pub form: Form,
    /// Place of the finding.
    pub place: Place,
    /// The object of the finding, if it has one.
    pub object: Option<Address>,
    /// The wrong key, if it is a key of an object.
    pub key: Option<Key>,
    /// Values of the blanks, by name.
    pub facts: Vec<(&'static str, Fact)>,
    /// Second places.
    pub related: Vec<Related>,
    /// Automatic fix, if there is one.
    pub fix: Option<Fix>,
    /// Whether the file is an XDD, whose terms are in its sentences.
    pub is_xml: bool,
}

impl Finding {
    /// Stable code of its rule, for example `E0412`.
    pub const fn code(&self) -> &'static str {
        self.rule.code
    }

    /// Severity of the finding.
    pub const fn severity(&self) -> Severity {
        self.severity
    }

    /// Returns whether it is an error.
    pub fn is_error(&self) -> bool {
        self.severity == Severity::Error
    }

    /// Returns whether it is an error with which no working device can be built.
    pub fn is_unsound(&self) -> bool {
        self.is_error() && !self.rule.buildable
    }

    /// Returns whether it may be a consequence of errors in what describes the values at these addresses: it depends
    /// on one of them, or on the whole device.
    pub fn may_follow(&self, broken: &BTreeSet<Address>) -> bool {
        if broken.is_empty() {
            return false;
        }
        match self.object {
            None => true,
            Some(own) if self.rule.is_of_one_value() => broken.contains(&own),
            Some(own) => {
                let is_broken = |index| broken.iter().any(|address| address.index == index);
                let mut facts = self.facts.iter();
                is_broken(own.index) || facts.any(|(_, fact)| fact.is_about(&is_broken))
            }
        }
    }

    /// Place of the finding; `None` if something is missing.
    pub const fn span(&self) -> Option<Span> {
        match self.place {
            Place::Text(span) => Some(span),
            Place::Token(id) => Some(token(id)),
            Place::Nowhere => None,
        }
    }

    /// Adds the object.
    #[must_use]
    pub(crate) fn about(mut self, object: Address) -> Self {
        self.object = Some(object);
        self
    }

    /// Adds the object at an index, also as its fact `object`.
    #[must_use]
    pub(crate) fn index(self, index: u16) -> Self {
        self.about(Address::new(index, 0))
            .fact("object", Fact::Index(index))
    }

    /// Replaces the severity of the rule by the one of this finding.
    #[must_use]
    pub(crate) fn severity_of(mut self, severity: Severity) -> Self {
        self.severity = severity;
        self
    }

    /// Uses another sentence of the rule.
    #[must_use]
    pub(crate) fn form(mut self, form: &Form) -> Self {
        for (own, other) in [
            (&mut self.form.says, form.says),
            (&mut self.form.help, form.help),
        ] {
            if !other.is_empty() {
                *own = other;
            }
        }
        self
    }

    /// Adds a second place and its label, which may have blanks.
    #[must_use]
    pub(crate) fn related(mut self, span: Span, says: &'static str) -> Self {
        if span.line != 0 {
            self.related.push(Related { span, says });
        }
        self
    }

    /// Adds the wrong key.
    #[must_use]
    pub(crate) fn key(mut self, key: Key) -> Self {
        self.key = Some(key);
        self
    }

    /// Adds a fact for the blank of this name.
    #[must_use]
    pub(crate) fn fact(mut self, name: &'static str, fact: impl Into<Fact>) -> Self {
        self.facts.push((name, fact.into()));
        self
    }

    /// Adds a fix, unless one of its edits has no place in a text.
    #[must_use]
    pub(crate) fn fix(mut self, fix: Fix) -> Self {
        self.fix = fix.placed();
        self
    }
}

/// File order; findings without a place come last.
pub(crate) fn sort(findings: &mut [Finding]) {
    findings.sort_by_key(|finding| match finding.place {
        Place::Text(span) => (0, span.line, span.column),
        Place::Token(_) => (1, 0, 0),
        Place::Nowhere => (2, 0, 0),
    });
}
