use alloc::format;
use alloc::string::String;
use alloc::vec::Vec;

use crate::description::{Description, Section};
use crate::finding::{Check, Finding, Fixability, Form, Rule};
use crate::fix::Fix;
use crate::scan::number::number;
use crate::span::Spanned;

pub(crate) static W0241: Rule = Rule {
    title: "Lines does not match the comments",
    why: "A tool that trusts Lines shows too few comments, or stops at a missing one.",
    source: "CiA 306-1, Comments and MxComments",
    fixability: Fixability::Safe,
    says: "Lines is {given}, but [{section}] has {lines:line|lines}",
    help: "write `Lines={lines}`{fix}",
    also: &[MISSING, OTHER],
    check: Check::Device(check),
    ..Rule::of("W0241")
};

/// Sentence for comments without Lines.
const MISSING: Form = Form {
    says: "[{section}] has {lines:line|lines}, but lacks Lines",
    ..Form::OWN
};

/// Sentence for a line outside the numbers that Lines gives.
const OTHER: Form = Form {
    says: "Lines of [{section}] is {lines}, so `{given}` is not read: the lines are Line1 to Line{lines}",
    help: "number the lines from 1, without a gap",
};

fn check(description: &Description, findings: &mut Vec<Finding>) {
    let sections = description.sections.iter();
    let sections = sections.filter(|section| is_comments(&section.name));
    if !description.objects.is_empty() {
        findings.extend(sections.filter_map(lines_differ));
    }
}

/// Returns whether a section has the comments of the device, or of a module (`M1Comments`).
fn is_comments(name: &str) -> bool {
    let start = name.len().checked_sub("Comments".len());
    let Some((start, word)) = start.and_then(|at| name.split_at_checked(at)) else {
        return false;
    };
    let module = start.strip_prefix(['M', 'm']).and_then(number);
    word.eq_ignore_ascii_case("Comments") && (start.is_empty() || module.is_some())
}

/// The finding about the comments in a section.
fn lines_differ(section: &Section) -> Option<Finding> {
    let line = |key: &str| {
        let word = key.get(.."Line".len())?;
        let is_line = word.eq_ignore_ascii_case("Line");
        is_line
            .then(|| key["Line".len()..].parse::<u32>().ok())
            .flatten()
    };
    let numbers = section.pairs.iter().filter_map(|(key, _)| line(key));
    let (lines, highest) = numbers.fold((0, 0), |(lines, highest), number| {
        (lines + 1, number.max(highest))
    });
    let name = section.name.span;
    let finding = match section.get("Lines") {
        Some(given) if number(given) == Some(i128::from(lines)) => {
            let mut keys = section.pairs.iter().map(|(key, _)| key);
            let is_other = |key: &&Spanned<String>| {
                line(key).is_some_and(|number| !(1..=lines).contains(&number))
            };
            let other = keys.find(is_other)?;
            let finding = W0241.at(other.span).form(&OTHER);
            finding.fact("given", other.as_str())
        }
        // A tool that counts would lose a line with a higher number.
        Some(given) if highest > lines => W0241.at(given.span).fact("given", given.as_str()),
        Some(given) => W0241
            .at(given.span)
            .fact("given", given.as_str())
            .fix(Fix::safe().replace(given.span, format!("{lines}"))),
        None if lines == 0 => return None,
        None => W0241
            .at(name)
            .form(&MISSING)
            .fix(Fix::safe().below(name, format!("Lines={lines}"))),
    };
    let finding = finding.fact("section", section.name.as_str());
    Some(finding.fact("lines", lines))
}
