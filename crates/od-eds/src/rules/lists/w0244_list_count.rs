use alloc::format;
use alloc::vec::Vec;

use crate::description::Description;
use crate::finding::{Check, Finding, Fixability, Form, Rule};
use crate::fix::Fix;
use crate::scan::number::number;

pub(crate) static W0244: Rule = Rule {
    title: "NrOfEntries does not match its list",
    why: "A configuration tool reads only as many entries as NrOfEntries says.",
    source: "CiA 306-1, SupportedModules",
    fixability: Fixability::Safe,
    says: "NrOfEntries is {given}, but the list has {count:entry|entries}",
    help: "write `NrOfEntries={count}`{fix}",
    also: &[BEYOND],
    check: Check::Device(check),
    ..Rule::of("W0244")
};

/// Sentence for a list with a gap in its numbers.
const BEYOND: Form = Form {
    says: "entry {number} is beyond NrOfEntries, which is {given}: the numbers have a gap",
    help: "number the entries from 1 to {given}",
};

fn check(description: &Description, findings: &mut Vec<Finding>) {
    for section in description
        .sections
        .iter()
        .filter(|section| is_counted(&section.name))
    {
        let entries = section.pairs.iter();
        let count = entries.filter(|(key, _)| number(key).is_some()).count();
        // Without a list of names, the sections [MxModuleInfo] are the modules.
        let count = if count == 0 && section.name.eq_ignore_ascii_case("SupportedModules") {
            modules(description)
        } else {
            count
        };
        let given = section.get("NrOfEntries");
        let numbers = || {
            section
                .pairs
                .iter()
                .filter_map(|(key, _)| Some((key, number(key)?)))
        };
        if let Some(given) = given.filter(|given| number(given) == Some(count as i128))
            && let Some((key, beyond)) = numbers().find(|(_, own)| *own > count as i128)
        {
            let finding = W0244.at(key.span).form(&BEYOND).fact("number", beyond);
            findings.push(finding.fact("given", given.as_str()));
        }
        if let Some(given) = given.filter(|given| number(given) != Some(count as i128)) {
            let finding = W0244.at(given.span).fact("given", given.as_str());
            let finding = finding.fact("count", count);
            // A tool that counts would lose an entry with a higher number.
            let numbers = section.pairs.iter().filter_map(|(key, _)| number(key));
            let is_safe = numbers.max().is_none_or(|highest| highest <= count as i128);
            let fix = Fix::safe().replace(given.span, format!("{count}"));
            findings.push(if is_safe { finding.fix(fix) } else { finding });
        }
    }
}

/// Number of sections `[MxModuleInfo]`.
fn modules(description: &Description) -> usize {
    let is_module = |name: &str| {
        let start = name.len().checked_sub("ModuleInfo".len());
        let parts = start.and_then(|at| name.split_at_checked(at));
        parts.is_some_and(|(start, word)| {
            word.eq_ignore_ascii_case("ModuleInfo")
                && start
                    .strip_prefix(['M', 'm'])
                    .is_some_and(|own| number(own).is_some())
        })
    };
    let names = description
        .sections
        .iter()
        .map(|section| section.name.as_str());
    names.filter(|name| is_module(name)).count()
}

/// `[SupportedModules]`, `[ConnectedModules]`, `[M1FixedObjects]`, `[M1SubExtends]`
fn is_counted(name: &str) -> bool {
    let whole = ["SupportedModules", "ConnectedModules"];
    if whole.iter().any(|known| name.eq_ignore_ascii_case(known)) {
        return true;
    }
    let Some(rest) = name.strip_prefix(['M', 'm']) else {
        return false;
    };
    let word = rest.trim_start_matches(|c: char| c.is_ascii_digit());
    let mut known = ["FixedObjects", "SubExtends"].iter();
    word.len() < rest.len() && known.any(|known| word.eq_ignore_ascii_case(known))
}
