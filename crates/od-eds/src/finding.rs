//! Rules and findings as plain data; nothing here is put into words.

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
    /// Worth knowing.
    Info,
    /// Many shipped files have it; a device can be built.
    Warning,
    /// No sound device can be built, or a master fails.
    Error,
}

/// The fix that the findings of a rule have.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize),
    serde(rename_all = "kebab-case")
)]
pub enum Fixability {
    /// No fix: the user corrects the file.
    None,
    /// A safe fix: every tool then reads what odkit reads now.
    Safe,
    /// An unsafe fix: likely right, to be reviewed.
    Unsafe,
    /// Safe if nothing is lost by it, otherwise unsafe.
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

/// The sentences of a finding, with blanks such as `{low}`, which facts fill.
///
/// The catalogue lists what a blank can be.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct Form {
    /// The fault, one clause without a full stop.
    pub says: &'static str,
    /// The text to write instead, or the values allowed.
    pub help: &'static str,
}

impl Form {
    /// The sentences of the rule itself: `Form { says: "…", ..Form::OWN }` has the rule's help.
    pub(crate) const OWN: Self = Self { says: "", help: "" };
}

/// The way to the findings of a rule.
#[derive(Clone, Copy)]
pub(crate) enum Check {
    /// By looking at each value.
    Entry(fn(&Entry<'_>, &mut Vec<Finding>)),
    /// By looking at each object.
    Object(fn(&Object<'_>, &mut Vec<Finding>)),
    /// By looking at the whole description.
    Device(fn(&Description, &mut Vec<Finding>)),
    /// By the code that calls the constructor in the rule's file: while odkit reads the text, applies edits, or
    /// writes a target that cannot express all.
    Elsewhere,
}

/// One rule: what a code means, what its findings say, and how they are found.
#[derive(Clone, Copy)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct Rule {
    /// Stable code. The letter is that of the severity that the rule began with; a code never changes its meaning,
    /// nor its letter.
    pub code: &'static str,
    /// Severity of its findings, except of one that has another consequence.
    pub severity: Severity,
    /// The class of fault, in a few words.
    pub title: &'static str,
    /// The consequence for a master or a tool, then what odkit does.
    pub why: &'static str,
    /// Document and clause.
    pub source: &'static str,
    /// The fix that `odkit check` can apply.
    pub fixability: Fixability,
    /// A statement of a macro call, or a file in words, that breaks the rule; empty for a rule
    /// with a pair of files.
    pub example: &'static str,
    /// The fault, unless a finding takes one of `also`: one clause without a full stop.
    #[cfg_attr(feature = "serde", serde(skip))]
    pub says: &'static str,
    /// The text to write instead, or the values allowed.
    #[cfg_attr(feature = "serde", serde(skip))]
    pub help: &'static str,
    /// Other sentences of its findings.
    #[cfg_attr(feature = "serde", serde(skip))]
    pub also: &'static [Form],
    /// Can a device be built of the file all the same? Then only its master fails.
    pub buildable: bool,
    /// The way to the findings.
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
    /// The defaults of a rule.
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

    /// Returns whether a finding is about one value alone, whatever the other objects are.
    pub const fn is_of_one_value(&self) -> bool {
        matches!(self.check, Check::Entry(_))
    }

    /// All that its findings can say.
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
        }
    }

    /// A finding of this rule at `span`.
    pub(crate) fn at(&'static self, span: Span) -> Finding {
        Finding {
            place: Place::from(span),
            ..self.finding()
        }
    }

    /// A finding at a piece of the text, which is its fact `given`.
    pub(crate) fn given(&'static self, given: &Spanned<impl AsRef<str>>) -> Finding {
        self.at(given.span).fact("given", given.as_ref())
    }

    /// A finding about a value or an object; there if `span` is in no text.
    pub(crate) fn on(&'static self, subject: &impl Subject, span: Span) -> Finding {
        self.at(span.or(subject.span())).about(subject.address())
    }
}

/// Place of a finding.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Place {
    /// In the text.
    Text(Span),
    /// At the caller's token of this number.
    Token(u32),
    /// Something is missing altogether.
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
    /// The label, with blanks as a [`Form`] has them.
    pub says: &'static str,
}

/// One report at one place, as data: [`say`](crate::say) makes the sentence.
#[derive(Clone, PartialEq, Debug)]
pub struct Finding {
    /// The rule that reports it.
    pub rule: &'static Rule,
    /// Severity: that of the rule, unless this finding has another consequence or a project has another opinion.
    pub severity: Severity,
    /// Its sentences, with blanks.
    pub form: Form,
    /// Place of the finding.
    pub place: Place,
    /// The object it is about, if it is about one.
    pub object: Option<Address>,
    /// The key that is wrong, if it is one of an object.
    pub key: Option<Key>,
    /// Content of the blanks, by name.
    pub facts: Vec<(&'static str, Fact)>,
    /// Second places.
    pub related: Vec<Related>,
    /// Automatic fix, if there is one.
    pub fix: Option<Fix>,
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

    /// Is it an error?
    pub fn is_error(&self) -> bool {
        self.severity == Severity::Error
    }

    /// Is it an error with which no sound device can be built?
    pub fn is_unsound(&self) -> bool {
        self.is_error() && !self.rule.buildable
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

    /// Adds the object at an index, which is its fact `object`.
    #[must_use]
    pub(crate) fn index(self, index: u16) -> Self {
        self.about(Address::new(index, 0))
            .fact("object", Fact::Index(index))
    }

    /// With the severity of its own consequence, where that is not the one of the rule.
    #[must_use]
    pub(crate) fn severity_of(mut self, severity: Severity) -> Self {
        self.severity = severity;
        self
    }

    /// Says another of the rule's sentences.
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

    /// Adds the key that is wrong.
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

    /// Adds a fix; none if one of its edits has no place in a text.
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
