//! Findings of a text, for a list.

#[cfg(feature = "eds")]
use od_eds::{Eds, Finding, say};
use od_sim::script::Problem;

use crate::crossing::{record, words};
use crate::places::Fix;
#[cfg(feature = "eds")]
use crate::places::Places;

words! {
    Severity {
        Error = "error",
        Warning = "warning",
        Info = "info",
    }
}

record! {
    /// A finding in an EDS text.
    Diagnostic {
        /// Stable, such as `E0412`.
        code: &'static str,
        severity: Severity,
        message: String,
        /// Help; empty if the message contains it.
        help: String,
        /// Line number, counted from 1; 0 if the finding is about something that is missing.
        line: u32,
        column: u32,
        /// The object it is about, such as `6004h`, or empty.
        object: String,
        /// The automatic fix, if there is one.
        fix: Option<Fix>,
    }
}

/// A message without a place in a text.
pub(crate) fn message(text: &str) -> Diagnostic {
    plain(text, "", 0, 0)
}

/// A problem in the text of a lesson.
pub(crate) fn problem(one: &Problem) -> Diagnostic {
    plain(&one.message, &one.help, one.line, one.column)
}

fn plain(message: &str, help: &str, line: u32, column: usize) -> Diagnostic {
    Diagnostic {
        code: "",
        severity: Severity::Error,
        message: message.into(),
        help: help.into(),
        line,
        column: column as u32,
        object: String::new(),
        fix: None,
    }
}

#[cfg(feature = "eds")]
pub(crate) fn findings(found: &[Finding], text: &str) -> Vec<Diagnostic> {
    let places = Places::of(text);
    found.iter().map(|one| finding(one, &places)).collect()
}

#[cfg(feature = "eds")]
pub(crate) fn finding(one: &Finding, places: &Places<'_>) -> Diagnostic {
    let one = say(one, &Eds);
    let span = one.span.unwrap_or_default();
    let object = one.address.map(|address| address.to_string());
    Diagnostic {
        code: one.code,
        severity: match one.severity {
            od_eds::Severity::Error => Severity::Error,
            od_eds::Severity::Warning => Severity::Warning,
            od_eds::Severity::Info => Severity::Info,
        },
        message: one.message,
        help: one.help,
        line: span.line,
        column: span.column,
        object: object.unwrap_or_default(),
        fix: one.fix.as_ref().and_then(|fix| places.fix(fix)),
    }
}
