use alloc::string::String;
use alloc::vec::Vec;

use crate::finding::{Check, Finding, Rule};
use crate::span::Spanned;
use crate::subject::Object;
use crate::subject::Subject;

pub(crate) static W0344: Rule = Rule {
    title: "name is longer than 241 characters",
    why: "Some tools cut a name after 241 characters, the limit of CiA 306.",
    source: "CiA 306-1, object sections",
    says: "the name has {length} characters; the limit is {limit}",
    help: "write a shorter name",
    check: Check::Object(check),
    ..Rule::of("W0344")
};

/// Longest name, in characters.
const LIMIT: usize = 241;

fn check(object: &Object<'_>, findings: &mut Vec<Finding>) {
    report(object, &object.name, findings);
    if object.code.has_members() {
        object
            .entries()
            .for_each(|entry| report(&entry, &entry.name, findings));
    }
}

fn report(subject: &impl Subject, name: &Spanned<String>, findings: &mut Vec<Finding>) {
    let length = name.chars().count();
    if length > LIMIT {
        let finding = W0344.on(subject, name.span).fact("length", length);
        findings.push(finding.fact("limit", LIMIT));
    }
}
