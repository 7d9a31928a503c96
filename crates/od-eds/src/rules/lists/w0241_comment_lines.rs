use alloc::format;
use alloc::string::String;
use alloc::vec::Vec;

use crate::description::Description;
use crate::finding::{Check, Finding, Fixability, Form, Rule};
use crate::fix::Fix;
use crate::scan::number::number;
use crate::span::Spanned;

pub(crate) static W0241: Rule = Rule {
    title: "Lines does not match [Comments]",
    why: "A tool that trusts Lines shows too few comments, or stops at a missing one.",
    source: "CiA 306-1, Comments",
    fixability: Fixability::Safe,
    says: "Lines is {given}, but [Comments] has {lines:line|lines}",
    help: "write `Lines={lines}`{fix}",
    also: &[MISSING, OTHER],
    check: Check::Device(check),
    ..Rule::of("W0241")
};

/// Sentence for comments without Lines.
const MISSING: Form = Form {
    says: "[Comments] has {lines:line|lines}, but lacks Lines",
    ..Form::OWN
};

/// Sentence for a line outside the numbers that Lines gives.
const OTHER: Form = Form {
    says: "Lines is {lines}, so `{given}` is not read: the lines are Line1 to Line{lines}",
    help: "number the lines from 1, without a gap",
};

fn check(description: &Description, findings: &mut Vec<Finding>) {
    let section = description.section("Comments");
    let Some(section) = section.filter(|_| !description.objects.is_empty()) else {
        return;
    };
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
            let Some(other) = keys.find(is_other) else {
                return;
            };
            let finding = W0241.at(other.span).form(&OTHER);
            finding.fact("given", other.as_str())
        }
        // A tool that counts would lose a line with a higher number.
        Some(given) if highest > lines => W0241.at(given.span).fact("given", given.as_str()),
        Some(given) => W0241
            .at(given.span)
            .fact("given", given.as_str())
            .fix(Fix::safe().replace(given.span, format!("{lines}"))),
        None if lines == 0 => return,
        None => W0241
            .at(name)
            .form(&MISSING)
            .fix(Fix::safe().below(name, format!("Lines={lines}"))),
    };
    findings.push(finding.fact("lines", lines));
}
