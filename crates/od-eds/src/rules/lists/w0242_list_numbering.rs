use alloc::string::ToString;

use crate::finding::{Finding, Fixability, Rule, Severity::Error};
use crate::fix::Fix;
use crate::scan::number::number;
use crate::scan::placed::{Placed, Text};

pub(crate) static RULE: Rule = Rule {
    code: "W0242",
    severity: Error,
    buildable: true,
    title: "list entries are not numbered 1, 2, 3",
    why: "Many tools ask for entries 1, 2, 3 up to SupportedObjects and miss an entry with another number. odkit reads all entries.",
    source: "CiA 306-1, object lists",
    fixability: Fixability::Safe,
    says: "entry {place} of the list has number {number}",
    help: "number the entries 1, 2, 3 and so on{fix}",
    ..Rule::NEW
};

/// The finding about the first entry of a list whose number is not its place.
pub(crate) fn finding(renumbered: Fix, key: &Text<'_>, place: i128) -> Finding {
    RULE.at(key.span)
        .fact("place", place)
        .fact("number", &*key.value)
        .fix(renumbered)
}

/// Gives every entry the number of its place.
pub(crate) fn renumbered(list: &Placed<'_>) -> Fix {
    let entries = list.pairs.iter();
    let entries = entries.filter(|(key, _)| number(key).is_some());
    (1i128..)
        .zip(entries)
        .fold(Fix::safe(), |fix, (place, (key, _))| {
            if number(key) == Some(place) {
                fix
            } else {
                fix.replace(key.span, place.to_string())
            }
        })
}
