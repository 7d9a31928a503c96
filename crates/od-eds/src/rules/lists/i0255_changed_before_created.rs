use alloc::vec::Vec;

use crate::description::Description;
use crate::finding::{Check, Finding, Rule};
use crate::scan::forms;

pub(crate) static I0255: Rule = Rule {
    title: "file was changed before it was created",
    why: "A tool that uses the newest of several files sorts the file wrongly, and nobody knows which date is right.",
    source: "CiA 306-1, FileInfo",
    says: "ModificationDate is {changed}, but CreationDate is {created}",
    help: "write the date of the last change, or correct CreationDate",
    check: Check::Device(check),
    ..Rule::of("I0255")
};

fn check(description: &Description, findings: &mut Vec<Finding>) {
    let Some(info) = description.section("FileInfo") else {
        return;
    };
    let date = |key: &str| {
        let given = info.get(key)?;
        Some((given, forms::day(given)?))
    };
    if let Some((created, first)) = date("CreationDate")
        && let Some((changed, last)) = date("ModificationDate")
        && last < first
    {
        let finding = I0255.at(changed.span).fact("changed", changed.as_str());
        let finding = finding.fact("created", created.as_str());
        findings.push(finding.related(created.span, "created on this date"));
    }
}
