//! Shared by the rules about values: the values of an entry, and values that do not fit their type.

use core::cmp::Ordering;

use od_model::{DataType, Kind};

use crate::description::Value;
use crate::fact::{Fact, Key};
use crate::finding::{Finding, Form, Rule};
use crate::fix::Fix;
use crate::scan::placed::Text;
use crate::span::{Span, Spanned};
use crate::subject::Entry;

/// The label at a DataType.
pub(crate) const DECLARED: &str = "declared as {type} here";

/// The sentence for a value that is not valid for its type.
pub(crate) const NOT_VALID: &str = "{key} `{given}` is not a valid {type}";

/// The sentences for a type that only a RECORD has.
pub(crate) const WHOLE: Form = Form {
    says: "{type} is the type of a RECORD, not of a value",
    help: "write the type of a single value, such as `{DataType={right}}` ({right})",
};

/// The help for a formula that is not valid.
pub(super) const FORMULA: Form = Form {
    help: "write `$NODEID` and a number, such as `$NODEID+0x180`",
    ..Form::OWN
};

/// The type of an entry's value, if it is one that a value can have.
pub(super) fn data_type(entry: &Entry<'_>) -> Option<Spanned<DataType>> {
    entry
        .data_type
        .filter(|data_type| data_type.kind() != Kind::Record)
}

/// The values of an entry, each with its key.
pub(super) fn values<'a>(
    entry: &Entry<'a>,
) -> impl Iterator<Item = (Key, &'a Spanned<Value>)> + use<'a> {
    let entry = entry.entry;
    let values = [
        (Key::DefaultValue, &entry.default),
        (Key::ParameterValue, &entry.parameter),
        (Key::LowLimit, &entry.low),
        (Key::HighLimit, &entry.high),
    ];
    let values = values.into_iter();
    values.filter_map(|(key, value)| Some((key, value.as_ref()?)))
}

/// The finding that a value, as it is given, is not valid for its type.
pub(crate) fn unfit(
    rule: &'static Rule,
    key: Key,
    given: impl Into<Fact>,
    span: Span,
    data_type: Spanned<DataType>,
) -> Finding {
    rule.at(span)
        .key(key)
        .fact("given", given)
        .fact("type", *data_type)
        .fact("form", Fact::FormOf(*data_type))
        .related(data_type.span, DECLARED)
}

/// The finding that a formula is not valid.
pub(crate) fn unfit_formula(
    rule: &'static Rule,
    key: Key,
    given: &Text<'_>,
    data_type: Spanned<DataType>,
) -> Finding {
    let finding = rule.at(given.span).form(&FORMULA).key(key);
    let finding = finding
        .fact("given", &*given.value)
        .fact("type", *data_type);
    finding.related(data_type.span, DECLARED)
}

/// Reports the values under these keys that are not valid for their type; formulas have other rules.
pub(super) fn report_unfit(
    rule: &'static Rule,
    entry: &Entry<'_>,
    keys: &[Key],
    findings: &mut alloc::vec::Vec<Finding>,
) {
    let Some(data_type) = data_type(entry) else {
        return;
    };
    for (key, value) in values(entry).filter(|(key, _)| keys.contains(key)) {
        if !matches!(value.value, Value::NodeId(_)) && !value.fits(*data_type) {
            let span = value.span.or(entry.span);
            let finding = unfit(rule, key, value.value.clone(), span, data_type);
            findings.push(finding.about(entry.address));
        }
    }
}

/// The limits of an entry that are values of its type.
pub(super) fn limits<'a>(
    entry: &Entry<'a>,
) -> (Option<&'a Spanned<Value>>, Option<&'a Spanned<Value>>) {
    let Some(data_type) = entry.data_type else {
        return (None, None);
    };
    let fitting = |value: &'a Option<Spanned<Value>>| {
        let value = value.as_ref();
        value.filter(|value| value.fits(*data_type))
    };
    (fitting(&entry.entry.low), fitting(&entry.entry.high))
}

/// A value outside a limit.
pub(super) struct Outside<'a> {
    pub(super) key: Key,
    pub(super) value: &'a Spanned<Value>,
    pub(super) limit: &'a Spanned<Value>,
    /// The limit.
    pub(super) side: Key,
}

/// The sentence for a value below its limit.
pub(super) const BELOW: &str = "{key} `{value}` is less than {LowLimit} `{limit}`";

/// The help for a value outside its limits.
pub(super) const WITHIN: &str = "write {key} within the limits, or correct the limit";

/// The sentence for a value above its limit.
pub(super) const ABOVE: Form = Form {
    says: "{key} `{value}` is greater than {HighLimit} `{limit}`",
    ..Form::OWN
};

impl Outside<'_> {
    /// The finding of it.
    pub(super) fn finding(&self, rule: &'static Rule, entry: &Entry<'_>) -> Finding {
        let finding = rule
            .on(entry, self.value.span)
            .key(self.key)
            .fact("value", self.value.value.clone())
            .fact("limit", self.limit.value.clone())
            .related(self.limit.span, "limit set here");
        match self.side {
            Key::HighLimit => finding.form(&ABOVE),
            _ => finding,
        }
    }
}

/// The default and the configured value, each with every limit that it is outside of; nothing
/// if the limits leave nothing between them.
pub(super) fn outside<'a>(entry: &Entry<'a>) -> impl Iterator<Item = Outside<'a>> + use<'a> {
    let (low, high) = limits(entry);
    let data_type = entry.data_type;
    let sound = !crossed(low, high);
    let values = values(entry).filter(move |(key, value)| {
        let is_limit = matches!(key, Key::LowLimit | Key::HighLimit);
        sound && !is_limit && data_type.is_some_and(|data_type| value.fits(*data_type))
    });
    let sides = [
        (low, Ordering::Less, Key::LowLimit),
        (high, Ordering::Greater, Key::HighLimit),
    ];
    values.flat_map(move |(key, value)| {
        sides.into_iter().filter_map(move |(limit, wrong, side)| {
            let limit = limit?;
            (order(value, limit) == Some(wrong)).then_some(Outside {
                key,
                value,
                limit,
                side,
            })
        })
    })
}

/// Is the low limit above the high one?
pub(super) fn crossed(low: Option<&Spanned<Value>>, high: Option<&Spanned<Value>>) -> bool {
    let order = low.zip(high).and_then(|(low, high)| order(low, high));
    order == Some(Ordering::Greater)
}

/// Order of two values for every node ID; `None` if that depends on it, or they do not compare.
fn order(a: &Value, b: &Value) -> Option<Ordering> {
    if let (Value::Real(a), Value::Real(b)) = (a, b) {
        return a.partial_cmp(b);
    }
    let at = |id| Some(a.integer(id)?.cmp(&b.integer(id)?));
    let (first, last) = (at(1)?, at(127)?);
    (first == last).then_some(first)
}

/// The finding that a value is understood, though not every tool would.
pub(crate) fn read_as(rule: &'static Rule, key: Key, given: &Text<'_>, right: &str) -> Finding {
    rule.at(given.span)
        .key(key)
        .fact("given", &*given.value)
        .fact("right", right)
        .fix(Fix::safe().replace(given.span, right))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn formulas_compare_for_all_nodes_or_not_at_all() {
        use Value::{NodeId, Unsigned};
        assert_eq!(
            order(&NodeId(0x180), &Unsigned(0x200)),
            Some(Ordering::Less)
        );
        assert_eq!(order(&NodeId(0x180), &Unsigned(0x190)), None);
        assert_eq!(order(&NodeId(0), &NodeId(1)), Some(Ordering::Less));
        assert_eq!(order(&Value::Real(1.0), &Unsigned(0)), None);
    }
}
