//! Rules about LowLimit and HighLimit: values outside them, limits in the wrong order, and limits
//! that allow only one value.

use alloc::vec::Vec;
use core::cmp::Ordering;

use crate::description::Value;
use crate::fact::{Key, shown};
use crate::finding::{Check, Finding, Fixability, Form, Rule};
use crate::fix::Fix;
use crate::rules::values::shared::values;
use crate::span::Spanned;
use crate::subject::{Entry, start_value};

pub(crate) static E0414: Rule = Rule {
    title: "configured value is outside its limits",
    why: "A device aborts the download of a value outside its limits, so a master cannot configure it.",
    source: "CiA 306-1, LowLimit and HighLimit",
    says: BELOW,
    help: WITHIN,
    also: &[ABOVE],
    check: Check::Entry(check_configured),
    ..Rule::of("E0414")
};

fn check_configured(entry: &Entry<'_>, findings: &mut Vec<Finding>) {
    let fails = outside(entry).filter(fails);
    findings.extend(fails.map(|outside| outside.finding(&E0414, entry)));
}

/// A master that configures by a DCF receives an abort; a default is only unusual.
fn fails(outside: &Outside<'_>) -> bool {
    outside.key == Key::ParameterValue
}

pub(crate) static W0452: Rule = Rule {
    title: "default value is outside its limits",
    why: "A device that checks its limits does not accept its own default value. odkit uses the default value as it is.",
    source: "CiA 306-1, LowLimit and HighLimit",
    says: BELOW,
    help: WITHIN,
    also: &[ABOVE],
    check: Check::Entry(check_default),
    ..Rule::of("W0452")
};

fn check_default(entry: &Entry<'_>, findings: &mut Vec<Finding>) {
    let odd = outside(entry).filter(|outside| !fails(outside));
    findings.extend(odd.map(|outside| outside.finding(&W0452, entry)));
}

pub(crate) static E0415: Rule = Rule {
    title: "LowLimit is greater than HighLimit",
    why: "No value lies between the two, so a master cannot write the object.",
    source: "CiA 306-1, LowLimit and HighLimit",
    fixability: Fixability::Unsafe,
    says: "{LowLimit} `{low}` is greater than {HighLimit} `{high}`",
    help: "swap the two limits{fix}, or remove both",
    check: Check::Entry(check_order),
    ..Rule::of("E0415")
};

fn check_order(entry: &Entry<'_>, findings: &mut Vec<Finding>) {
    let (low, high) = limits(entry);
    if let (Some(low), Some(high), true) = (low, high, crossed(low, high)) {
        let swap = Fix::unsafe_fix()
            .replace(low.span, shown(high))
            .replace(high.span, shown(low));
        // The limit that the value of the object contradicts alone.
        let value = start_value(entry);
        let is_beyond =
            |limit, wrong| value.is_some_and(|value| order(value, limit) == Some(wrong));
        let is_high = is_beyond(high, Ordering::Greater) && !is_beyond(low, Ordering::Less);
        let (key, own, other, label) = if is_high {
            (Key::HighLimit, high, low, "{LowLimit} set here")
        } else {
            (Key::LowLimit, low, high, "{HighLimit} set here")
        };
        let finding = E0415.on(entry, own.span).key(key);
        let finding = finding
            .fact("low", low.value.clone())
            .fact("high", high.value.clone());
        findings.push(finding.related(other.span, label).fix(swap));
    }
}

pub(crate) static I0450: Rule = Rule {
    title: "limits allow only one value",
    why: "A master can write the object, but only to the value that it has. Editors often leave such limits.",
    source: "CiA 306-1, LowLimit and HighLimit",
    says: "{LowLimit} equals {HighLimit}, so this `{access}` object can have only one value",
    help: "write the limits of the device, or remove both",
    check: Check::Entry(check_single),
    ..Rule::of("I0450")
};

fn check_single(entry: &Entry<'_>, findings: &mut Vec<Finding>) {
    if let (Some(low), Some(high)) = (&entry.low, &entry.high)
        && low.value == high.value
        && entry.access.writable()
    {
        let finding = I0450.on(entry, high.span).fact("access", *entry.access);
        findings.push(finding.related(low.span, "{LowLimit} set here"));
    }
}

/// The limits of an entry that are valid for its type.
fn limits<'a>(entry: &Entry<'a>) -> (Option<&'a Spanned<Value>>, Option<&'a Spanned<Value>>) {
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
struct Outside<'a> {
    key: Key,
    value: &'a Spanned<Value>,
    limit: &'a Spanned<Value>,
    /// The limit.
    side: Key,
}

/// The sentence for a value below its limit.
const BELOW: &str = "{key} `{value}` is less than {LowLimit} `{limit}`";

/// The help for a value outside its limits.
const WITHIN: &str = "write {key} within the limits, or correct the limit";

/// The sentence for a value above its limit.
const ABOVE: Form = Form {
    says: "{key} `{value}` is greater than {HighLimit} `{limit}`",
    ..Form::OWN
};

impl Outside<'_> {
    /// The finding about it.
    fn finding(&self, rule: &'static Rule, entry: &Entry<'_>) -> Finding {
        let (at, other, label) = if self.is_limit_wrong(entry) {
            (self.limit, self.value, "value set here")
        } else {
            (self.value, self.limit, "limit set here")
        };
        let finding = rule
            .on(entry, at.span)
            .key(self.key)
            .fact("value", self.value.value.clone())
            .fact("limit", self.limit.value.clone())
            .related(other.span, label);
        match self.side {
            Key::HighLimit => finding.form(&ABOVE),
            _ => finding,
        }
    }

    /// Returns whether the limit contradicts more than the value: it allows no other value than one, or depends on the node
    /// ID as the value does not.
    fn is_limit_wrong(&self, entry: &Entry<'_>) -> bool {
        let is_formula = |value: &Value| matches!(value, Value::NodeId(_));
        let least = entry.data_type.and_then(|own| own.integer_range());
        let is_single = match (limits(entry), least) {
            ((Some(low), Some(high)), _) => order(low, high) == Some(Ordering::Equal),
            ((None, Some(high)), Some((least, _))) => high.integer(1) == Some(least),
            _ => false,
        };
        is_single || is_formula(self.limit) && !is_formula(self.value)
    }
}

/// The default and the configured value, each with every limit that it exceeds; nothing if the
/// limits allow no value.
fn outside<'a>(entry: &Entry<'a>) -> impl Iterator<Item = Outside<'a>> + use<'a> {
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

/// Returns whether the low limit is above the high one.
fn crossed(low: Option<&Spanned<Value>>, high: Option<&Spanned<Value>>) -> bool {
    let order = low.zip(high).and_then(|(low, high)| order(low, high));
    order == Some(Ordering::Greater)
}

/// Order of two values for every node ID; `None` if it depends on the node ID, or if they cannot be
/// compared.
pub(crate) fn order(a: &Value, b: &Value) -> Option<Ordering> {
    if let (Value::Real(a), Value::Real(b)) = (a, b) {
        return a.partial_cmp(b);
    }
    let at = |id| Some(a.integer(id)?.cmp(&b.integer(id)?));
    let (first, last) = (at(1)?, at(127)?);
    (first == last).then_some(first)
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
