use alloc::string::String;
use alloc::vec::Vec;

use crate::finding::{Check, Finding, Form, Rule};
use crate::scan::section::Text;
use crate::span::Spanned;
use crate::subject::Object;
use crate::subject::Subject;

pub(crate) static W0344: Rule = Rule {
    title: "name or text is too long for its line",
    why: "Some tools cut a line after 255 characters, the limit of CiA 306: 241 for a name, 244 for VendorName.",
    source: "CiA 306-1, file format and object sections",
    says: "the name has {length} characters; the limit is {limit}",
    help: "write a shorter name",
    also: &[TEXT],
    check: Check::Object(check),
    ..Rule::of("W0344")
};

/// Sentence for a text outside the object sections.
const TEXT: Form = Form {
    says: "{field} has {length} characters; the limit is {limit}",
    help: "write a shorter text",
};

/// Longest line, in characters.
const LINE: usize = 255;

/// Longest name, in characters.
const LIMIT: usize = LINE - "ParameterName=".len();

/// The finding about the text of a key whose line is too long; `None` if it is not.
pub(crate) fn text_too_long(key: &str, given: &Text<'_>) -> Option<Finding> {
    let length = given.chars().count();
    let limit = LINE.saturating_sub(key.len() + "=".len());
    let finding = W0344.at(given.span).form(&TEXT).fact("field", key);
    let finding = finding.fact("length", length).fact("limit", limit);
    (length > limit).then_some(finding)
}

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
