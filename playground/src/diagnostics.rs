//! Findings of a text, for a list.

use od_bench::script::Problem;
#[cfg(feature = "eds")]
use od_eds::{Eds, Finding, Severity, say};
use wasm_bindgen::JsValue;

#[cfg(feature = "eds")]
use crate::fixes::Places;
use crate::record::Record;
#[cfg(feature = "eds")]
use crate::record::list;

/// A sentence.
pub(crate) fn message(text: &str) -> JsValue {
    plain(text, "", 0, 0)
}

/// A problem in the text of a lesson.
pub(crate) fn problem(one: &Problem) -> JsValue {
    plain(&one.message, &one.help, one.line, one.column)
}

fn plain(message: &str, help: &str, line: u32, column: usize) -> JsValue {
    Record::new()
        .with("code", "")
        .with("severity", "error")
        .with("message", message)
        .with("help", help)
        .with("line", line)
        .with("column", column as u32)
        .with("object", "")
        .with("fix", JsValue::NULL)
        .done()
}

#[cfg(feature = "eds")]
pub(crate) fn findings(found: &[Finding], text: &str) -> JsValue {
    let places = Places::of(text);
    list(found.iter().map(|one| finding(one, &places)))
}

#[cfg(feature = "eds")]
pub(crate) fn finding(one: &Finding, places: &Places<'_>) -> JsValue {
    let one = say(one, &Eds);
    let span = one.span.unwrap_or_default();
    Record::new()
        .with("code", one.code)
        .with(
            "severity",
            match one.severity {
                Severity::Error => "error",
                Severity::Warning => "warning",
                Severity::Info => "info",
            },
        )
        .with("message", one.message.as_str())
        .with("help", one.help.as_str())
        .with("line", span.line)
        .with("column", span.column)
        .with(
            "object",
            one.address
                .map(|address| address.to_string())
                .unwrap_or_default(),
        )
        .with("fix", places.fix(one.fix.as_ref()))
        .done()
}
