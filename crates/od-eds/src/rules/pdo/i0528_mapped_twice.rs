use alloc::vec::Vec;

use crate::finding::{Check, Finding, Rule};
use crate::rules::pdo::shared::mapped;
use crate::span::Span;
use crate::subject::Object;

pub(crate) static I0528: Rule = Rule {
    title: "PDO maps an object twice",
    why: "CiA 301 allows it, but it is rarely intended.",
    source: "CiA 301, PDO mapping parameter",
    says: "this entry maps the same object again",
    help: "remove the entry, unless the PDO needs the value twice",
    check: Check::Object(check),
    ..Rule::of("I0528")
};

fn check(object: &Object<'_>, findings: &mut Vec<Finding>) {
    let mut seen: Vec<(u32, Span)> = Vec::new();
    for mapped in mapped(object) {
        let same = |(number, _): &&(u32, Span)| *number == mapped.number && number >> 21 != 0;
        match seen.iter().find(same) {
            Some((_, first)) => {
                findings.push(mapped.finding(&I0528).related(*first, "first mapped here"));
            }
            None => seen.push((mapped.number, mapped.span)),
        }
    }
}
