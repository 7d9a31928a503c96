//! The words that the reader and the checks share.

use alloc::format;
use alloc::string::{String, ToString};

use crate::description::Value;
use crate::fact::Key;
use crate::finding::Finding;
use crate::finding::Rule;
use crate::fix::Fix;
use crate::rules;
use crate::span::{Span, Spanned};
use od_model::{DataType, Kind};

/// The rule that a value of this key breaks if it is none of its type.
pub(crate) fn rule_of(key: &str) -> &'static Rule {
    match key {
        "DefaultValue" => &rules::E0412,
        "ParameterValue" => &rules::E0413,
        _ => &rules::W0416,
    }
}

/// The finding that what stands under `key` is no value of the type.
pub(crate) fn no_value(
    key: &str,
    given: &str,
    span: Span,
    data_type: Spanned<DataType>,
) -> Finding {
    let name = data_type.name();
    let formula = given.to_ascii_uppercase().contains("$NODEID");
    if formula && !data_type.holds_node_id() {
        return no_formula(key, given, span, data_type);
    }
    let finding = rule_of(key)
        .told(span, format!("{key} `{given}` is no {name}"))
        .with_label(data_type.span, format!("{name} is declared here"))
        .with_help(match formula {
            true => "write `$NODEID+` and a number".into(),
            false => match key.ends_with("Limit") {
                true => format!("write {}, or leave it empty", form(*data_type)),
                false => format!("write {}", form(*data_type)),
            },
        });
    let finding = Finding {
        key: Key::of(key),
        ..finding
    };
    match key.ends_with("Limit") {
        // It limits nothing, and is left out by those who cannot read it.
        true => finding.fix(Fix::unsafe_fix().replace(span, "")),
        false => finding,
    }
}

/// The finding that a limit stands where there can be none.
pub(crate) fn no_limit(
    key: &str,
    given: &crate::scan::placed::Text<'_>,
    data_type: Spanned<DataType>,
) -> Finding {
    let name = data_type.name();
    rules::W0416
        .told(
            given.span,
            format!("{key} `{}`: a {name} has no limits", given.value),
        )
        .with_label(data_type.span, format!("{name} is declared here"))
        .with_help(format!("write `{key}=`, or leave the line out"))
        .fix(Fix::unsafe_fix().replace(given.span, ""))
}

/// The finding that a formula stands where the node ID cannot be.
pub(crate) fn no_formula(
    key: &str,
    given: &str,
    span: Span,
    data_type: Spanned<DataType>,
) -> Finding {
    let name = data_type.name();
    let finding = rules::E0417
        .told(span, format!("{key} `{given}`: {name} holds no $NODEID"))
        .with_label(data_type.span, format!("{name} is declared here"))
        .with_help("write a number, or `DataType=0x0007` (UNSIGNED32)");
    Finding {
        key: Key::of(key),
        ..finding
    }
}

/// What a value of the type looks like.
fn form(data_type: DataType) -> String {
    match (data_type.kind(), data_type.integer_range()) {
        (Kind::Boolean, _) => "`0` or `1`".into(),
        (Kind::Real, _) => "a number such as `1.5`".into(),
        (Kind::Text, _) => "a text".into(),
        (Kind::Bytes, _) => "hexadecimal bytes such as `12AB`".into(),
        (_, Some((low, high))) => format!("a number from {low} to {high}"),
        _ => "the value at a member".into(),
    }
}

/// A value in a message: as an EDS would write it.
pub(crate) fn shown(value: &Value) -> String {
    match value {
        Value::Unsigned(v) => v.to_string(),
        Value::Signed(v) => v.to_string(),
        Value::Real(v) => format!("{v:?}"),
        Value::NodeId(0) => "$NODEID".into(),
        Value::NodeId(offset) => format!("$NODEID+0x{offset:X}"),
        Value::Text(text) => format!("{text:?}"),
        Value::Bytes(_) => "bytes".into(),
    }
}
