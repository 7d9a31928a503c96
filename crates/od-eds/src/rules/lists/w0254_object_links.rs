use alloc::format;
use alloc::vec::Vec;

use crate::description::Description;
use crate::finding::{Check, Finding, Fixability, Form, Rule};
use crate::fix::Fix;
use crate::scan::number::number;

pub(crate) static W0254: Rule = Rule {
    title: "[XXXXObjectLinks] does not match its objects",
    why: "A tool that shows linked objects together misses one, or looks for an object that does not exist.",
    source: "CiA 306-1, object links",
    fixability: Fixability::Unsafe,
    says: "ObjectLinks is {given}, but the section has {count:entry|entries}",
    help: "write `ObjectLinks={count}`{fix}",
    also: &[TARGET, OWNER],
    check: Check::Device(check),
    ..Rule::of("W0254")
};

/// Sentence for a link to nothing.
const TARGET: Form = Form {
    says: "linked object {object:04X}h does not exist",
    help: "write the index of an object of this file, or remove the entry",
};

/// Sentence for the links of an object that is missing.
const OWNER: Form = Form {
    says: "object {object:04X}h, which the section links to others, does not exist",
    help: "write the index of an object of this file in the header, or remove the section",
};

fn check(description: &Description, findings: &mut Vec<Finding>) {
    let sections = description.sections.iter();
    for section in sections.filter(|section| object_of_links(&section.name).is_some()) {
        let owner = object_of_links(&section.name);
        if let Some(index) = owner.filter(|index| !description.objects.contains_key(index)) {
            let finding = W0254.at(section.name.span).form(&OWNER);
            findings.push(finding.fact("object", u32::from(index)));
        }
        let entries = section.pairs.iter();
        let entries: Vec<_> = entries.filter(|(key, _)| number(key).is_some()).collect();
        let count = entries.len();
        let given = section.get("ObjectLinks");
        if let Some(given) = given.filter(|given| number(given) != Some(count as i128)) {
            let finding = W0254.at(given.span).fact("given", given.as_str());
            let fix = Fix::unsafe_fix().replace(given.span, format!("{count}"));
            findings.push(finding.fact("count", count).fix(fix));
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

/// The object that a section `[2000ObjectLinks]` links to others.
fn object_of_links(name: &str) -> Option<u16> {
    let (index, word) = name.split_at_checked(4)?;
    let is_links = word.eq_ignore_ascii_case("ObjectLinks");
    u16::from_str_radix(index, 16).ok().filter(|_| is_links)
}
