use alloc::vec::Vec;

use crate::description::Description;
use crate::finding::{Check, Finding, Form, Rule, Severity::Warning};
use crate::scan::number::number;

pub(crate) static W0254: Rule = Rule {
    code: "W0254",
    severity: Warning,
    title: "[XXXXObjectLinks] does not match its objects",
    why: "A tool that shows linked objects together misses one, or looks for an object that does not exist.",
    source: "CiA 306-1, object links",
    says: "ObjectLinks is {given}, but the section has {count:entry|entries}",
    help: "write `ObjectLinks={count}`",
    also: &[TARGET],
    check: Check::Device(check),
    ..Rule::NEW
};

/// Sentence for a link to nothing.
const TARGET: Form = Form {
    says: "linked object {object:04X}h does not exist",
    help: "write the index of an object of this file, or remove the entry",
};

fn check(description: &Description, findings: &mut Vec<Finding>) {
    let is_links = |name: &str| {
        name.get(4..)
            .is_some_and(|word| word.eq_ignore_ascii_case("ObjectLinks"))
    };
    let sections = description.sections.iter();
    for section in sections.filter(|section| is_links(&section.name)) {
        let entries = section.pairs.iter();
        let entries: Vec<_> = entries.filter(|(key, _)| number(key).is_some()).collect();
        let count = entries.len();
        let given = section.get("ObjectLinks");
        if let Some(given) = given.filter(|given| number(given) != Some(count as i128)) {
            let finding = W0254.at(given.span).fact("given", given.as_str());
            findings.push(finding.fact("count", count));
        }
        for (_, target) in entries {
            let index = number(target).and_then(|index| u16::try_from(index).ok());
            if let Some(index) = index.filter(|index| !description.objects.contains_key(index)) {
                let finding = W0254.at(target.span).form(&TARGET);
                findings.push(finding.fact("object", u32::from(index)));
            }
        }
    }
}
